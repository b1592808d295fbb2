// The counts that the header of a PLY file claims are checked against the size of the file before any library
// reads it.
#include "runners/experiment/mesh_files/mesh_file.h"

#include <gtest/gtest.h>
#include <string>

#include "core/mesh/triangle_mesh.h"
#include "core/mesh/voxel_tool.h"
#include "tests/support/recorded_data.h"
#include "tests/support/test_files.h"

namespace remote_touch::ply_file_test {
namespace {

std::string header(const std::string& format, const std::string& vertices, const std::string& faces) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty double z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

class PlyHeader : public testing::Test {
 protected:
  std::string problem(const std::string& bytes) const { return ply_problem(folder_.write("x.ply", bytes)); }
  TestFolder folder_{"ply_header"};
};

TEST_F(PlyHeader, PassesIfItIsTrue) {
  EXPECT_EQ(problem(header("ascii", "3", "1") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2"), "");
  const std::string binary(3 * 16 + 1, '\0');  // the face is a list of none
  EXPECT_EQ(problem(header("binary_little_endian", "3", "1") + binary), "");
  std::string windows = header("binary_big_endian", "3", "1");
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
    windows.replace(at, 1, "\r\n");
  EXPECT_EQ(problem(windows + binary), "");
  EXPECT_EQ(problem("ply\nformat ascii 1.0\ncomment end_header is near\nobj_info x\nend_header\n"), "");
}

TEST_F(PlyHeader, IsRefusedIfItDoesNotEnd) {
  const std::string whole = header("ascii", "3", "1");
  for (std::size_t length = 0; length + 1 < whole.size(); ++length)
    EXPECT_HAS(problem(whole.substr(0, length)), "its header has no end") << length;
  EXPECT_HAS(problem("ply\nformat ascii 1.0\nproperty end_header\nend_headers\n"), "its header has no end");
}

// The file holds one byte less than what is claimed, or far less.
TEST_F(PlyHeader, CountsBeyondTheFileAreRefused) {
  EXPECT_HAS(problem(header("binary_little_endian", "3", "1") + std::string(3 * 16, '\0')),
             "its header claims 4 elements, more than its 48 bytes hold");
  EXPECT_HAS(problem(header("ascii", "3", "1") + "0 0 0\n1 0 0\n0 1 0"), "its header claims 4 elements");
  for (const char* many : {"300000000", "4294967295", "4294967296", "18446744073709551615"}) {
    EXPECT_HAS(problem(header("ascii", many, "1") + "0 0 0\n"), "its header claims") << many;
    EXPECT_HAS(problem(header("ascii", "0", many) + "0 0 0\n"), "its header claims") << many;
    EXPECT_HAS(problem(header("binary_big_endian", many, many) + "0 0 0\n"), "its header claims") << many;
  }
}

TEST_F(PlyHeader, InvalidCountsAreRefused) {
  for (const char* none : {"-1", "many", "18446744073709551616", "3.5", ""})
    EXPECT_HAS(problem(header("ascii", none, "1") + "0 0 0\n"),
               "its header has a count that is not a number: ")
        << none;
}

// Meshes that are kept outside of the repository; the tests are skipped if they are missing.

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
}  // namespace remote_touch::ply_file_test
