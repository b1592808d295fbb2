// Meshes from files; those that are kept outside of the repository are skipped where they are missing.
#include "runners/tool_files/mesh_file.h"

#include <gtest/gtest.h>

#include "core/tool/mesh/mesh_check.h"
#include "core/tool/voxels/voxel_tool.h"
#include "tests/support/meshes.h"
#include "tests/support/recorded_data.h"
#include "tests/support/test_files.h"

namespace remote_touch::mesh_file_test {
namespace {

namespace fs = std::filesystem;

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";

class MeshFileTest : public testing::Test {
 protected:
  MeshCheck check(const std::string& name, const std::string& bytes) const {
    return check_mesh(read_mesh(folder_.write(name, bytes)));
  }
  TestFolder folder_{"mesh_file"};
};

TEST_F(MeshFileTest, ObjWithPolygonsOfFourAndAllKindsOfFaces) {
  const MeshCheck cube =
      check("cube.obj", kVertices +
                            "vt 0 0\nvn 0 0 1\nf 1 3 4 2\nf 5/1 6/1 8/1 7/1\nf 1//1 2//1 6//1 5//1\n"
                            "f 3/1/1 7/1/1 8/1/1 4/1/1\nf -8 -4 -2 -6\nf 2 4 8 6\n");
  EXPECT_TRUE(cube.closed()) << text(cube);
  EXPECT_EQ(cube.vertices, 8);
  EXPECT_EQ(cube.triangles, 12);
  EXPECT_NEAR(cube.volume_m3, 1, 1e-12);
}

TEST_F(MeshFileTest, ObjectsOfAFileAreOneMesh) {
  const MeshCheck cube = check("Cube.OBJ", "mtllib none.mtl\n" + kVertices +
                                               "o a\nusemtl x\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\no b\n"
                                               "g c\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  EXPECT_TRUE(cube.closed()) << text(cube);
  EXPECT_EQ(cube.parts, 1);
}

TEST_F(MeshFileTest, StlHasNoSharedVertices) {
  std::string stl = "solid t\n";
  const TriangleMesh solid = meshes::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  for (const auto& triangle : solid.triangles) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : triangle) {
      const Vec3& v = solid.vertices[corner];
      stl += "vertex " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " -" + std::to_string(v.z()) +
             "\n";
    }
    stl += "endloop\nendfacet\n";
  }
  const MeshCheck check_of =
      check("t.stl", stl + "endsolid t\n");  // mirrored: inside out, and 0 and -0 are one
  EXPECT_TRUE(check_of.closed()) << text(check_of);
  EXPECT_EQ(check_of.vertices, 4);
  EXPECT_NEAR(check_of.volume_m3, -1.0 / 6, 1e-9);
}

TEST_F(MeshFileTest, Ply) {
  const MeshCheck solid =
      check("t.ply",
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
            "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  EXPECT_TRUE(solid.closed()) << text(solid);
  EXPECT_NEAR(solid.volume_m3, 1.0 / 6, 1e-9);
}

TEST_F(MeshFileTest, RefusalsNameTheFile) {
  EXPECT_HAS(refusal([&] { read_mesh(folder_ / "none.obj"); }), "none.obj: no such file: expected an OBJ");
  EXPECT_HAS(refusal([&] { read_mesh(folder_.write("a.txt", "v 0 0 0\n")); }), "a.txt: not a mesh");
  EXPECT_HAS(refusal([&] { read_mesh(folder_.write("empty.obj", "")); }), "empty.obj: cannot be read");
  EXPECT_HAS(refusal([&] { read_mesh(folder_.write("bad.ply", "ply\nformat nothing\n")); }),
             "bad.ply: cannot be read");
  EXPECT_HAS(refusal([&] { read_mesh(folder_.write("points.obj", kVertices + "p 1\np 2\n")); }),
             "points.obj: ");
  EXPECT_HAS(refusal([&] { read_mesh(folder_.write("cut.stl", std::string(84, '\1'))); }), "cut.stl: ");
}

std::string ply(const std::string& format, const std::string& vertices, const std::string& faces) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uint int vertex_indices\nend_header\n";
}

// Each made the library take gigabytes or go on for ever.
TEST_F(MeshFileTest, FilesThatClaimMoreThanTheyHoldAreRefused) {
  const std::string points(9 * 4, '\0');
  const auto refused = [&](const std::string& name, const std::string& bytes) {
    const fs::path file = folder_.write(name, bytes);
    return refusal([&] { read_mesh(file); });
  };
  EXPECT_HAS(refused("cut.ply", "ply\nformat ascii 1.0\n"),
             "cut.ply: cannot be read (its header has no end)");
  EXPECT_HAS(refused("many.ply", ply("ascii", "300000000", "1") + "0 0 0\n"),
             "many.ply: cannot be read (its header claims");
  EXPECT_HAS(refused("faces.ply", ply("binary_little_endian", "3", "4000000000") + points),
             "faces.ply: cannot be read (its header claims");
  EXPECT_HAS(refused("list.ply", ply("binary_little_endian", "3", "1") + points + raw(1u << 30) + points),
             "list.ply: cannot be read (");
  EXPECT_HAS(refused("list.ply", ply("ascii", "3", "1") + "0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n"),
             "list.ply: cannot be read (");
  EXPECT_HAS(refused("many.stl", std::string(80, ' ') + raw(4'000'000'000u) + std::string(50, '\0')),
             "many.stl: cannot be read (");
}

TEST_F(MeshFileTest, CornersThatAreNoVerticesAreRefusedOrCounted) {
  const fs::path file = folder_.write("far.obj", kVertices + "f 1 2 99\nf 1 2 3\n");
  const std::string message = refusal([&] {
    if (!check_mesh(read_mesh(file)).closed()) throw InputError(file.string(), "not closed");
  });
  EXPECT_HAS(message, "far.obj: ");
}

struct Known {
  const char* file;
  int vertices, triangles, boundary_edges, non_manifold_edges, parts;
};
class RealMeshTest : public testing::TestWithParam<Known> {};

TEST_P(RealMeshTest, IsWhatItsReadmeTells) {
  const fs::path file = data_root() / "meshes" / GetParam().file;
  if (!fs::exists(file)) GTEST_SKIP() << "recorded data are missing: " << file;
  const MeshCheck check = check_mesh(read_mesh(file));
  EXPECT_EQ(check.vertices, GetParam().vertices);
  EXPECT_EQ(check.triangles, GetParam().triangles);
  EXPECT_EQ(check.boundary_edges, GetParam().boundary_edges);
  EXPECT_EQ(check.non_manifold_edges, GetParam().non_manifold_edges);
  EXPECT_EQ(check.parts, GetParam().parts);
}

// Coarse voxels, for time: interior and shell make the volume of the mesh, but for parts that overlap, which
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
}  // namespace remote_touch::mesh_file_test
