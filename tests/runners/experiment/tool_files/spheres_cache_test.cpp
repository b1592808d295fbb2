#include "runners/experiment/tool_files/spheres_cache.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "runners/experiment/provenance/cache_file.h"
#include "runners/experiment/tool_files/tool_loading.h"
#include "tests/support/test_files.h"

namespace remote_touch::spheres_cache_test {
namespace {

namespace fs = std::filesystem;

void expect_equal(const ToolSpheres& a, const ToolSpheres& b) {
  ASSERT_EQ(a.spheres.leaves().size(), b.spheres.leaves().size());
  ASSERT_EQ(a.spheres.level_count(), b.spheres.level_count());
  for (std::size_t i = 0; i < a.spheres.leaves().size(); ++i) {
    EXPECT_EQ(a.spheres.leaves()[i].centre, b.spheres.leaves()[i].centre);
    EXPECT_EQ(a.spheres.leaves()[i].radius_m, b.spheres.leaves()[i].radius_m);
  }
  for (std::size_t level = 0; level < a.spheres.level_count(); ++level)
    for (std::size_t i = 0; i < a.spheres.level(level).size(); ++i) {
      EXPECT_EQ(a.spheres.level(level)[i].sphere.centre, b.spheres.level(level)[i].sphere.centre);
      EXPECT_EQ(a.spheres.level(level)[i].first, b.spheres.level(level)[i].first);
      EXPECT_EQ(a.spheres.level(level)[i].count, b.spheres.level(level)[i].count);
    }
  EXPECT_EQ(a.inflation_m, b.inflation_m);
  EXPECT_EQ(a.outside_m, b.outside_m);
  EXPECT_EQ(a.surface_outside_m, b.surface_outside_m);
}

class SpheresCacheTest : public testing::Test {
 protected:
  SpheresCacheTest() {
    ::setenv("REMOTE_TOUCH_CACHE", (folder_ / "cache").c_str(), 1);
    ::unsetenv("REMOTE_TOUCH_CACHE_MB");  // the user may have set it
  }
  ~SpheresCacheTest() override { ::unsetenv("REMOTE_TOUCH_CACHE"); }

  fs::path spheres_file() const {
    for (const std::string& name : files_in(folder_ / "cache"))
      if (name.ends_with(".spheres")) return folder_ / "cache" / name;
    return {};
  }

  TestFolder folder_{"spheres_cache"};
  const ToolSettings slab_{.mesh = "slab-20", .voxel_m = 2e-3};
};

TEST_F(SpheresCacheTest, FreshAndCachedAreTheSameBits) {
  std::string made, again;
  const ToolOfSpheres fresh = load_tool_of_spheres(slab_, 20, &made);
  const auto before = fs::last_write_time(spheres_file());
  const ToolOfSpheres cached = load_tool_of_spheres(slab_, 20, &again);
  expect_equal(*fresh.spheres, *cached.spheres);
  EXPECT_EQ(made, again);
  EXPECT_HAS(made, "spheres, at most");
  EXPECT_EQ(fs::last_write_time(spheres_file()), before) << "made anew";
}

TEST_F(SpheresCacheTest, EveryNumberOfLeavesHasItsOwn) {
  EXPECT_NE(spheres_key("tool", 20), spheres_key("tool", 21));
  EXPECT_NE(spheres_key("tool", 20), spheres_key("other", 20));
  EXPECT_LE(load_tool_of_spheres(slab_, 8).spheres->spheres.leaves().size(), 8u);
  EXPECT_GT(load_tool_of_spheres(slab_, 40).spheres->spheres.leaves().size(), 8u);
}

// A file that is cut or changed is made anew.
TEST_F(SpheresCacheTest, ADamagedFileIsMadeAnew) {
  const ToolOfSpheres fresh = load_tool_of_spheres(slab_, 20);
  const fs::path file = spheres_file();
  const std::string good = bytes_of(file), name = file.filename().string(), key = name.substr(0, 64);
  for (std::size_t i = 0; i < 8; ++i) {
    std::string changed = good;
    changed[i * (good.size() - 1) / 7] ^= 1;
    folder_.write("cache/" + name, changed);
    EXPECT_FALSE(read_spheres(folder_ / "cache", key)) << i;
    folder_.write("cache/" + name, good.substr(0, i * good.size() / 8));
    EXPECT_FALSE(read_spheres(folder_ / "cache", key)) << i;
  }
  expect_equal(*load_tool_of_spheres(slab_, 20).spheres, *fresh.spheres);
  EXPECT_EQ(bytes_of(file), good);
}

// A whole file of this kind whose counts are not those of its leaves, which no honest writer makes.
TEST_F(SpheresCacheTest, CountsThatDoNotFitAreRefused) {
  const std::vector<double> leaves(8, 0.01);
  for (const std::vector<std::uint32_t>& counts : {std::vector<std::uint32_t>{1}, {2, 1}, {1, 2}, {3}, {}}) {
    const auto put = [&](CacheWriter& pack) {
      pack.list(leaves), pack.list(counts);
      for (int i = 0; i < 3; ++i) pack.value(0.0);
    };
    ASSERT_TRUE(write_cache_file(folder_ / "cache", {"spheres", kSpheresFormat}, "key", put));
    EXPECT_FALSE(read_spheres(folder_ / "cache", "key"));
  }
}

}  // namespace
}  // namespace remote_touch::spheres_cache_test
