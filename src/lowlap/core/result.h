#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace lowlap {

/// What went wrong, for a program to branch on.
enum class ErrorCode {
  kInvalidArgument,   // an option or a call makes no sense
  kNotFound,          // a file or folder is missing
  kIo,                // reading or writing failed
  kParse,             // a file's text or bytes are malformed
  kInvalidScene,      // well-formed, but the content contradicts itself
  kUnsupported,       // valid, but lowlap does not do this
  kInsufficientData,  // too little support for an estimate
  kNumerical,         // a solver failed
  kCancelled,         // the progress sink asked to stop
};

/// Name of a code, for logs and JSON ("invalid_argument", ...).
const char* ErrorCodeName(ErrorCode code);

/// What went wrong, for a person: `file` and `place` (a JSON path, a byte
/// offset, a line number) are empty where they mean nothing.
struct Error {
  ErrorCode code = ErrorCode::kInvalidArgument;
  std::string message;
  std::string file;
  std::string place;

  /// "file: place: message" without the empty parts, as a terminal can show it.
  std::string ToString() const;
};

/// Every fallible function of lowlap returns one; no exception crosses the API.
template <class T>
using Result = tl::expected<T, Error>;

/// Success or an error, where there is no value to return.
using Status = Result<void>;

inline tl::unexpected<Error> MakeError(ErrorCode code, std::string message,
                                       std::string file = {},
                                       std::string place = {}) {
  return tl::unexpected<Error>(
      Error{code, std::move(message), std::move(file), std::move(place)});
}

}  // namespace lowlap
