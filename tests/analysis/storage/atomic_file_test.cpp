// Files are written whole or not at all.
#include "analysis/storage/atomic_file.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/figures/result_file.h"
#include "analysis/storage/file_lock.h"
#include "tests/analysis/storage/system_answers.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::atomic_file_test {
namespace {

namespace fs = std::filesystem;

void expect_unwritable(const fs::path& file) {
  const std::string message = refusal([&] { write_trace(file, awkward_trace(2000), kProvenance, {}); });
  EXPECT_HAS(message, file.string() + ": cannot be written (");
  EXPECT_HAS(message, ": expected a writable folder");
}

TEST(WriteTrace, RefusesPathsThatCannotBeWritten) {
  const TestFolder folder("atomic_file_test");
  folder.write("file", "as it was");
  fs::create_directory(folder / "folder");
  fs::create_symlink(folder / "loop", folder / "loop");
  for (const char* name : {"missing/x.h5", "file/x.h5", "folder", "folder/", "loop/x.h5"})
    expect_unwritable(folder / name);
  expect_unwritable(folder / std::string(300, 'a'));
  expect_unwritable("");
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"file", "folder", "loop"}));
  EXPECT_TRUE(files_in(folder / "folder").empty());
  EXPECT_EQ(bytes_of(folder / "file"), "as it was");
  if (fs::exists("/dev/full")) expect_unwritable("/dev/full");
}

// File permissions apply to this thread even if root runs it, as long as this object exists.
class PermissionsOfAnyUser {
 public:
  PermissionsOfAnyUser() {
    EXPECT_EQ(::syscall(SYS_capget, &header_, before_.data()), 0);
    auto without = before_;
    without[0].effective &= ~((1u << CAP_DAC_OVERRIDE) | (1u << CAP_DAC_READ_SEARCH));
    EXPECT_EQ(::syscall(SYS_capset, &header_, without.data()), 0);
  }
  ~PermissionsOfAnyUser() { ::syscall(SYS_capset, &header_, before_.data()); }

 private:
  __user_cap_header_struct header_{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, 2> before_{};
};

TEST(WriteTrace, RefusesAFolderWithoutPermission) {
  const TestFolder folder("atomic_file_test");
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  const PermissionsOfAnyUser any_user;
  expect_unwritable(folder / "locked/x.h5");
  EXPECT_TRUE(files_in(folder / "locked").empty());
}

// A limit on the size of files acts like a full disk: the write begins and then fails.
TEST(WriteTrace, FailureInTheMiddleLeavesTheOldFile) {
  const TestFolder folder("atomic_file_test");
  folder.write("x.h5", "as it was");
  {
    const NoRoom limit(8192);
    expect_unwritable(folder / "x.h5");
    expect_unwritable(folder / "y.h5");
  }
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"x.h5"});
  EXPECT_EQ(bytes_of(folder / "x.h5"), "as it was");
}

TEST(WriteWholeFile, ReplacesAndKeepsNothingElse) {
  const TestFolder folder("atomic_file_test");
  const std::string text = "new", empty;
  folder.write("file", "old and longer");
  write_file_atomically(folder / "file", text.data(), text.size());
  EXPECT_EQ(bytes_of(folder / "file"), "new");
  write_file_atomically(folder / "file", empty.data(), 0);
  EXPECT_EQ(bytes_of(folder / "file"), "");
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"file"});
}

TEST(WriteWholeFile, LinksAreFollowedAlsoToWhatIsNotThereYet) {
  const TestFolder folder("atomic_file_test");
  fs::create_directory(folder / "there");
  fs::create_symlink("there/new", folder / "link");
  fs::create_symlink("link", folder / "second");
  const std::string first = "first", second = "second";
  write_file_atomically(folder / "second", first.data(), first.size());
  EXPECT_EQ(bytes_of(folder / "there/new"), "first");
  write_file_atomically(folder / "link", second.data(), second.size());
  EXPECT_EQ(bytes_of(folder / "there/new"), "second");
  EXPECT_EQ(fs::read_symlink(folder / "second"), "link");
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"link", "second", "there"}));
  EXPECT_EQ(files_in(folder / "there"), std::vector<std::string>{"new"});
}

TEST(WriteWholeFile, ALinkInARingIsRefused) {
  const TestFolder folder("atomic_file_test");
  fs::create_symlink("a", folder / "b");
  fs::create_symlink("b", folder / "a");
  EXPECT_HAS(refusal([&] { write_file_atomically(folder / "a", "x", 1); }), "a: cannot be written (");
  EXPECT_TRUE(fs::is_symlink(folder / "a"));
}

fs::perms permissions_of(const fs::path& file) {
  return fs::status(file).permissions();
}

TEST(WriteWholeFile, KeepsThePermissionsOfTheFileThatItReplaces) {
  const TestFolder folder("atomic_file_test");
  for (const unsigned mode : {0600u, 0640u, 0755u}) {
    fs::permissions(folder.write("file", "old"), static_cast<fs::perms>(mode));
    write_file_atomically(folder / "file", "new", 3);
    EXPECT_EQ(permissions_of(folder / "file"), static_cast<fs::perms>(mode));
    const fs::path temporary = temporary_of(folder / "file");
    folder.write(temporary.filename(), "whole");
    move_into_place(temporary, folder / "file");
    EXPECT_EQ(bytes_of(folder / "file"), "whole");
    EXPECT_EQ(permissions_of(folder / "file"), static_cast<fs::perms>(mode));
  }
}

TEST(MoveIntoPlace, RemovesAFileThatCannotBeMoved) {
  const TestFolder folder("atomic_file_test");
  fs::create_directory(folder / "taken");
  const fs::path temporary = temporary_of(folder / "taken");
  folder.write(temporary.filename(), "whole");
  EXPECT_HAS(refusal([&] { move_into_place(temporary, folder / "taken"); }), "taken: cannot be written (");
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"taken"});
  EXPECT_HAS(refusal([&] { move_into_place(temporary, folder / "new"); }), "new: cannot be written (No such");
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"taken"});
}

// Rare results of a system call: an interrupted call is repeated, and a call that writes no byte means a full
// disk.
TEST(WriteWholeFile, RepeatsInterruptedCallsAndReportsAFullDisk) {
  const TestFolder folder("atomic_file_test");
  {
    const AnswersOfWrite once{{-1, EINTR}, {-1, EINTR}};
    write_file_atomically(folder / "file", "text", 4);
  }
  EXPECT_EQ(bytes_of(folder / "file"), "text");
  for (const int earlier : {0, EINTR}) {
    const AnswersOfWrite none{{0, earlier}};
    EXPECT_HAS(refusal([&] { write_file_atomically(folder / "file", "other", 5); }),
               "file: cannot be written (No space left on device)");
  }
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"file"});
  EXPECT_EQ(bytes_of(folder / "file"), "text");
}

TEST(RemoveLeftovers, RemovesThemBesideTheFileThatALinkLeadsTo) {
  const TestFolder folder("atomic_file_test");
  fs::create_directory(folder / "there");
  fs::create_symlink("there/x.h5", folder / "link.h5");
  folder.write("there/x.h5.partial-123", "half"), folder.write("there/y.h5.partial-123", "of another");
  remove_leftovers(folder / "link.h5");
  EXPECT_EQ(files_in(folder / "there"), std::vector<std::string>{"y.h5.partial-123"});
}

TEST(WriteWholeFile, DevicesAreWrittenThrough) {
  if (!fs::exists("/dev/null")) GTEST_SKIP() << "no /dev/null";
  const std::string text = "anything";
  EXPECT_NO_THROW(write_file_atomically("/dev/null", text.data(), text.size()));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

// Writing to a pipe that nobody reads would block for ever, and so may writing to other devices.
TEST(WriteWholeFile, PipesAndOtherDevicesAreRefusedAtOnce) {
  const TestFolder folder("atomic_file_test");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder / "link");
  const std::string text = "anything";
  for (const fs::path& target : {folder / "pipe", folder / "link", fs::path("/dev/zero")}) {
    const std::string problem = target.string() + ": is a pipe, a socket or a device: expected a file";
    EXPECT_EQ(refusal([&] { require_writable(target); }), problem);
    EXPECT_EQ(refusal([&] { write_file_atomically(target, text.data(), text.size()); }), problem);
    EXPECT_EQ(refusal([&] { const FileLock lock(target); }), problem);
  }
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"link", "pipe"}));
}

}  // namespace
}  // namespace remote_touch::atomic_file_test
