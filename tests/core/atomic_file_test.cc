#include "lowlap/core/internal/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "lowlap/core/internal/file_changes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using testing::IsError;
using testing::IsOk;

// A folder of its own, so that nothing left behind is overlooked.
class AtomicFileTest : public ::testing::Test {
 protected:
  AtomicFileTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~AtomicFileTest() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const {
    return (folder_ / name).string();
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
  ASSERT_THAT(WriteFileAtomically(path_, "first"), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "first");
  ASSERT_THAT(WriteFileAtomically(path_, "2"), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "2");
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, NoFileOfASetAppearsBeforeAllArePrepared) {
  ASSERT_THAT(WriteFileAtomically(path_, "old"), IsOk());
  fs::create_directory(Path("folder"));
  {
    FileSet files;
    ASSERT_THAT(files.Add(path_, "new"), IsOk());
    ASSERT_THAT(files.Add(Path("other"), "new"), IsOk());
    EXPECT_THAT(files.Add(Path("folder"), "new"),
                IsError(ErrorCode::kIo, Path("folder")));
    EXPECT_EQ(*ReadWholeFile(path_), "old");
  }
  EXPECT_EQ(*ReadWholeFile(path_), "old");
  EXPECT_EQ(CountFiles(), 2u);  // file and folder
  FileSet files;
  ASSERT_THAT(files.Add(path_, "new"), IsOk());
  ASSERT_THAT(files.Add(Path("other"), "too"), IsOk());
  ASSERT_THAT(files.Commit(), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "new");
  EXPECT_EQ(*ReadWholeFile(Path("other")), "too");
  EXPECT_EQ(CountFiles(), 3u);
}

TEST_F(AtomicFileTest, AFullDiskLeavesNothingAndIsNamed) {
  // A limit of the size of files stands for the full disk.
  struct rlimit before {};
  ::getrlimit(RLIMIT_FSIZE, &before);
  struct rlimit limit = before;
  limit.rlim_cur = 100;
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &limit);
  const Status status = WriteFileAtomically(path_, std::string(1000, 'x'));
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_THAT(status, IsError(ErrorCode::kIo, "File too large"));
  EXPECT_EQ(status.error().file, path_);
  EXPECT_EQ(CountFiles(), 0u);
}

TEST_F(AtomicFileTest, ALargeSetNeedsFewOpenFiles) {
  struct rlimit before {};
  ::getrlimit(RLIMIT_NOFILE, &before);
  struct rlimit limit = before;
  limit.rlim_cur = 300;
  ::setrlimit(RLIMIT_NOFILE, &limit);
  constexpr std::size_t kNumFiles = 400;
  const auto add_all = [&](FileSet* files) {
    for (std::size_t n = 0; n < kNumFiles; ++n) {
      ASSERT_THAT(files->Add(Path(std::to_string(n)), "x"), IsOk());
    }
  };
  {
    FileSet dropped;
    add_all(&dropped);
    EXPECT_EQ(CountFiles(), kNumFiles);
  }
  EXPECT_EQ(CountFiles(), 0u);
  FileSet files;
  add_all(&files);
  EXPECT_THAT(files.Commit(), IsOk());
  ::setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_EQ(CountFiles(), kNumFiles);
}

TEST_F(AtomicFileTest, PathThatIsAFolder) {
  fs::create_directory(path_);
  std::ofstream(path_ + "/inside") << "x";
  EXPECT_THAT(WriteFileAtomically(path_, "x"),
              IsError(ErrorCode::kIo, "Is a directory"));
  EXPECT_TRUE(fs::is_directory(path_));
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, MissingFolder) {
  const std::string path = path_ + "/missing/file";
  EXPECT_THAT(WriteFileAtomically(path, "x"),
              IsError(ErrorCode::kIo, path + ": cannot be opened for writing: "
                                             "No such file or directory"));
}

TEST_F(AtomicFileTest, ALinkStaysAndItsFileIsReplaced) {
  fs::create_directory(Path("elsewhere"));
  std::ofstream(Path("elsewhere/target")) << "old";
  fs::create_symlink("elsewhere/target", Path("link"));
  fs::create_symlink("link", path_);
  ASSERT_THAT(WriteFileAtomically(path_, "new"), IsOk());
  EXPECT_TRUE(fs::is_symlink(path_));
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_FALSE(fs::is_symlink(Path("elsewhere/target")));
  EXPECT_EQ(*ReadWholeFile(Path("elsewhere/target")), "new");
  // A link to what does not exist yet.
  fs::create_symlink("elsewhere/other", Path("dangling"));
  ASSERT_THAT(WriteFileAtomically(Path("dangling"), "made"), IsOk());
  EXPECT_EQ(*ReadWholeFile(Path("elsewhere/other")), "made");
  EXPECT_EQ(CountFiles(), 4u);
}

TEST_F(AtomicFileTest, LinksInACircleAreAnError) {
  fs::create_symlink("b", Path("a"));
  fs::create_symlink("a", Path("b"));
  EXPECT_THAT(WriteFileAtomically(Path("a"), "x"),
              IsError(ErrorCode::kIo, Path("a")));
  for (const char* name : {"a", "b"}) {
    EXPECT_THAT(ReadWholeFile(Path(name)),
                IsError(ErrorCode::kIo, "Too many levels of symbolic links"));
  }
  EXPECT_EQ(CountFiles(), 2u);
}

TEST_F(AtomicFileTest, DevicesAndPipesAreWrittenTo) {
  ASSERT_THAT(WriteFileAtomically("/dev/null", "x"), IsOk());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THAT(WriteFileAtomically("/dev/full", "x"),
              IsError(ErrorCode::kIo, "No space left on device"));

  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { received = ReadWholeFile(path_).value_or(""); });
  const std::string content(300000, 'x');  // more than a pipe holds
  EXPECT_THAT(WriteFileAtomically(path_, content), IsOk());
  reader.join();
  EXPECT_EQ(received, content);
  EXPECT_TRUE(fs::is_fifo(path_));
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, OpenFilesUnderProcAreAppendedTo) {
  std::ofstream(path_) << "before ";
  const int file = ::open(path_.c_str(), O_WRONLY);
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  EXPECT_THAT(WriteFileAtomically(link, "after"), IsOk());
  ::close(file);
  EXPECT_EQ(*ReadWholeFile(path_), "before after");
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, AFailingDeviceLeavesTheRestOfTheSetUnwritten) {
  FileSet files;
  ASSERT_THAT(files.Add(path_, "x"), IsOk());
  ASSERT_THAT(files.Add("/dev/full", "x"), IsOk());
  EXPECT_THAT(files.Commit(), IsError(ErrorCode::kIo, "/dev/full"));
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(AtomicFileTest, ARenameThatFailsTakesTheOthersBack) {
  ASSERT_THAT(WriteFileAtomically(path_, "old"), IsOk());
  {
    FileSet files;
    ASSERT_THAT(files.Add(path_, "new"), IsOk());
    ASSERT_THAT(files.Add(Path("other"), "new"), IsOk());
    ASSERT_THAT(files.Add(Path("folder"), "new"), IsOk());
    fs::create_directory(Path("folder"));  // no file can take its place
    EXPECT_THAT(files.Commit(), IsError(ErrorCode::kIo, Path("folder")));
  }
  EXPECT_EQ(*ReadWholeFile(path_), "old");
  EXPECT_FALSE(fs::exists(Path("other")));
  EXPECT_EQ(CountFiles(), 2u);  // file and folder
}

// Forks a writer that has prepared `path` and is then killed, or lives until
// the pipe `stay` is closed.
pid_t ForkWriter(const std::string& path, const int (&ready)[2],
                 const int (&stay)[2], bool is_killed) {
  const pid_t writer = ::fork();
  if (writer != 0) return writer;
  ::close(stay[1]);
  FileSet files;
  const bool added = files.Add(path, "of the other").has_value();
  char byte = added ? '1' : '0';
  [[maybe_unused]] ssize_t ignored = ::write(ready[1], &byte, 1);
  if (is_killed) ::raise(SIGKILL);
  ignored = ::read(stay[0], &byte, 1);
  ::_exit(files.Commit() ? 0 : 1);
}

TEST_F(AtomicFileTest, WhatAKilledWriterLeftGoesWithTheNextOne) {
  int ready[2], stay[2];
  ASSERT_EQ(::pipe(ready) | ::pipe(stay), 0);
  // Several at once, then killed in turn.
  for (int n = 0; n < 3; ++n) {
    const pid_t writer = ForkWriter(path_, ready, stay, /*is_killed=*/true);
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    ::waitpid(writer, nullptr, 0);
  }
  std::ofstream(path_ + ".tmp1") << "of an earlier one";
  EXPECT_TRUE(fs::exists(path_ + ".tmp0"));
  ASSERT_THAT(WriteFileAtomically(path_, "whole"), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "whole");
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, TheSecondNamesOfAKilledWriterGoWithTheNextOne) {
  std::ofstream(path_ + ".tmp-old0") << "replaced";
  std::ofstream(path_ + ".tmp-old1") << "replaced";
  ASSERT_THAT(WriteFileAtomically(path_, "whole"), IsOk());
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, TheEndOfFileChangesRemovesWhatIsPrepared) {
  const pid_t writer = ::fork();
  if (writer == 0) {
    FileSet files;
    const bool added = files.Add(path_, "whole").has_value() &&
                       files.Add(Path("other"), "whole").has_value() &&
                       WriteFileAtomically(Path("third"), "whole").has_value();
    EndFileChanges();
    ::_exit(added ? 0 : 1);
  }
  int status = -1;
  ::waitpid(writer, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(CountFiles(), 1u);
  EXPECT_EQ(*ReadWholeFile(Path("third")), "whole");
}

TEST_F(AtomicFileTest, WhatALivingWriterPreparesStays) {
  int ready[2], stay[2];
  ASSERT_EQ(::pipe(ready) | ::pipe(stay), 0);
  const pid_t writer = ForkWriter(path_, ready, stay, /*is_killed=*/false);
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  ASSERT_THAT(WriteFileAtomically(path_, "ours"), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "ours");
  EXPECT_EQ(CountFiles(), 2u);
  ::close(stay[1]);
  int status = -1;
  ::waitpid(writer, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(*ReadWholeFile(path_), "of the other");
  EXPECT_EQ(CountFiles(), 1u);
}

TEST_F(AtomicFileTest, ThreadsMayWriteOnePath) {
  std::vector<std::thread> threads;
  std::atomic<int> failures{0};
  for (int n = 0; n < 8; ++n) {
    threads.emplace_back([&, n] {
      const std::string text(10000, static_cast<char>('a' + n));
      for (int k = 0; k < 20; ++k) {
        failures += !WriteFileAtomically(path_, text).has_value();
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
  ASSERT_THAT(WriteFileAtomically(path_, bytes), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), bytes);
  ASSERT_THAT(WriteFileAtomically(path_, ""), IsOk());
  EXPECT_EQ(*ReadWholeFile(path_), "");
}

TEST_F(AtomicFileTest, ReadingErrorsNameTheFileAndTheReason) {
  EXPECT_THAT(ReadWholeFile(path_), IsError(ErrorCode::kNotFound, path_));
  EXPECT_THAT(ReadWholeFile(folder_.string()),
              IsError(ErrorCode::kIo, "folder"));
  EXPECT_THAT(ReadWholeFile(""), IsError(ErrorCode::kNotFound, ""));
  std::ofstream(path_) << "x";
  fs::permissions(path_, fs::perms::none);
  if (::geteuid() != 0) {
    EXPECT_THAT(ReadWholeFile(path_),
                IsError(ErrorCode::kIo, "Permission denied"));
  }
}

}  // namespace
}  // namespace lowlap
