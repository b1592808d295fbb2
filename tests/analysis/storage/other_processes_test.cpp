#include "analysis/storage/other_processes.h"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_reader.h"
#include "tests/support/test_files.h"

namespace remote_touch::other_processes_test {
namespace {

// Work in a separate process: its answer, its failure, and its end if it needs too much.

constexpr ChildLimits kLimits{256u << 20, 1};

std::string failure_of(const std::function<std::string()>& work) {
  try {
    return "answered " + in_child(kLimits, work);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(ChildProcess, AnswersWithItsBytes) {
  EXPECT_EQ(in_child(kLimits, [] { return std::string(); }), "");
  const std::string bytes("a\0b\n", 4);
  EXPECT_EQ(in_child(kLimits, [&] { return bytes; }), bytes);
  const std::string more(10'000'000, 'x');  // more bytes than a pipe takes at once
  EXPECT_EQ(in_child(kLimits, [&] { return more; }), more);
}

TEST(ChildProcess, ChangesNothingHere) {
  int changed = 0;
  in_child(kLimits, [&] { return changed = 1, std::string(); });
  EXPECT_EQ(changed, 0);
}

TEST(ChildProcess, PassesOnTheErrorMessage) {
  EXPECT_EQ(failure_of([]() -> std::string { throw std::runtime_error("no such thing"); }), "no such thing");
}

TEST(ChildProcess, FailsIfItNeedsTooMuchMemory) {
  EXPECT_EQ(failure_of([] { return std::string(std::size_t{1} << 30, 'x').substr(0, 1); }),
            "it needs more than 256 MiB of memory");
}

TEST(ChildProcess, IsEndedIfItTakesTooLong) {
  EXPECT_EQ(failure_of([]() -> std::string {
              for (std::atomic<unsigned> i = 0;;) ++i;
            }),
            "it takes more than 1 s");
}

TEST(ChildProcess, FailsIfItEndsWithAnExitCode) {
  EXPECT_EQ(failure_of([]() -> std::string { ::_exit(3); }),
            "the process that reads it ended with exit code 3, before its answer");
}

TEST(ChildProcess, ReportsTheSignalOfACrash) {
  EXPECT_EQ(failure_of([]() -> std::string {
              std::raise(SIGSEGV);
              return {};
            }),
            "its reader ended with signal 11, perhaps out of memory");
}

// A lock has one holder at a time.

TEST(FileLock, OneHolderAtATime) {
  const TestFolder folder("file_lock_test");
  const auto file = folder / "x.h5";
  folder.write("x.h5.partial-123", "left by a killed program");
  {
    const FileLock first(file);
    EXPECT_FALSE(std::filesystem::exists(folder / "x.h5.partial-123"));
    EXPECT_HAS(refusal([&] { FileLock second(file); }), "x.h5: another process is writing this file");
    EXPECT_NO_THROW(FileLock(folder / "y.h5"));
    write_file_atomically(file, "text", 4);  // the file may be replaced under the lock
    EXPECT_HAS(refusal([&] { FileLock second(file); }), "another process is writing this file");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "x.h5.lock"));
  folder.write("x.h5.lock", "");  // of a killed process
  EXPECT_NO_THROW(FileLock{file});
  EXPECT_HAS(refusal([&] { FileLock lock(folder / "nowhere" / "x.h5"); }), "x.h5: cannot be written");
}

TEST(FolderLock, OneHolderAtATime) {
  const TestFolder folder("file_lock_test");
  std::filesystem::create_directory(folder / "other");
  {
    const FolderLock first(folder.path());
    EXPECT_HAS(refusal([&] { FolderLock second(folder.path()); }),
               folder.path().string() + ": another process is writing there");
    EXPECT_NO_THROW(FolderLock{folder / "other"});
    EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"other"});
  }
  EXPECT_NO_THROW(FolderLock{folder.path()});
  EXPECT_NO_THROW(FolderLock{folder / "nowhere"});
}

// A file system without locks is no fault; other errors of flock() are reported.
TEST(LockError, DistinguishesFaultsFromAbsentLocks) {
  EXPECT_EQ(lock_error(-1, LOCK_EX | LOCK_NB), EBADF);
  for (const int error : {ENOLCK, ENOSYS, EOPNOTSUPP}) EXPECT_TRUE(has_no_locks(error)) << error;
  for (const int error : {EBADF, EWOULDBLOCK, EIO, EINTR}) EXPECT_FALSE(has_no_locks(error)) << error;
}

}  // namespace
}  // namespace remote_touch::other_processes_test
