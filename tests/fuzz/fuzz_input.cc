#include "fuzz_input.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "lowlap/io/internal/scene_binary.h"

namespace lowlap::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCut = "--8<-- ";
// More, or deeper ones, only cost time.
constexpr std::size_t kMaxFiles = 32;
constexpr std::size_t kMaxNameLength = 80;

[[noreturn]] void Stop(const std::string& what) {
  std::fprintf(stderr, "finding: %s\n", what.c_str());
  std::abort();
}

// The name of a file below the folder.
bool IsGoodName(std::string_view name) {
  if (name.empty() || name.size() > kMaxNameLength || name.front() == '/' ||
      name.back() == '/' || name.find("..") != std::string_view::npos) {
    return false;
  }
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
           (c >= 'a' && c <= 'z') || c == '_' || c == '.' || c == '/';
  });
}

// Where the next line starts that begins with kCut.
std::size_t NextCut(std::string_view bytes) {
  std::size_t at = bytes.find(kCut);
  while (at != std::string_view::npos && at > 0 && bytes[at - 1] != '\n') {
    at = bytes.find(kCut, at + 1);
  }
  return std::min(at, bytes.size());
}

bool IsControlCharacter(char c) {
  const auto value = static_cast<unsigned char>(c);
  return (value < 0x20 && c != '\n') || value == 0x7f;
}

}  // namespace

InputFolder::InputFolder(std::string_view bytes)
    : path_((fs::temp_directory_path() /
             ("lowlap_fuzz_" + std::to_string(getpid())))
                .string()) {
  fs::remove_all(path_);
  fs::create_directories(path_);
  std::size_t end = NextCut(bytes);
  if (end > 0 || bytes.empty()) Write("input", bytes.substr(0, end));
  for (std::size_t n = 0; n < kMaxFiles && end < bytes.size(); ++n) {
    bytes.remove_prefix(end + kCut.size());
    const std::size_t line = std::min(bytes.find('\n'), bytes.size());
    const std::string_view name = bytes.substr(0, line);
    bytes.remove_prefix(std::min(line + 1, bytes.size()));
    end = NextCut(bytes);
    if (IsGoodName(name)) Write(name, bytes.substr(0, end));
  }
}

void InputFolder::Write(std::string_view name, std::string_view content) const {
  const fs::path path = fs::path(path_) / name;
  std::error_code ignored;  // a file may be in the way of a folder
  fs::create_directories(path.parent_path(), ignored);
  std::ofstream(path, std::ios::binary) << content;
}

void CheckError(const Error& error, const std::string& file) {
  if (error.message.empty()) Stop("an error without a message");
  if (error.file.compare(0, file.size(), file) != 0) {
    Stop("an error of '" + error.file + "', not of " + file + ": " +
         error.message);
  }
  const std::string text = error.ToString();
  if (std::any_of(text.begin(), text.end(), IsControlCharacter)) {
    Stop("control characters in an error: " + text);
  }
}

void CheckScene(const Result<Scene>& scene, const std::string& file) {
  CheckResult(scene, file);
  if (!scene) return;
  const Result<std::string> bytes = FormatSceneBinary(*scene);
  if (!bytes) Stop("a scene that is not valid: " + bytes.error().ToString());
  const Result<Scene> again = ParseSceneBinary(*bytes);
  if (!again) Stop("cannot be read again: " + again.error().ToString());
  if (FormatSceneBinary(*again) != *bytes) Stop("changes when it is kept");
}

}  // namespace lowlap::fuzz
