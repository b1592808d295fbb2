#include "analysis/storage/new_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>

#include "analysis/storage/atomic_file.h"
#include "tests/analysis/storage/system_answers.h"
#include "tests/support/test_files.h"

namespace remote_touch::new_files_test {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

TEST(NewFiles, AppearTogether) {
  const TestFolder folder("new_files");
  folder.write("b", "old");
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
  EXPECT_EQ(files_in(folder.path()), (Names{"a", "b"}));
}

TEST(NewFiles, KeepThePermissionsOfTheFilesThatTheyReplace) {
  const TestFolder folder("new_files");
  fs::permissions(folder.write("a", "old"), static_cast<fs::perms>(0600));
  NewFiles files;
  files.begin(folder / "a");
  files.append("new");
  files.finish();
  EXPECT_EQ(bytes_of(folder / "a"), "new");
  EXPECT_EQ(fs::status(folder / "a").permissions(), static_cast<fs::perms>(0600));
}

TEST(NewFiles, LeaveNothingIfTheyAreNotFinished) {
  const TestFolder folder("new_files");
  folder.write("b", "old");
  {
    NewFiles files;
    for (const char* name : {"a", "b"}) {
      files.begin(folder / name);
      files.append("new");
    }
  }
  EXPECT_EQ(files_in(folder.path()), Names{"b"});
  EXPECT_EQ(bytes_of(folder / "b"), "old");
}

using Contents = std::vector<std::pair<fs::path, std::string>>;  // by target

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
    const FailedRename failed(done, EDQUOT);
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
    const AnswersOfWrite full{{5, 0}, {-1, ENOSPC}};
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
  const FailedRename failed(1, EDQUOT, 2);
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

TEST(NewFiles, AreNamedIfTheyCannotBeBegun) {
  const TestFolder folder("new_files");
  NewFiles files;
  EXPECT_HAS(refusal([&] { files.begin(folder / "nowhere/a"); }), "nowhere/a: cannot be written");
  EXPECT_HAS(refusal([&] { files.begin("/dev/null"); }), "/dev/null: cannot be written");
  EXPECT_HAS(refusal([&] { files.begin(folder.path()); }), "cannot be written (Is a directory)");
}

}  // namespace
}  // namespace remote_touch::new_files_test
