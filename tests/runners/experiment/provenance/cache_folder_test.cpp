#include "runners/experiment/provenance/cache_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace remote_touch::cache_folder_test {
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

}  // namespace
}  // namespace remote_touch::cache_folder_test
