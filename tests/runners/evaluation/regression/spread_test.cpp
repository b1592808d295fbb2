// The folder of runs whose results are thrown away.
#include "runners/evaluation/regression/baselines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::spread_test {
namespace {

namespace fs = std::filesystem;

class ScratchFolderTest : public testing::Test {
 protected:
  ScratchFolderTest() { ::setenv("TMPDIR", place_.path().c_str(), 1); }
  ~ScratchFolderTest() override {
    if (before_)
      ::setenv("TMPDIR", before_->c_str(), 1);
    else
      ::unsetenv("TMPDIR");
  }

 private:
  static std::optional<std::string> now() {
    const char* const folder = std::getenv("TMPDIR");
    return folder ? std::make_optional<std::string>(folder) : std::nullopt;
  }
  const std::optional<std::string> before_ = now();

 protected:
  const TestFolder place_{"scratch_folder_test"};
};

TEST_F(ScratchFolderTest, IsRemovedAfterwardsWithItsFiles) {
  {
    const ScratchFolder one, other;
    EXPECT_NE(one.path(), other.path());
    for (const ScratchFolder* each : {&one, &other}) {
      EXPECT_EQ(each->path().parent_path(), place_.path());
      std::ofstream(each->path() / "result.h5") << "a result";
    }
    EXPECT_EQ(files_in(one.path()), std::vector<std::string>{"result.h5"});
  }
  EXPECT_TRUE(files_in(place_.path()).empty());
}

// Folders of programs that were killed are removed; those that others made are left alone.
TEST_F(ScratchFolderTest, RemovesFoldersThatNoProgramHolds) {
  place_.write("remote-touch-bless-Killed/reference.h5", "half");
  place_.write("remote-touch-other/file", "of another program");
  place_.write("remote-touch-bless-file", "no folder");
  fs::create_directory_symlink(place_ / "remote-touch-other", place_ / "remote-touch-bless-link");
  const ScratchFolder scratch;
  std::vector<std::string> left = {"remote-touch-bless-file", "remote-touch-bless-link", "remote-touch-other",
                                   scratch.path().filename().string()};
  std::sort(left.begin(), left.end());
  EXPECT_EQ(files_in(place_.path()), left);
  EXPECT_EQ(files_in(place_ / "remote-touch-other"), std::vector<std::string>{"file"});
}

TEST_F(ScratchFolderTest, NeedsAWritableFolder) {
  ::setenv("TMPDIR", (place_ / "nowhere").c_str(), 1);
  EXPECT_HAS(refusal([] { ScratchFolder(); }), "TMPDIR: ");
}

}  // namespace
}  // namespace remote_touch::spread_test
