#include "lowlap/pipeline/internal/output/output_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <utility>

#include "lowlap/core/internal/atomic_file.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using testing::IsError;
using testing::IsOk;

class OutputFolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("lowlap_output_folder_" + std::to_string(::getpid()));
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(OutputFolderTest, WhatIsMadeForNothingGoes) {
  fs::create_directory(folder_ / "old");
  for (const char* name : {"old", "old/new/newer", "new/"}) {
    OutputFolder made;
    ASSERT_THAT(made.Make((folder_ / name).string()), IsOk());
    EXPECT_TRUE(fs::is_directory(folder_ / name));
    FileSet files;
    EXPECT_THAT(files.Add((folder_ / name / "file").string(), "text"), IsOk());
  }
  EXPECT_TRUE(fs::exists(folder_ / "old"));
  EXPECT_TRUE(fs::is_empty(folder_ / "old"));
  EXPECT_FALSE(fs::exists(folder_ / "new"));
}

TEST_F(OutputFolderTest, WithAFileItStays) {
  EXPECT_THAT(WriteTextFiles({{"a", "b"}}, (folder_ / "x/y").string()), IsOk());
  EXPECT_TRUE(fs::exists(folder_ / "x/y/a"));
}

TEST_F(OutputFolderTest, WritesNothingIfAFileIsInTheWay) {
  ASSERT_THAT(WriteFileAtomically((folder_ / "a").string(), ""), IsOk());
  EXPECT_THAT(WriteTextFiles({{"a", "b"}}, (folder_ / "a/b").string()),
              IsError(ErrorCode::kIo, "is a file"));
}

TEST_F(OutputFolderTest, IsNotLeftByARunThatFails) {
  const Status refused =
      WriteOutputs(Scene(), RunSummary(), {}, (folder_ / "out").string(),
                   [](const Scene&) -> Status {
                     return MakeError(ErrorCode::kCancelled, "");
                   });
  EXPECT_THAT(refused, IsError(ErrorCode::kCancelled, ""));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(OutputFolderTest, TheRootPathIsAbsoluteIfItIsThere) {
  const auto written = [&](const std::string& root_path) {
    Scene scene;
    scene.root_path = root_path;
    std::string seen;
    EXPECT_FALSE(WriteOutputs(std::move(scene), RunSummary(), {},
                              (folder_ / "out").string(),
                              [&](const Scene& checked) -> Status {
                                seen = checked.root_path;
                                return MakeError(ErrorCode::kIo, "refused");
                              }));
    return seen;
  };
  EXPECT_EQ(written("."), (fs::current_path() / "").string());
  // Of a listing elsewhere, perhaps.
  EXPECT_EQ(written("../no/such/folder"), "../no/such/folder");
}

TEST_F(OutputFolderTest, OutputFilesAreThoseThatAreWritten) {
  const std::string out = (folder_ / "out").string();
  ASSERT_THAT(WriteOutputs(Scene(), RunSummary(), {}, out), IsOk());
  EXPECT_EQ(
      static_cast<std::size_t>(std::distance(fs::directory_iterator(out), {})),
      OutputFiles(out).size());
  for (const std::string& path : OutputFiles(out)) {
    EXPECT_TRUE(fs::exists(path)) << path;
  }
}

}  // namespace
}  // namespace lowlap
