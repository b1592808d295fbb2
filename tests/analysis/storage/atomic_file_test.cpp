// Files are written whole or not at all, alone or together, and replace no file of another program. A lock
// has one holder at a time.
#include "analysis/storage/atomic_file.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/storage/other_processes.h"
#include "analysis/storage/result_file.h"
#include "tests/analysis/storage/system_answers.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::atomic_file_test {
namespace {

// A file that appears while a command computes is kept, and so is the result.

namespace fs = std::filesystem;

class ReplacementRuleTest : public testing::Test {
 protected:
  // The rule of these tests: files that begin with "ours" may be replaced.
  void set_rule(const fs::path& target) const {
    set_replacement_rule(
        target, {.is_ours = [](const fs::path& file) { return bytes_of(file).starts_with("ours"); }});
  }
  std::string write(const fs::path& target, const std::string& text) const {
    return refusal([&] { write_file_atomically(target, text.data(), text.size()); });
  }
  const TestFolder folder_{"replacement_rule_test"};
};

constexpr const char* kNone = "no InputError";

TEST_F(ReplacementRuleTest, AFileThatAppearedAndTheResultAreKept) {
  const fs::path target = folder_ / "late.h5";
  set_rule(target);
  folder_.write("late.h5", "precious notes");
  const std::string problem = write(target, "ours, new");
  EXPECT_HAS(problem, "late.h5: was written by another program while this one computed, and is unchanged: ");
  EXPECT_EQ(bytes_of(target), "precious notes");
  ASSERT_EQ(files_in(folder_.path()).size(), 2u);
  const std::string kept = files_in(folder_.path())[1];  // behind late.h5 in the order of names
  EXPECT_HAS(kept, "late.h5.kept-");
  EXPECT_HAS(problem, (folder_ / kept).string());
  EXPECT_EQ(bytes_of(folder_ / kept), "ours, new");
  remove_leftovers(target);  // the next command does this
  EXPECT_TRUE(fs::exists(folder_ / kept));
}

TEST_F(ReplacementRuleTest, ReplacesFilesThatTheRuleAllows) {
  const fs::path target = folder_ / "x";
  set_rule(target);
  EXPECT_EQ(write(target, "ours, 1"), kNone);
  EXPECT_EQ(write(target, "ours, 2"), kNone);
  EXPECT_EQ(bytes_of(target), "ours, 2");
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"x"});
}

TEST_F(ReplacementRuleTest, HoldsForEveryWayToWriteTheTarget) {
  const fs::path target = folder_ / "x", here = fs::relative(target);
  folder_.write("x", "precious notes");
  set_rule(here);
  EXPECT_HAS(write(folder_ / "." / "x", "new"), "was written by another program");
  const fs::path temporary = temporary_of(target);
  folder_.write(temporary.filename(), "new");
  EXPECT_HAS(refusal([&] { move_into_place(temporary, target); }), "was written by another program");
  EXPECT_EQ(bytes_of(target), "precious notes");
}

TEST_F(ReplacementRuleTest, FilesThatBelongTogetherAppearAllOrNone) {
  set_rule(folder_ / "b");
  const std::string problem = refusal([&] {
    NewFiles files;
    files.begin(folder_ / "a"), files.append("new a");
    files.begin(folder_ / "b"), files.append("new b");
    folder_.write("b", "precious notes");
    files.finish();
  });
  EXPECT_HAS(problem, "b: was written by another program meanwhile, and is unchanged");
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"b"});
  EXPECT_EQ(bytes_of(folder_ / "b"), "precious notes");
}

// Files are written whole or not at all.

void expect_unwritable(const fs::path& file) {
  const std::string message = refusal([&] { write_trace(file, awkward_trace(2000), kProvenance, {}); });
  EXPECT_HAS(message, file.string() + ": cannot be written (");
  EXPECT_HAS(message, ": expected a writable folder");
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

TEST(WriteTrace, RefusesPathsThatCannotBeWritten) {
  const TestFolder folder("atomic_file_test");
  folder.write("file", "as it was");
  fs::create_directory(folder / "folder");
  fs::create_symlink(folder / "loop", folder / "loop");
  fs::create_symlink("b", folder / "a"), fs::create_symlink("a", folder / "b");
  EXPECT_HAS(refusal([&] { write_file_atomically(folder / "a", "x", 1); }), "a: cannot be written (");
  for (const char* name : {"missing/x.h5", "file/x.h5", "folder", "folder/", "loop/x.h5"})
    expect_unwritable(folder / name);
  expect_unwritable(folder / std::string(300, 'a'));
  expect_unwritable("");
  fs::permissions(folder / "folder", fs::perms::owner_read | fs::perms::owner_exec);
  {
    const PermissionsOfAnyUser any_user;
    expect_unwritable(folder / "folder/x.h5");
  }
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"a", "b", "file", "folder", "loop"}));
  EXPECT_TRUE(fs::is_symlink(folder / "a"));
  EXPECT_TRUE(files_in(folder / "folder").empty());
  EXPECT_EQ(bytes_of(folder / "file"), "as it was");
  if (fs::exists("/dev/full")) expect_unwritable("/dev/full");
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
    const FaultySystem once({.writes = {{-1, EINTR}, {-1, EINTR}}});
    write_file_atomically(folder / "file", "text", 4);
  }
  EXPECT_EQ(bytes_of(folder / "file"), "text");
  for (const int earlier : {0, EINTR}) {
    const FaultySystem none({.writes = {{0, earlier}}});
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

// Writing to a pipe that nobody reads would block for ever, and so may writing to other devices.
TEST(WriteWholeFile, PipesAndDevicesButTheNullOneAreRefusedAtOnce) {
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
  if (!fs::exists("/dev/null")) return;
  EXPECT_NO_THROW(write_file_atomically("/dev/null", text.data(), text.size())) << "is written through";
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

using Names = std::vector<std::string>;

TEST(NewFiles, AppearTogetherOrNotAtAll) {
  const TestFolder folder("new_files");
  fs::permissions(folder.write("b", "old"), static_cast<fs::perms>(0600));
  {
    NewFiles unfinished;
    for (const char* name : {"a", "b"}) unfinished.begin(folder / name), unfinished.append("new");
  }
  EXPECT_EQ(files_in(folder.path()), Names{"b"});
  NewFiles files;
  files.begin(folder / "a");
  files.append("one");
  files.append(" two");
  files.begin(folder / "b");
  files.append("new");
  EXPECT_EQ(files.count(), 2u);
  EXPECT_EQ(files.size(), 10u);
  EXPECT_EQ(bytes_of(folder / "b"), "old");
  EXPECT_FALSE(fs::exists(folder / "a"));
  files.finish();
  EXPECT_EQ(bytes_of(folder / "a"), "one two");
  EXPECT_EQ(bytes_of(folder / "b"), "new");
  EXPECT_EQ(permissions_of(folder / "b"), static_cast<fs::perms>(0600));
  EXPECT_EQ(files_in(folder.path()), (Names{"a", "b"}));
  EXPECT_HAS(refusal([&] { files.begin(folder / "nowhere/a"); }), "nowhere/a: cannot be written");
  EXPECT_HAS(refusal([&] { files.begin("/dev/null"); }), "/dev/null: cannot be written");
  EXPECT_HAS(refusal([&] { files.begin(folder.path()); }), "cannot be written (Is a directory)");
}

using Contents = std::vector<std::pair<fs::path, std::string>>;  // contents, by target

void write_together(const Contents& contents) {
  NewFiles files;
  for (const auto& [target, content] : contents) files.begin(target), files.append(content);
  files.finish();
}

TEST(NewFiles, ReplaceAllOrNone) {
  const TestFolder folder("new_files");
  fs::create_directory(folder / "there");
  fs::create_symlink("there/b", folder / "b");
  folder.write("a", "old a"), folder.write("there/b", "old b");
  const Contents files = {{folder / "a", "new a"}, {folder / "new", ""}, {folder / "b", "new b"}};
  const auto all = [&] { return bytes_of(folder / "a") + ", " + bytes_of(folder / "b"); };
  const Names before = {"a", "b", "there"};

  for (const int done : {0, 1, 2}) {
    const FaultySystem failed({.renames_before = done, .failed_renames = 1, .error_of_rename = EDQUOT});
    EXPECT_HAS(refusal([&] { write_together(files); }), files[static_cast<std::size_t>(done)].first.string() +
                                                            ": cannot be written (Disk quota exceeded)");
    EXPECT_EQ(all(), "old a, old b");
    EXPECT_EQ(files_in(folder.path()), before);
    EXPECT_EQ(files_in(folder / "there"), Names{"b"});
  }
  auto impossible = files;
  for (const char* name : {"nowhere/c", "there"}) {
    impossible[2].first = folder / name;
    EXPECT_HAS(refusal([&] { write_together(impossible); }), std::string(name) + ": cannot be written (");
    EXPECT_EQ(all(), "old a, old b");
    EXPECT_EQ(files_in(folder.path()), before);
  }
  {
    const FaultySystem full({.writes = {{5, 0}, {-1, ENOSPC}}});
    EXPECT_HAS(refusal([&] { write_together(files); }), "b: cannot be written (No space left on device)");
    EXPECT_EQ(files_in(folder.path()), before);
  }
  write_together(files);
  EXPECT_EQ(all(), "new a, new b");
  EXPECT_TRUE(fs::is_symlink(folder / "b"));
  EXPECT_EQ(bytes_of(folder / "new"), "");
  EXPECT_EQ(files_in(folder.path()), (Names{"a", "b", "new", "there"}));
  EXPECT_EQ(files_in(folder / "there"), Names{"b"});
}

// The second rename fails, and then the one that puts the first file back.
TEST(NewFiles, KeepAnOldFileThatCannotBePutBack) {
  const TestFolder folder("new_files");
  folder.write("a", "old a"), folder.write("b", "old b");
  const std::string kept = (folder / "a").string() + ".old-" + std::to_string(::getpid());
  const FaultySystem failed({.renames_before = 1, .failed_renames = 2, .error_of_rename = EDQUOT});
  const std::string why = refusal([&] {
    write_together({{folder / "a", "new a"}, {folder / "b", "new b"}});
  });
  EXPECT_HAS(why, "b: cannot be written (Disk quota exceeded)");
  EXPECT_HAS(why, "; the old " + (folder / "a").string() + " is now " + kept);
  remove_leftovers(folder / "a");
  EXPECT_EQ(bytes_of(kept), "old a");
  EXPECT_EQ(bytes_of(folder / "b"), "old b");
  EXPECT_EQ(files_in(folder.path()).size(), 3u);
}

// --- a lock has one holder at a time ---

// A child may live a little longer than its killed parent.
TEST(FileLock, AChildHoldsNoneOfItsParent) {
  const TestFolder folder("file_lock_child_test");
  const FileLock lock(folder / "x.h5");
  const FolderLock of_folder(folder.path());
  const auto held = [&] {
    std::error_code gone;
    for (const auto& open : fs::directory_iterator("/proc/self/fd"))
      if (const fs::path target = fs::read_symlink(open.path(), gone);
          target == folder / "x.h5.lock" || target == folder.path())
        return "holds " + target.string();
    return std::string("holds none");
  };
  EXPECT_NE(held(), "holds none");
  EXPECT_EQ(in_child({1u << 30, 5}, held), "holds none");
}

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

  std::filesystem::create_directory(folder / "other");
  {
    const FolderLock first(folder.path());
    EXPECT_HAS(refusal([&] { FolderLock second(folder.path()); }),
               folder.path().string() + ": another process is writing there");
    EXPECT_NO_THROW(FolderLock{folder / "other"});
    EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"other", "x.h5"}));
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
}  // namespace remote_touch::atomic_file_test
