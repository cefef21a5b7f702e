#pragma once

#include <mutex>
#include <string>
#include <string_view>

namespace lowlap {

/// Held while files take their names and while a database is written: steps
/// that the program must not end in the middle of. Not to be locked twice by
/// one thread.
std::unique_lock<std::mutex> LockFileChanges();

/// Files that are to be gone when the program ends, whatever ends it but a
/// kill; called with the lock held.
void AddTemporaryFile(const std::string& path);
void ForgetTemporaryFile(const std::string& path);

/// For a program that is about to end without unwinding its threads: waits for
/// the lock, removes all temporary files, and keeps the lock, so that nothing
/// changes any more.
void EndFileChanges();

/// All of `content` to an open file; false and errno on failure.
bool WriteAll(int file, std::string_view content);

}  // namespace lowlap
