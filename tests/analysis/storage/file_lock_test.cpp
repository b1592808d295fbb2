// A lock has one holder at a time.
#include "analysis/storage/file_lock.h"

#include <gtest/gtest.h>
#include <sys/file.h>

#include <cerrno>
#include <filesystem>

#include "analysis/storage/atomic_file.h"
#include "tests/support/test_files.h"

namespace remote_touch::file_lock_test {
namespace {

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
}  // namespace remote_touch::file_lock_test
