#include "lowlap/core/result.h"

#include "lowlap/core/internal/format.h"

namespace lowlap {

const char* ErrorCodeName(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return "invalid_argument";
    case ErrorCode::kNotFound:
      return "not_found";
    case ErrorCode::kIo:
      return "io";
    case ErrorCode::kParse:
      return "parse";
    case ErrorCode::kInvalidScene:
      return "invalid_scene";
    case ErrorCode::kUnsupported:
      return "unsupported";
    case ErrorCode::kInsufficientData:
      return "insufficient_data";
    case ErrorCode::kNumerical:
      return "numerical";
    case ErrorCode::kCancelled:
      return "cancelled";
  }
  return "unknown";
}

std::string Error::ToString() const {
  std::string text;
  for (const std::string* part : {&file, &place}) {
    if (!part->empty()) text += *part + ": ";
  }
  return Printable(text + message);
}

}  // namespace lowlap
