#include "core/mesh/voxel_tool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/mesh/distance_field.h"
#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "tests/support/box_tool.h"
#include "tests/support/meshes.h"
#include "tests/support/test_files.h"

namespace remote_touch::voxel_tool_test {
namespace {

VoxelTool make(const TriangleMesh& mesh, const VoxelToolSettings& settings = {}) {
  ToolReport report;
  return make_voxel_tool(mesh, settings, report);
}

ToolReport report_of(const TriangleMesh& mesh, const VoxelToolSettings& settings = {}) {
  ToolReport report;
  make_voxel_tool(mesh, settings, report);
  return report;
}

TriangleMesh without_last(TriangleMesh mesh) {
  mesh.triangles.pop_back();
  return mesh;
}

TEST(VoxelTool, HasItsCentreOfMassInTheOrigin) {
  const VoxelTool tool = make(box_mesh({0.03, 0.02, 0.01}, {1, 2, 3}));
  EXPECT_NEAR(tool.volume_m3, 6e-6, 1e-15);
  for (const Vec3& v : tool.mesh.vertices)
    EXPECT_LT((v.cwiseAbs() - Vec3(0.015, 0.01, 0.005)).norm(), 1e-12) << v.transpose();
  EXPECT_NEAR(tool.reach_m, Vec3(0.015, 0.01, 0.005).norm(), 1e-12);
  EXPECT_NEAR(tool.inertia_m2(0, 0), (4e-4 + 1e-4) / 12, 1e-12);
  EXPECT_EQ(tool.voxels.size(), tool.grid.cell_count());
  EXPECT_EQ(tool.distance_m.size(), tool.grid.node_count());
}

TEST(VoxelTool, IsScaledByItsLongestSide) {
  ToolReport report;
  const VoxelTool tool = make_voxel_tool(box_mesh({3, 2, 1}), {.size_m = 0.06}, report);
  EXPECT_LT((report.sides_m - Vec3(0.06, 0.04, 0.02)).norm(), 1e-12);
  EXPECT_NEAR(tool.volume_m3, 48e-6, 1e-14);
  EXPECT_HAS(text(report), "60.0 x 40.0 x 20.0 mm, closed (1 part, 12 triangles)");
  EXPECT_EQ(text(report).find("outwards"), std::string::npos) << "its faces were so";
}

TEST(VoxelTool, TurnsFacesOutwards) {
  const TriangleMesh box = box_mesh({0.03, 0.02, 0.01});
  const VoxelTool right = make(box), rotated = make(meshes::inside_out(box));
  EXPECT_EQ(right.distance_m, rotated.distance_m);
  EXPECT_EQ(right.voxels, rotated.voxels);
  EXPECT_TRUE(report_of(meshes::inside_out(box)).inverted);
  EXPECT_FALSE(report_of(box).inverted);
}

TEST(VoxelTool, FieldWithinTheGridIsTheDistance) {
  const VoxelTool tool = make(meshes::any_body("ball"));
  for (const double radius : {0.004, 0.0093, 0.01, 0.0107, 0.013})
    for (const Vec3& displacement :
         {Vec3(1, 0, 0), Vec3(-0.6, 0.8, 0), Vec3(0.48, -0.64, 0.6), Vec3(0, 0, -1)}) {
      const FieldSample sample = sample_field(tool, radius * displacement);
      EXPECT_NEAR(sample.distance_m, radius - 0.01, 1e-4);
      EXPECT_GT(sample.gradient_T.dot(displacement), 0.97);
      // Exact within kExactField_m of the surface only.
      EXPECT_NEAR(sample.gradient_T.norm(), 1, radius > 0.01 - kExactField_m ? 0.03 : 0.06);
    }
}

// The gradient is that of the interpolated field. It is compared with finite differences, in cells and
// outside the grid.
TEST(VoxelTool, TheGradientIsThatOfTheField) {
  const VoxelTool tool = make(box_mesh({0.012, 0.01, 0.008}), {.voxel_m = 1e-3});
  for (int n = 0; n < 200; ++n) {
    const Vec3 p = tool.grid.origin_T + 1e-3 * Vec3(1.3 + n % 19 + 0.013 * n, 1.21 + n % 17, 1.4 + n % 13);
    const FieldSample sample = sample_field(tool, p);
    for (int i = 0; i < 3; ++i) {
      const Vec3 step = 1e-7 * Vec3::Unit(i);
      const double slope =
          (sample_field(tool, p + step).distance_m - sample_field(tool, p - step).distance_m) / 2e-7;
      EXPECT_NEAR(sample.gradient_T[i], slope, 1e-6) << p.transpose();
    }
  }
}

TEST(VoxelTool, FieldAtNodesIsWhatIsStored) {
  const VoxelTool tool = make(box_mesh({0.01, 0.01, 0.01}), {.voxel_m = 1e-3});
  const int columns = tool.grid.cells[0] + 1, rows = tool.grid.cells[1] + 1;
  for (std::size_t n = 0; n < tool.distance_m.size(); ++n) {
    const Vec3 at(n % columns, n / columns % rows, n / columns / rows);
    EXPECT_NEAR(sample_field(tool, tool.grid.origin_T + 1e-3 * at).distance_m, tool.distance_m[n], 1e-9);
  }
}

TEST(VoxelTool, FieldOutsideTheGridGrowsWithTheDistance) {
  const VoxelTool tool = make(box_mesh({0.02, 0.02, 0.02}));
  for (const Vec3& displacement : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0.6, 0.8), Vec3(0.48, -0.64, 0.6)})
    for (const double far : {0.03, 0.1, 2.0}) {
      const Vec3 p = far * displacement, q = p.cwiseAbs() - Vec3::Constant(0.01);
      const double expected = q.cwiseMax(0.0).norm();
      const FieldSample sample = sample_field(tool, p);
      EXPECT_GE(sample.distance_m, expected - 5e-4);
      EXPECT_LE(sample.distance_m, expected + 0.012);  // the distance to the grid's box is added
      EXPECT_GT(sample.gradient_T.dot(displacement), 0.8);
      EXPECT_NEAR(sample.gradient_T.norm(), 1, 1e-9);
    }
}

TEST(VoxelTool, RefusesAMeshThatIsNotClosed) {
  const TriangleMesh box = box_mesh({0.03, 0.02, 0.01});
  ToolReport report;
  EXPECT_EQ(
      refusal([&] { make_voxel_tool(without_last(box), {}, report, "renderer.tool_mesh = x.obj"); }),
      "renderer.tool_mesh = x.obj: not closed: 3 boundary edges (1 part, 11 triangles): expected a closed "
      "mesh, or renderer.tool_repair=true");
  EXPECT_HAS(refusal([&] {
               make(meshes::together(box, meshes::inside_out(box_mesh({0.01, 0.01, 0.01}, {1e-2, 9e-3, 0}))));
             }),
             "a part of the mesh is inside out");
}

TEST(VoxelTool, RefusesAMeshThatIsNoBody) {
  TriangleMesh box = box_mesh({0.03, 0.02, 0.01});
  EXPECT_HAS(refusal([] { make({}); }), "no triangles");
  EXPECT_HAS(refusal([&] { make(box, {.size_m = 500}); }),
             "million voxels of 0.000500 m: expected 150 million");
  EXPECT_HAS(refusal([&] { make(box, {.size_m = 1e300}); }), "million voxels");
  EXPECT_HAS(refusal([&] { make(box, {.voxel_m = 0.05}); }), "no voxel of 0.050000 m lies inside");
  TriangleMesh bad = box;
  bad.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_HAS(refusal([&] { make(bad, {.repair = true}); }), "1 vertex that is not finite");
  bad = box, bad.triangles[0][0] = 99;
  EXPECT_HAS(refusal([&] { make(bad, {.repair = true}); }), "1 triangle with a corner that is not a vertex");
  EXPECT_HAS(refusal([] { make(box_mesh({0.03, 0.02, 0})); }), "encloses no volume");
  EXPECT_HAS(refusal([] { make(box_mesh({0, 0, 0})); }), "its size is 0 or infinite");
}

TEST(VoxelTool, RepairGivesBackTheBox) {
  const TriangleMesh box = box_mesh({0.03, 0.02, 0.01});
  ToolReport report;
  const VoxelTool tool = make_voxel_tool(without_last(box), {.repair = true}, report);
  EXPECT_EQ(report.repaired.filled_holes, 1);
  EXPECT_FALSE(report.by_winding_number);
  EXPECT_EQ(tool.voxels, make(box).voxels);
  EXPECT_HAS(text(report), "repaired: filled 1 holes");
}

// A fin on an edge of a box cannot be closed; the box stays solid and the fin is shell only.
TEST(VoxelTool, AMeshThatCannotBeClosedIsSolidByWindingNumbers) {
  TriangleMesh fin = box_mesh({0.03, 0.02, 0.01});
  const Vec3 edge = fin.vertices[1] - fin.vertices[0];
  fin.vertices.push_back(fin.vertices[0] + edge / 2 + Vec3(0, -0.005, -0.005));
  fin.triangles.push_back({0, 1, 8}), fin.triangles.push_back({0, 1, 8});
  fin.triangles.push_back({2, 1, 8});
  ToolReport report;
  const VoxelTool tool = make_voxel_tool(fin, {.repair = true}, report);
  EXPECT_TRUE(report.by_winding_number) << text(report);
  EXPECT_NEAR(tool.volume_m3, 6e-6, 0.1 * 6e-6);
  EXPECT_LT(sample_field(tool, Vec3::Zero()).distance_m, -0.003);
  EXPECT_GT(report.thin_fraction, 0.01);
  EXPECT_HAS(text(report), "solid by winding numbers");
}

TEST(VoxelTool, ReportsHowMuchIsThin) {
  EXPECT_EQ(report_of(box_mesh({0.03, 0.02, 0.01})).thin_fraction, 0);
  const TriangleMesh sheet =
      meshes::together(box_mesh({0.03, 0.02, 0.01}), box_mesh({0.03, 0.02, 0.0004}, {0, 0, 0.03}));
  const ToolReport report = report_of(sheet);
  EXPECT_GT(report.thin_fraction, 0.2);
  EXPECT_HAS(text(report), "% of the surface is on parts thinner");
}

TEST(VoxelTool, VerticesThatNoTriangleUsesDoNotCount) {
  TriangleMesh box = box_mesh({0.03, 0.02, 0.01});
  const VoxelTool before = make(box);
  box.vertices.insert(box.vertices.begin(), Vec3(7, 7, 7));
  for (auto& triangle : box.triangles)
    for (int& corner : triangle) ++corner;
  EXPECT_EQ(make(box).distance_m, before.distance_m);
}

Eigen::Matrix3d diagonal(double x, double y, double z) {
  return Vec3(x, y, z).asDiagonal();
}

TEST(MassProperties, AreRightForABox) {
  const MassProperties mass = mass_properties(box_mesh({0.3, 0.2, 0.1}, {5, -4, 3}));
  EXPECT_NEAR(mass.volume_m3, 0.006, 1e-15);
  EXPECT_LT((mass.centre - Vec3(5, -4, 3)).norm(), 1e-13);
  EXPECT_LT((mass.inertia_m2 - diagonal(0.05, 0.1, 0.13) / 12).norm(), 1e-13);
}

// Corners at 0 and the unit vectors: volume 1/6, centre 1/4; inertia 3/40 on and 1/80 off the diagonal.
TEST(MassProperties, AreRightForATetrahedron) {
  const MassProperties mass =
      mass_properties(meshes::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  EXPECT_NEAR(mass.volume_m3, 1.0 / 6, 1e-15);
  EXPECT_LT((mass.centre - Vec3::Constant(0.25)).norm(), 1e-15);
  const Eigen::Matrix3d expected =
      diagonal(1, 1, 1) * (3.0 / 40 - 1.0 / 80) + Eigen::Matrix3d::Constant(1.0 / 80);
  EXPECT_LT((mass.inertia_m2 - expected).norm(), 1e-15) << mass.inertia_m2;
}

TEST(MassProperties, AreRightForABallWithinItsTriangles) {
  const MassProperties mass = mass_properties(find_generated_tool("ball")->make());
  EXPECT_NEAR(mass.volume_m3, 4.18879e-6, 0.01 * 4.2e-6);
  EXPECT_LT(mass.centre.norm(), 1e-5);
  EXPECT_LT((mass.inertia_m2 - 0.4 * 1e-4 * Eigen::Matrix3d::Identity()).norm(), 0.02 * 0.4e-4);
}

TEST(MassProperties, MoveAndTurnWithTheMesh) {
  const TriangleMesh key = find_generated_tool("key")->make();
  const MassProperties before = mass_properties(key);
  const Vec3 by(0.3, -0.2, 0.1);
  const MassProperties after = mass_properties(meshes::moved(key, meshes::rotated(), by));
  EXPECT_NEAR(after.volume_m3, before.volume_m3, 1e-12 * before.volume_m3);
  EXPECT_LT((after.centre - (meshes::rotated() * before.centre + by)).norm(), 1e-14);
  const Eigen::Matrix3d rotated = meshes::rotated() * before.inertia_m2 * meshes::rotated().transpose();
  EXPECT_LT((after.inertia_m2 - rotated).norm(), 1e-10 * rotated.norm());
}

TEST(MassProperties, InsideOutOnlyTheVolumeChangesItsSign) {
  const TriangleMesh key = find_generated_tool("key")->make();
  const MassProperties right = mass_properties(key), wrong = mass_properties(meshes::inside_out(key));
  EXPECT_NEAR(wrong.volume_m3, -right.volume_m3, 1e-12 * right.volume_m3);
  EXPECT_LT((wrong.centre - right.centre).norm(), 1e-12);
  EXPECT_LT((wrong.inertia_m2 - right.inertia_m2).norm(), 1e-12);
}

TEST(MassProperties, AreTheSameFromNodesAndFromTheMesh) {
  const TriangleMesh body = meshes::any_body("husky");
  const VoxelGrid grid = grid_around(body, 1e-3);
  const MassProperties fine = mass_properties(body),
                       coarse = mass_properties(grid, inside_nodes(body, grid).inside);
  EXPECT_NEAR(coarse.volume_m3, fine.volume_m3, 0.005 * fine.volume_m3);
  EXPECT_LT((coarse.centre - fine.centre).norm(), 5e-5);
  EXPECT_LT((coarse.inertia_m2 - fine.inertia_m2).norm(), 0.005 * fine.inertia_m2.norm());
}

// The pointshell of a box, for which the result is known.

// Number of cubes that hold voxels of the shell of a box around the origin: all cubes with voxels of the box,
// less those without an outermost voxel. The latter are all but the first and the last along each axis.
std::size_t shell_cubes(const Vec3& half_m, double voxel_m, double spacing_m) {
  double all = 1, inner = 1;
  for (const double half : half_m) {
    const double cubes = 2 * (std::floor((half - 0.5 * voxel_m) / spacing_m) + 1);
    all *= cubes, inner *= cubes - 2;
  }
  return static_cast<std::size_t>(all - inner);
}

TEST(Pointshell, LiesOnTheFacesOfABoxWithNormalsIntoIt) {
  const Vec3 half_m(0.02, 0.005, 0.01);
  constexpr double kVoxel_m = 5e-4;
  const auto tool = scenes::box_tool(half_m, kVoxel_m);
  for (const double spacing_m : {0.002, 0.003}) {
    const Pointshell shell = make_pointshell(*tool, spacing_m);
    EXPECT_EQ(shell.size(), shell_cubes(half_m, kVoxel_m, spacing_m)) << spacing_m;
    for (std::size_t i = 0; i < shell.size(); ++i) {
      EXPECT_NEAR(scenes::box_distance(half_m, shell.p_T[i]), 0, 3e-4);
      EXPECT_NEAR(shell.n_T[i].norm(), 1, 1e-12);
      EXPECT_LT(scenes::box_distance(half_m, shell.p_T[i] + 1e-3 * shell.n_T[i]), -3e-4);
    }
  }
}

// No position of the lower face is far from a point.
TEST(Pointshell, HasNoHoles) {
  const Vec3 half_m(0.02, 0.005, 0.01);
  constexpr double spacing_m = 0.003;
  const Pointshell shell = make_pointshell(*scenes::box_tool(half_m), spacing_m);
  for (double x = -0.02; x <= 0.02; x += 0.0007)
    for (double z = -0.01; z <= 0.01; z += 0.0007) {
      double nearest = 1;
      for (const Vec3& p : shell.p_T) nearest = std::min(nearest, (p - Vec3(x, -half_m.y(), z)).norm());
      EXPECT_LT(nearest, 1.5 * spacing_m);
    }
}

}  // namespace
}  // namespace remote_touch::voxel_tool_test

namespace remote_touch::generated_tools_test {
namespace {

Vec3 sides(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  return high - low;
}

TEST(GeneratedTools, AreClosedBodiesOfOnePart) {
  for (const GeneratedTool& tool : generated_tools()) {
    const MeshCheck check = check_mesh(tool.make());
    EXPECT_TRUE(check.closed()) << tool.name << ": " << text(check);
    EXPECT_GT(check.volume_m3, 0) << tool.name;
    EXPECT_EQ(check.parts, 1) << tool.name;
    EXPECT_EQ(check.degenerate_triangles, 0) << tool.name;
    EXPECT_EQ(find_generated_tool(tool.name), &tool);
  }
  EXPECT_EQ(find_generated_tool("wolf"), nullptr);
}

TEST(GeneratedTools, HaveTheSizesThatTheirSummariesState) {
  const std::map<std::string, Vec3> mm = {
      {"ball", {20, 20, 20}},    {"bar", {80, 20, 10}},     {"block", {95, 20, 68}},
      {"fork", {126, 22, 77}},   {"husky", {95, 20, 68}},   {"key", {151, 28, 90}},
      {"slab-5", {40, 5, 40}},   {"slab-10", {40, 10, 40}}, {"slab-20", {40, 20, 40}},
      {"slab-40", {40, 40, 40}},
  };
  EXPECT_EQ(mm.size(), generated_tools().size());
  for (const GeneratedTool& tool : generated_tools()) {
    const Vec3 got = 1e3 * sides(tool.make()), expected = mm.at(tool.name);
    const bool sharp = std::string(tool.name) == "bar" || std::string(tool.name).starts_with("slab");
    EXPECT_LT((got - expected).cwiseAbs().maxCoeff(), sharp ? 1e-12 : 0.3)
        << tool.name << ": " << got.transpose();
  }
}

TEST(GeneratedTools, AreTheSameEveryTime) {
  for (const GeneratedTool& tool : generated_tools()) {
    const TriangleMesh once = tool.make(), again = tool.make();
    EXPECT_EQ(once.triangles, again.triangles) << tool.name;
    EXPECT_EQ(once.vertices, again.vertices) << tool.name;
  }
}

TEST(GeneratedTools, TheBallIsRound) {
  const TriangleMesh ball = find_generated_tool("ball")->make();
  for (const Vec3& v : ball.vertices) EXPECT_NEAR(v.norm(), 0.01, 5e-5);
  for (const auto& [a, b, c] : ball.triangles) {
    const Vec3 middle = (ball.vertices[a] + ball.vertices[b] + ball.vertices[c]) / 3;
    EXPECT_NEAR(middle.norm(), 0.01, 1e-4);
  }
}

// Returns the angle at which the tool, free to move in x and z, is stopped by the box of Fig 6.3, 110 x 90
// mm: its extent first reaches that of the box.
double stops_at_deg(const TriangleMesh& mesh, double sense) {
  for (double deg = 0; deg < 90; deg += 0.01) {
    const double angle = sense * deg * 3.14159265358979323846 / 180;
    const double c = std::cos(angle), s = std::sin(angle);
    Eigen::Matrix3d about_y;
    about_y << c, 0, s, 0, 1, 0, -s, 0, c;
    const Vec3 extent = sides(meshes::moved(mesh, about_y, Vec3::Zero()));
    if (extent.x() >= 0.110 || extent.z() >= 0.090) return deg;
  }
  return 90;
}

TEST(GeneratedTools, TheHuskyIsStoppedByTheNarrowBox) {
  const TriangleMesh husky = find_generated_tool("husky")->make();
  const double plus = stops_at_deg(husky, 1), minus = stops_at_deg(husky, -1);
  EXPECT_GE(plus, 21.2);
  EXPECT_LE(plus, 21.5);
  EXPECT_GE(minus, 21.2);
  EXPECT_LE(minus, 21.5);
}

// The angle of the bar in a slot of 40 mm: 80 sin a + 10 cos a = 40.
TEST(GeneratedTools, TheBarFitsASlotUpTo22Degrees) {
  const double a = 22.62 * 3.14159265358979323846 / 180;
  Eigen::Matrix3d about_y;
  about_y << std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a);
  const TriangleMesh bar = meshes::moved(find_generated_tool("bar")->make(), about_y, Vec3::Zero());
  EXPECT_NEAR(sides(bar).z(), 0.040, 1e-6);
}

TEST(MarchingTetrahedra, RefusesABodyThatIsCutOff) {
  const auto ball = [](const Vec3& p) { return p.norm() - 1; };
  EXPECT_TRUE(check_mesh(marching_tetrahedra(ball, Vec3::Constant(-1.2), Vec3::Constant(1.2), 0.3)).closed());
  EXPECT_THROW(marching_tetrahedra(ball, Vec3(-1.2, -0.5, -1.2), Vec3::Constant(1.2), 0.3), InputError);
}

// The function vanishes exactly at nodes. The second case is two bodies that touch in one node.
TEST(MarchingTetrahedra, MeshIsClosedIfTheFunctionVanishesAtNodes) {
  const auto diamond = [](const Vec3& p) { return p.cwiseAbs().sum() - 2; };
  const auto two = [](const Vec3& p) {
    return std::min((p - Vec3(1, 0, 0)).norm(), (p + Vec3(1, 0, 0)).norm()) - 1;
  };
  for (const std::function<double(const Vec3&)>& body :
       {std::function<double(const Vec3&)>(diamond), {two}}) {
    const MeshCheck check = check_mesh(marching_tetrahedra(body, Vec3::Constant(-4), Vec3::Constant(4), 0.5));
    EXPECT_TRUE(check.closed()) << text(check);
    EXPECT_EQ(check.degenerate_triangles, 0);
  }
}

}  // namespace
}  // namespace remote_touch::generated_tools_test
