#include "runners/experiment/tool_files/spheres_cache.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "runners/experiment/provenance/cache_file.h"
#include "runners/experiment/tool_files/tool_loading.h"
#include "tests/support/test_files.h"

namespace remote_touch::spheres_cache_test {
namespace {

namespace fs = std::filesystem;

// Every number of the spheres, in an order that tells different trees apart.
std::vector<double> numbers_of(const ToolSpheres& tool) {
  std::vector<double> all{tool.inflation_m, tool.outside_m, tool.surface_outside_m};
  const auto add = [&](const Sphere& sphere) {
    all.insert(all.end(), {sphere.centre.x(), sphere.centre.y(), sphere.centre.z(), sphere.radius_m});
  };
  for (const Sphere& leaf : tool.spheres.leaves()) add(leaf);
  for (std::size_t level = 0; level < tool.spheres.level_count(); ++level)
    for (const SphereNode& node : tool.spheres.level(level)) {
      all.insert(all.end(), {static_cast<double>(level), static_cast<double>(node.first)});
      all.push_back(node.count), add(node.sphere);
    }
  return all;
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
  EXPECT_EQ(numbers_of(*fresh.spheres), numbers_of(*cached.spheres));
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
