#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace lowlap {

struct Outcome {
  int exit_code = -1;
  std::string output;  // standard output and error
};

inline Outcome Lowlap(const std::string& arguments) {
  Outcome outcome;
  const std::string line =
      std::string(LOWLAP_COMMAND) + " " + arguments + " 2>&1";
  FILE* pipe = ::popen(line.c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n;
       (n = std::fread(buffer.data(), 1, buffer.size(), pipe));) {
    outcome.output.append(buffer.data(), n);
  }
  const int status = ::pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

inline std::string ReadText(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A folder of its own for each test, and the command.
class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("lowlap_cli_") + info->name() + "_" +
               std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const {
    return (folder_ / name).string();
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name), std::ios::binary) << text;
  }
  std::size_t FilesIn(const std::string& name) const {
    if (!std::filesystem::exists(Path(name))) return 0;
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(Path(name)), {}));
  }

  std::filesystem::path folder_;
};

}  // namespace lowlap
