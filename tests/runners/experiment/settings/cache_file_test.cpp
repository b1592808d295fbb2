#include "runners/experiment/settings/cache_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <ctime>
#include <new>
#include <string>

#include "tests/support/test_files.h"

namespace remote_touch::cache_file_test {
namespace {

TEST(CacheFolder, IsTakenFromTheEnvironment) {
  ::setenv("REMOTE_TOUCH_CACHE", "/c", 1);
  EXPECT_EQ(cache_folder(), "/c");
  ::unsetenv("REMOTE_TOUCH_CACHE");
  const char* home = std::getenv("HOME");
  const std::string kept = home != nullptr ? home : "";
  ::unsetenv("XDG_CACHE_HOME"), ::setenv("HOME", "/h", 1);
  EXPECT_EQ(cache_folder(), "/h/.cache/remote-touch");
  ::setenv("XDG_CACHE_HOME", "/x", 1);
  EXPECT_EQ(cache_folder(), "/x/remote-touch");
  ::unsetenv("XDG_CACHE_HOME"), ::unsetenv("HOME");
  EXPECT_EQ(cache_folder(), "");
  if (home != nullptr) ::setenv("HOME", kept.c_str(), 1);
}

// The folder of the cache is bounded: what was used longest ago goes first.

void take(Unpacker& unpack) {
  std::string text;
  unpack.text(text);
}

class CacheSizeTest : public testing::Test {
 protected:
  CacheSizeTest() { ::unsetenv("REMOTE_TOUCH_CACHE_MB"); }  // the user may have set it
  ~CacheSizeTest() override { ::unsetenv("REMOTE_TOUCH_CACHE_MB"); }

  void add(const std::string& name, std::size_t bytes, int used_s_ago) const {
    folder_.write(name, std::string(bytes, 'x'));
    set_used(name, used_s_ago);
  }
  void set_used(const std::string& name, int s_ago) const {
    const timespec times[] = {{std::time(nullptr) - s_ago, 0}, {0, UTIME_OMIT}};
    ASSERT_EQ(::utimensat(AT_FDCWD, (folder_ / name).c_str(), times, 0), 0);
  }
  std::vector<std::string> names() const { return files_in(folder_.path()); }

  TestFolder folder_{"cache_size"};
};

TEST_F(CacheSizeTest, RemovesTheLeastRecentlyUsedFilesFirst) {
  add("a.tool", 100, 30), add("b.spheres", 100, 50), add("c.tool", 100, 10), add("d.tool", 100, 40);
  EXPECT_EQ(cache_size(folder_.path()).bytes, 400u);
  EXPECT_EQ(shrink_cache(folder_.path(), 400).files, 4u);
  const CacheSize left = shrink_cache(folder_.path(), 250);
  EXPECT_EQ(left.files, 2u);
  EXPECT_EQ(left.bytes, 200u);
  EXPECT_EQ(names(), (std::vector<std::string>{"a.tool", "c.tool"}));
  EXPECT_EQ(shrink_cache(folder_.path(), 0).files, 0u);
  EXPECT_TRUE(names().empty());
}

TEST_F(CacheSizeTest, OnlyItsOwnFilesGo) {
  add("notes.txt", 100, 9999), add("k.partial-AbCdEf", 100, 7200), add("l.partial-AbCdEf", 100, 60);
  EXPECT_EQ(shrink_cache(folder_.path(), 0).bytes, 0u);
  EXPECT_EQ(names(), (std::vector<std::string>{"l.partial-AbCdEf", "notes.txt"}));
}

TEST_F(CacheSizeTest, AWriterRemovesWhatKilledProgramsLeft) {
  add("k.partial-AbCdEf", 100, 7200), add("l.partial-AbCdEf", 100, 60), add("a.tool", 100, 9999);
  ASSERT_TRUE(write_cache_file(folder_.path(), {"tool", 1}, "m", [](CacheWriter&) {}));
  EXPECT_EQ(names(), (std::vector<std::string>{"a.tool", "l.partial-AbCdEf", "m.tool"}));
}

TEST_F(CacheSizeTest, AMissingFolderCountsAsEmpty) {
  EXPECT_EQ(cache_size(folder_ / "nowhere").files, 0u);
  EXPECT_EQ(shrink_cache(folder_ / "nowhere", 0).files, 0u);
}

// Written files make room for themselves, and reading one keeps it.
TEST_F(CacheSizeTest, WritingKeepsTheCacheBelowItsMaximum) {
  ::setenv("REMOTE_TOUCH_CACHE_MB", "0.0025", 1);  // 2500 bytes: two files
  const auto put = [](CacheWriter& pack) { pack.text(std::string(1000, 'x')); };
  const CacheKind kind{"tool", 1};
  ASSERT_TRUE(write_cache_file(folder_.path(), kind, "a", put));
  ASSERT_TRUE(write_cache_file(folder_.path(), kind, "b", put));
  set_used("a.tool", 60), set_used("b.tool", 50);
  ASSERT_TRUE(read_cache_file(folder_.path(), kind, "a", take));
  ASSERT_TRUE(write_cache_file(folder_.path(), kind, "c", put));
  EXPECT_EQ(names(), (std::vector<std::string>{"a.tool", "c.tool"}));
}

TEST_F(CacheSizeTest, AWriterThatFailsLeavesNoFile) {
  const auto put = [](CacheWriter& pack) {
    pack.text("a part");
    throw std::bad_alloc();
  };
  EXPECT_THROW(write_cache_file(folder_.path(), {"tool", 1}, "a", put), std::bad_alloc);
  EXPECT_TRUE(names().empty());
}

TEST_F(CacheSizeTest, AFileOfAnotherKeyIsNotTaken) {
  const CacheKind kind{"tool", 1};
  ASSERT_TRUE(write_cache_file(folder_.path(), kind, "a", [](CacheWriter& pack) { pack.text("of a"); }));
  folder_.write("b.tool", bytes_of(folder_ / "a.tool"));
  std::string taken;
  const auto take = [&](Unpacker& unpack) { unpack.text(taken); };
  EXPECT_FALSE(read_cache_file(folder_.path(), kind, "b", take));
  EXPECT_EQ(taken, "");
  EXPECT_TRUE(read_cache_file(folder_.path(), kind, "a", take));
  EXPECT_EQ(taken, "of a");
}

TEST_F(CacheSizeTest, TheMaximumIsTakenFromTheEnvironment) {
  EXPECT_EQ(max_cache_bytes(), 512'000'000u);
  ::setenv("REMOTE_TOUCH_CACHE_MB", "1.5", 1);
  EXPECT_EQ(max_cache_bytes(), 1'500'000u);
  for (const char* wrong : {"-1", "x", "1 MB", "nan", "inf"}) {
    ::setenv("REMOTE_TOUCH_CACHE_MB", wrong, 1);
    EXPECT_HAS(refusal([] { max_cache_bytes(); }), std::string("REMOTE_TOUCH_CACHE_MB = ") + wrong);
  }
}

}  // namespace
}  // namespace remote_touch::cache_file_test
