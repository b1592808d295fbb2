// The file that leads a browser to the page of a live run.
#include "runners/live/loop/live_view.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::live_view_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAddress = "http://127.0.0.1:40123/0123456789abcdef0123456789abcdef/";

// A browser in a snap reads no file whose name begins with a dot.
TEST(RedirectPage, IsAFileWithTheAddressThatOnlyTheUserCanRead) {
  const TestFolder folder("redirect");
  const RedirectPage page(kAddress, {folder.path()});
  const auto names = files_in(folder.path());
  ASSERT_EQ(names.size(), 1u);
  EXPECT_EQ(page.file(), (folder / names[0]).string());
  EXPECT_TRUE(names[0].starts_with("remote-touch-live-") && names[0].ends_with(".html")) << names[0];
  EXPECT_EQ(fs::status(page.file()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_HAS(bytes_of(page.file()), std::string("url=") + kAddress + "\"");
}

TEST(RedirectPage, IsRemovedAtTheEndAlsoAfterAMove) {
  const TestFolder folder("redirect");
  {
    RedirectPage kept;
    kept = RedirectPage(kAddress, {folder.path()});
    EXPECT_EQ(files_in(folder.path()).size(), 1u) << "moved, not removed";
  }
  EXPECT_TRUE(files_in(folder.path()).empty());
}

TEST(RedirectPage, IsWrittenToTheNextFolderIfTheFirstIsNone) {
  const TestFolder folder("redirect");
  EXPECT_TRUE(RedirectPage(kAddress, {folder / "none"}).file().empty());
  const RedirectPage page(kAddress, {folder / "none", folder.path()});
  EXPECT_EQ(fs::path(page.file()).parent_path(), folder.path());
}

}  // namespace
}  // namespace remote_touch::live_view_test
