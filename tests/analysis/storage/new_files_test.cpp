#include "analysis/storage/new_files.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::new_files_test {
namespace {

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
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  files.finish();
  EXPECT_EQ(bytes_of(folder / "a"), "one two");
  EXPECT_EQ(bytes_of(folder / "b"), "new");
  EXPECT_EQ(files_in(folder.path()), (Names{"a", "b"}));
}

TEST(NewFiles, KeepThePermissionsOfTheFilesThatTheyReplace) {
  const TestFolder folder("new_files");
  std::filesystem::permissions(folder.write("a", "old"), static_cast<std::filesystem::perms>(0600));
  NewFiles files;
  files.begin(folder / "a");
  files.append("new");
  files.finish();
  EXPECT_EQ(bytes_of(folder / "a"), "new");
  EXPECT_EQ(std::filesystem::status(folder / "a").permissions(), static_cast<std::filesystem::perms>(0600));
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

// The folder of the third target disappears before the files are renamed.
TEST(NewFiles, AFailedRenameRestoresAllFiles) {
  const TestFolder folder("new_files");
  folder.write("b", "old");
  {
    NewFiles files;
    for (const char* name : {"a", "b", "gone/c"}) {
      if (std::string(name) == "gone/c") std::filesystem::create_directory(folder / "gone");
      files.begin(folder / name);
      files.append("new");
    }
    std::filesystem::remove_all(folder / "gone");
    EXPECT_HAS(refusal([&] { files.finish(); }), "gone/c: cannot be written (No such file");
  }
  EXPECT_EQ(files_in(folder.path()), Names{"b"});
  EXPECT_EQ(bytes_of(folder / "b"), "old");
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
