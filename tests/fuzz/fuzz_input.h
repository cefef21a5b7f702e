#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

// What all fuzzers share. A finding is whatever libFuzzer or a sanitizer stops
// at, and what these functions abort at.
namespace lowlap::fuzz {

inline std::string_view Bytes(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// An input as files, in a folder that the process has for itself. Up to the
/// first line
///   --8<-- NAME
/// it is the content of the file `input`; behind each such line stands that of
/// the file NAME, which may lie in folders. The folder holds these files alone.
class InputFolder {
 public:
  explicit InputFolder(std::string_view bytes);
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string File(const std::string& name = "input") const {
    return path_ + "/" + name;
  }

 private:
  void Write(std::string_view name, std::string_view content) const;

  std::string path_;
};

/// Aborts unless the error has a message, without characters that would upset a
/// terminal, and a file whose path starts with `file`.
void CheckError(const Error& error, const std::string& file);

template <class Value>
void CheckResult(const Result<Value>& result, const std::string& file) {
  if (!result) CheckError(result.error(), file);
}

/// The same; aborts as well unless a scene that was read is valid, and the same
/// to the byte when it is written and read again.
void CheckScene(const Result<Scene>& scene, const std::string& file);

}  // namespace lowlap::fuzz
