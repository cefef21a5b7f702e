#include "lowlap/core/atomic_file.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "support/matchers.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using testing::IsError;
using testing::IsOk;

// A folder of its own, so that nothing left behind is overlooked.
class AtomicFileTest : public ::testing::Test {
 protected:
  AtomicFileTest() { fs::create_directories(folder_); }
  ~AtomicFileTest() override { fs::remove_all(folder_); }

  static auto Writes(const std::string& text) {
    return [text](std::ostream& stream) -> Status {
      stream << text;
      return {};
    };
  }
  std::size_t CountFiles() const {
    return static_cast<std::size_t>(std::distance(
        fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) /
      ("lowlap_atomic_" +
       std::string(
           ::testing::UnitTest::GetInstance()->current_test_info()->name()));
  const std::string path_ = (folder_ / "file").string();
};

TEST_F(AtomicFileTest, WritesAndReplaces) {
  ASSERT_THAT(WriteFileAtomically(path_, Writes("first")), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "first");
  ASSERT_THAT(WriteFileAtomically(path_, Writes("2")), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "2");
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, FailureOfTheWriterLeavesTheOldFile) {
  ASSERT_THAT(WriteFileAtomically(path_, Writes("old")), IsOk());
  const Status status =
      WriteFileAtomically(path_, [](std::ostream& stream) -> Status {
        stream << "half of the new";
        return MakeError(ErrorCode::kNumerical, "no solution");
      });
  EXPECT_THAT(status, IsError(ErrorCode::kNumerical, path_ + ": no solution"));
  EXPECT_EQ(*ReadWholeFile(path_), "old");
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, FailureOfTheStreamLeavesNothing) {
  const Status status =
      WriteFileAtomically(path_, [](std::ostream& stream) -> Status {
        stream << "text";
        stream.setstate(std::ios::badbit);  // as a full disk does
        return {};
      });
  EXPECT_THAT(status, IsError(ErrorCode::kIo, path_));
  EXPECT_EQ(CountFiles(), 0u);
}

TEST_F(AtomicFileTest, PathThatIsAFolder) {
  fs::create_directory(path_);
  std::ofstream(path_ + "/inside") << "x";
  EXPECT_THAT(WriteFileAtomically(path_, Writes("x")),
              IsError(ErrorCode::kIo, path_));
  EXPECT_TRUE(fs::is_directory(path_));
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, MissingFolder) {
  const std::string path = path_ + "/missing/file";
  EXPECT_THAT(WriteFileAtomically(path, Writes("x")),
              IsError(ErrorCode::kIo, path));
}

TEST_F(AtomicFileTest, ThreadsMayWriteOnePath) {
  std::vector<std::thread> threads;
  std::atomic<int> failures{0};
  for (int n = 0; n < 8; ++n) {
    threads.emplace_back([&, n] {
      const std::string text(10000, static_cast<char>('a' + n));
      for (int k = 0; k < 20; ++k) {
        failures += !WriteFileAtomically(path_, Writes(text)).has_value();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failures, 0);
  const std::string text = *ReadWholeFile(path_);
  EXPECT_EQ(text, std::string(10000, text.at(0)));  // one of them, whole
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, ReadsAnyBytes) {
  std::string bytes;
  for (int n = 0; n < 300000; ++n) bytes += static_cast<char>(n * 7);
  ASSERT_THAT(WriteFileAtomically(path_, Writes(bytes)), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), bytes);
  ASSERT_THAT(WriteFileAtomically(path_, Writes("")), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "");
}

TEST_F(AtomicFileTest, ReadingErrorsNameTheFile) {
  EXPECT_THAT(ReadWholeFile(path_), IsError(ErrorCode::kNotFound, path_));
  EXPECT_THAT(ReadWholeFile(folder_.string()),
              IsError(ErrorCode::kIo, "folder"));
  EXPECT_THAT(ReadWholeFile(""), IsError(ErrorCode::kNotFound, ""));
}

}  // namespace
}  // namespace lowlap
