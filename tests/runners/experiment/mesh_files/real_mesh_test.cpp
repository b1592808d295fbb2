// Meshes that are kept outside of the repository; the tests are skipped if they are missing.
#include <gtest/gtest.h>

#include "core/mesh/triangle_mesh.h"
#include "core/mesh/voxel_tool.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "tests/support/recorded_data.h"

namespace remote_touch::real_mesh_test {
namespace {

namespace fs = std::filesystem;

struct Known {
  const char* file;
  int vertices, triangles, boundary_edges, non_manifold_edges, parts;
};
class RealMeshTest : public testing::TestWithParam<Known> {};

TEST_P(RealMeshTest, IsAsItsReadmeSays) {
  const fs::path file = data_root() / "meshes" / GetParam().file;
  if (!fs::exists(file)) GTEST_SKIP() << "recorded data are missing: " << file;
  const MeshCheck check = check_mesh(read_mesh(file));
  EXPECT_EQ(check.vertices, GetParam().vertices);
  EXPECT_EQ(check.triangles, GetParam().triangles);
  EXPECT_EQ(check.boundary_edges, GetParam().boundary_edges);
  EXPECT_EQ(check.non_manifold_edges, GetParam().non_manifold_edges);
  EXPECT_EQ(check.parts, GetParam().parts);
}

// Coarse voxels save time. Interior and shell together have the volume of the mesh, but parts that overlap
// count twice in the mesh.
TEST_P(RealMeshTest, BecomesATool) {
  const fs::path file = data_root() / "meshes" / GetParam().file;
  if (!fs::exists(file)) GTEST_SKIP() << "recorded data are missing: " << file;
  ToolReport report;
  const VoxelToolSettings settings{.voxel_m = 2e-3, .size_m = 0.15, .repair = GetParam().boundary_edges > 0};
  const VoxelTool tool = make_voxel_tool(read_mesh(file), settings, report);
  const double voxel = 8e-9, solid = static_cast<double>(report.voxels[2]),
               shell = static_cast<double>(report.voxels[1]);
  EXPECT_GT(tool.volume_m3, voxel * solid);
  EXPECT_NEAR(tool.volume_m3, voxel * (solid + shell), (settings.repair ? 0.1 : 0.02) * tool.volume_m3);
  EXPECT_NEAR(report.sides_m.maxCoeff(), 0.15, 1e-9);
  EXPECT_LT(report.thin_fraction, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Meshes, RealMeshTest,
                         testing::Values(Known{"stanford_bunny.obj", 3301, 6598, 0, 0, 1},
                                         Known{"hand_closed.obj", 7993, 15982, 0, 0, 1},
                                         Known{"husky.obj", 962, 1920, 0, 0, 1},
                                         Known{"pr2_gripper_coarse_15cm.obj", 939, 1795, 81, 6, 5},
                                         Known{"ycb_power_drill.obj", 7866, 15728, 0, 0, 1}),
                         [](const auto& tool) {
                           std::string name = tool.param.file;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace remote_touch::real_mesh_test
