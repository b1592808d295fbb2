// Tools from files and from the cache: the same bits, made anew where a file of the cache is damaged.
#include "runners/experiment/mesh_files/loaded_tool.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "runners/experiment/settings/cache_file.h"
#include "runners/experiment/settings/provenance.h"
#include "scenarios/recordings/recording.h"
#include "tests/support/meshes.h"
#include "tests/support/test_files.h"

namespace remote_touch::tool_loading_test {
namespace {

namespace fs = std::filesystem;

const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

void expect_equal(const VoxelTool& a, const VoxelTool& b) {
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.grid.origin_T, b.grid.origin_T);
  EXPECT_EQ(a.grid.size_m, b.grid.size_m);
  EXPECT_EQ(a.grid.cells, b.grid.cells);
  EXPECT_EQ(a.voxels, b.voxels);
  EXPECT_EQ(a.distance_m, b.distance_m);
  EXPECT_EQ(a.volume_m3, b.volume_m3);
  EXPECT_EQ(a.inertia_m2, b.inertia_m2);
  EXPECT_EQ(a.reach_m, b.reach_m);
}

class ToolCacheTest : public testing::Test {
 protected:
  ToolCacheTest() {
    ::setenv("REMOTE_TOUCH_CACHE", (folder_ / "cache").c_str(), 1);
    ::unsetenv("REMOTE_TOUCH_CACHE_MB");  // the user may have set it
    set_data_folder(folder_.path().string());
  }
  ~ToolCacheTest() override { ::unsetenv("REMOTE_TOUCH_CACHE"), set_data_folder({}); }

  std::shared_ptr<const VoxelTool> bar() const { return load_tool(bar_, nullptr); }
  fs::path only_file() const {
    const auto names = files_in(folder_ / "cache");
    EXPECT_EQ(names.size(), 1u);
    return folder_ / "cache" / (names.empty() ? "none" : names[0]);
  }

  fs::path spheres_file() const {
    for (const std::string& name : files_in(folder_ / "cache"))
      if (name.ends_with(".spheres")) return folder_ / "cache" / name;
    return {};
  }

  TestFolder folder_{"tool_cache"};
  const ToolSettings bar_{.mesh = "bar", .voxel_m = 1e-3}, slab_{.mesh = "slab-20", .voxel_m = 2e-3};
};

TEST_F(ToolCacheTest, FreshAndCachedAreTheSameBits) {
  std::string made, again;
  const auto fresh = load_tool(bar_, &made);
  const auto before = fs::last_write_time(only_file());
  const auto cached = load_tool(bar_, &again);
  expect_equal(*fresh, *cached);
  EXPECT_EQ(made, again);
  EXPECT_HAS(made, "80.0 x 20.0 x 10.0 mm");
  EXPECT_EQ(fs::last_write_time(only_file()), before) << "made anew";
}

// The sources of a tool can change without a change of anything that a person maintains. So the key has the
// digest of all of them, and each build has tools of its own.
TEST_F(ToolCacheTest, TheKeyHasTheBuild) {
  std::string digest;
  for (const auto& [name, value] : provenance("", "", ""))
    if (name == "source_digest") digest = value;
  ASSERT_EQ(digest.size(), 64u);
  EXPECT_HAS(build_for_keys(), digest);
  CacheWriter pack;
  pack.text(build_for_keys());
  pack.text("mesh");
  pack.value(5e-4), pack.value(0.02), pack.value(false);
  EXPECT_EQ(tool_key("mesh", {5e-4, 0.02}), pack.hex());
}

TEST_F(ToolCacheTest, EverySettingHasATool) {
  ToolSettings larger = bar_, finer = bar_, mended = bar_, other = bar_;
  larger.size_m = 0.1, finer.voxel_m = 9e-4, mended.repair = true, other.mesh = "slab-10";
  for (const ToolSettings& s : {bar_, larger, finer, mended, other}) load_tool(s);
  EXPECT_EQ(files_in(folder_ / "cache").size(), 5u);
  EXPECT_EQ(load_tool(finer)->grid.size_m, 9e-4);
}

// A file is made anew if any byte is changed, if it is cut anywhere, longer, empty or of another tool, and if
// a folder has its name.
TEST_F(ToolCacheTest, ADamagedFileIsMadeAnew) {
  const auto fresh = bar();
  const fs::path file = only_file();
  const std::string good = bytes_of(file), name = file.filename().string();
  const std::string key = name.substr(0, name.size() - 5);
  std::vector<std::string> damaged = {"", "remote-touch-tool/1\n", good + "x", good.substr(1)};
  for (std::size_t i = 0; i < 12; ++i) {
    std::string changed = good;
    changed[i * (good.size() - 1) / 11] ^= 1;
    damaged.push_back(changed);
    damaged.push_back(good.substr(0, i * good.size() / 12));
  }
  for (const std::string& bytes : damaged) {
    folder_.write("cache/" + name, bytes);
    EXPECT_FALSE(read_tool(folder_ / "cache", key)) << bytes.size();
  }
  expect_equal(*bar(), *fresh);
  EXPECT_EQ(bytes_of(file), good);
  folder_.write("cache/" + std::string(64, '0') + ".tool", good);
  EXPECT_FALSE(read_tool(folder_ / "cache", std::string(64, '0'))) << "of another key";
  fs::remove(file), fs::create_directory(file);
  expect_equal(*bar(), *fresh);
}

TEST_F(ToolCacheTest, AFolderThatCannotBeUsedIsNoError) {
  const auto fresh = bar();
  const fs::path in_the_way = folder_.write("plain", "a file");
  for (const fs::path& folder : {in_the_way, in_the_way / "below", fs::path("/proc/none")}) {
    ::setenv("REMOTE_TOUCH_CACHE", folder.c_str(), 1);
    expect_equal(*bar(), *fresh);
    EXPECT_FALSE(write_tool(folder, "key", {*fresh, ""}));
  }
  EXPECT_FALSE(write_tool({}, "key", {*fresh, ""}));
  EXPECT_EQ(bytes_of(in_the_way), "a file");
}

TEST_F(ToolCacheTest, ManyProgramsAtOnceGetTheSameToolAndLeaveOneFile) {
  const auto fresh = bar();
  fs::remove_all(folder_ / "cache");
  std::vector<std::shared_ptr<const VoxelTool>> got(8);
  {
    std::vector<std::jthread> threads;
    for (auto& tool : got) threads.emplace_back([&tool, this] { tool = bar(); });
  }
  for (const auto& tool : got) expect_equal(*tool, *fresh);
  only_file();
}

TEST_F(ToolCacheTest, AMeshFileIsFoundBelowTheDataAndCountsByItsContent) {
  folder_.write("meshes/cube.obj", kCube);
  const ToolSettings cube{.mesh = "meshes/cube.obj", .size_m = 0.02, .voxel_m = 1e-3};
  EXPECT_NEAR(load_tool(cube)->volume_m3, 8e-6, 1e-12);
  expect_equal(*load_tool(cube), *load_tool(cube));
  folder_.write("meshes/cube.obj", "v 0 -1 0" + kCube.substr(7));  // one corner elsewhere
  EXPECT_GT(std::abs(load_tool(cube)->volume_m3 - 8e-6), 1e-7);
  EXPECT_EQ(files_in(folder_ / "cache").size(), 2u);
}

TEST_F(ToolCacheTest, ResultsHoldTheHashOfTheMesh) {
  EXPECT_TRUE(input_files(bar_).empty());
  folder_.write("meshes/cube.obj", kCube);
  const std::vector<InputPart> parts = input_files(ToolSettings{.mesh = "meshes/cube.obj"});
  ASSERT_EQ(parts.size(), 1u);
  const std::string before = input_hashes(parts);
  EXPECT_HAS(before, "meshes/cube.obj: 1 file(s), " + std::to_string(kCube.size()) + " bytes, sha256 ");
  folder_.write("meshes/cube.obj", kCube + "\n");
  EXPECT_NE(input_hashes(parts), before);
}

TEST_F(ToolCacheTest, RefusalsNameTheParameter) {
  EXPECT_HAS(refusal([] { load_tool({.mesh = "none.obj"}); }),
             "renderer.tool_mesh = none.obj: no such mesh: expected ball, bar, block, fork, husky");
  EXPECT_THROW(load_tool({.mesh = "none.obj"}), MissingInput);
  folder_.write("open.obj", kCube.substr(0, kCube.size() - 10));
  EXPECT_HAS(refusal([] { load_tool({.mesh = "open.obj", .size_m = 0.02}); }),
             "renderer.tool_mesh = open.obj: not closed: 4 boundary edges");
  EXPECT_TRUE(load_tool({.mesh = "open.obj", .size_m = 0.02, .voxel_m = 1e-3, .repair = true}));
  EXPECT_EQ(validate(bar_), "");
  EXPECT_HAS(validate({.mesh = "wolf"}), "tool_mesh = wolf: expected ball, bar");
  EXPECT_HAS(validate({.mesh = ""}), "expected ball, bar");
  EXPECT_HAS(validate({.size_m = 5e-4}), "tool_size_m = 0.000500: expected two voxels");
}

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

TEST_F(ToolCacheTest, FreshAndCachedSpheresAreTheSameBits) {
  std::string made, again;
  const ToolOfSpheres fresh = load_tool_of_spheres(slab_, 20, &made);
  const auto before = fs::last_write_time(spheres_file());
  const ToolOfSpheres cached = load_tool_of_spheres(slab_, 20, &again);
  EXPECT_EQ(numbers_of(*fresh.spheres), numbers_of(*cached.spheres));
  EXPECT_EQ(made, again);
  EXPECT_HAS(made, "spheres, at most");
  EXPECT_EQ(fs::last_write_time(spheres_file()), before) << "made anew";
}

TEST_F(ToolCacheTest, EveryNumberOfLeavesHasItsOwnSpheres) {
  EXPECT_NE(spheres_key("tool", 20), spheres_key("tool", 21));
  EXPECT_NE(spheres_key("tool", 20), spheres_key("other", 20));
  EXPECT_LE(load_tool_of_spheres(slab_, 8).spheres->spheres.leaves().size(), 8u);
  EXPECT_GT(load_tool_of_spheres(slab_, 40).spheres->spheres.leaves().size(), 8u);
}

// A whole file of this kind whose counts are not those of its leaves, which no honest writer makes.
TEST_F(ToolCacheTest, SpheresWhoseCountsDoNotFitAreRefused) {
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
}  // namespace remote_touch::tool_loading_test
