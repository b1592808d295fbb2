// Voxels of a mesh, and the tool that is made of it: closed forms of boxes and balls, and solid angles.
#include "core/mesh/voxel_tool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/mesh/distance_field.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"
#include "tests/support/box_tool.h"
#include "tests/support/meshes.h"
#include "tests/support/test_files.h"

namespace remote_touch::voxel_tool_test {
namespace {

Vec3 node(const VoxelGrid& grid, int i, int j, int k) {
  return grid.origin_T + grid.size_m * Vec3(i, j, k);
}

std::size_t cell(const VoxelGrid& grid, int i, int j, int k) {
  return i + grid.cells[0] * (j + std::size_t(grid.cells[1]) * k);
}

template <class Visit>
void for_each_cell(const VoxelGrid& grid, int step, const Visit& visit) {
  for (int k = 0; k < grid.cells[2]; k += step)
    for (int j = 0; j < grid.cells[1]; j += step)
      for (int i = 0; i < grid.cells[0]; i += step) visit(i, j, k);
}

TEST(Voxelisation, TheGridEnclosesTheMeshAndTheMargin) {
  for (const double voxel : {5e-4, 7e-4, 3e-3, 2e-2}) {
    const TriangleMesh body = meshes::any_body();
    const VoxelGrid grid = grid_around(body, voxel);
    const Vec3 end = node(grid, grid.cells[0], grid.cells[1], grid.cells[2]);
    for (const Vec3& v : body.vertices)
      for (int i = 0; i < 3; ++i) {
        EXPECT_GE(v[i] - grid.origin_T[i], kFieldMargin_m - 1e-12);
        EXPECT_GE(end[i] - v[i], kFieldMargin_m - 1e-12);
      }
    EXPECT_EQ(cells_around(body, voxel), static_cast<double>(grid.cell_count()));
  }
}

// Slanted triangles of every size. The reference cuts each triangle at the six sides of the cell.
TEST(Voxelisation, CrossedCellsAreWhereTheTrianglesAre) {
  const double voxel = 4e-3;
  TriangleMesh soup = meshes::together(
      meshes::any_body("ball"), meshes::moved(box_mesh({0.03, 0.02, 0.01}), meshes::rotated(), {0, 0, 0}));
  soup = meshes::together(soup, {{{0, 0, 0}, {0.02, 0.001, 0.03}, {0.0201, 0.0012, 0.0301}}, {{0, 1, 2}}});
  const VoxelGrid grid = grid_around(soup, voxel);
  const std::vector<std::uint8_t> cells = crossed_cells(soup, grid);
  int count = 0;
  for_each_cell(grid, 1, [&](int i, int j, int k) {
    const Vec3 low = node(grid, i, j, k), high = node(grid, i + 1, j + 1, k + 1);
    bool crossed = false;
    for (const auto& [a, b, c] : soup.triangles)
      crossed =
          crossed || !meshes::clipped_away({soup.vertices[a], soup.vertices[b], soup.vertices[c]}, low, high);
    ASSERT_EQ(cells[cell(grid, i, j, k)] != 0, crossed) << i << " " << j << " " << k;
    count += crossed;
  });
  EXPECT_GT(count, 300);
}

std::vector<Voxel> voxels_in(const TriangleMesh& mesh, const VoxelGrid& grid) {
  return voxels_of(grid, distance_field(TriangleTree(mesh), grid, inside_nodes(mesh, grid).inside));
}

// A box is as thick as the nearest number of whole voxels: one layer of shell at each face and the interior
// between them.
TEST(Voxelisation, ABoxIsItsThicknessInVoxels) {
  for (const double side : {0.01, 0.0105, 0.01025, 0.0101}) {
    const TriangleMesh box = box_mesh({side, 2 * side, side});
    const VoxelGrid grid = grid_around(box, 5e-4);
    const std::vector<Voxel> voxels = voxels_in(box, grid);
    int shell = 0, interior = 0;
    for (int i = 0; i < grid.cells[0]; ++i) {
      const Voxel voxel = voxels[cell(grid, i, grid.cells[1] / 2, grid.cells[2] / 2)];
      shell += voxel == Voxel::shell, interior += voxel == Voxel::interior;
    }
    EXPECT_EQ(shell, 2) << side;
    EXPECT_NEAR(shell + interior, side / 5e-4, 0.51) << side;
  }
}

// The nodes are in line with edges, corners and the diagonals of faces, all at once.
TEST(Voxelisation, FindsTheInsideAtNodesInLineWithEdges) {
  VoxelGrid grid{Vec3(-8, -8, -8), 1, {16, 16, 16}};
  for (const bool diamond : {false, true}) {
    TriangleMesh body = box_mesh({8, 8, 8});
    if (diamond)
      body = {{{5, 0, 0}, {-5, 0, 0}, {0, 5, 0}, {0, -5, 0}, {0, 0, 5}, {0, 0, -5}},
              {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    const InsideNodes nodes = inside_nodes(body, grid);
    EXPECT_FALSE(nodes.negative);
    for (int k = 0; k <= 16; ++k)
      for (int j = 0; j <= 16; ++j)
        for (int i = 0; i <= 16; ++i) {
          const Vec3 p = node(grid, i, j, k).cwiseAbs();
          const double level = diamond ? p.sum() - 5 : p.maxCoeff() - 4;
          if (level == 0) continue;
          ASSERT_EQ(nodes.inside[i + 17 * (j + 17 * k)], level < 0) << p.transpose();
        }
  }
}

TEST(Voxelisation, OverlapIsSolidAHollowIsFreeAndInsideOutIsSeen) {
  const VoxelGrid grid{Vec3(-8.5, -8.5, -8.5), 1, {17, 17, 17}};
  const auto at = [&](const TriangleMesh& mesh, const Vec3& p) {
    const Vec3 n = (p - grid.origin_T) / grid.size_m;
    return inside_nodes(mesh, grid)
        .inside[static_cast<int>(n.x()) + 18 * (static_cast<int>(n.y()) + 18 * int(n.z()))];
  };
  const TriangleMesh big = box_mesh({10, 10, 10}), small = box_mesh({4, 4, 4}),
                     beside = box_mesh({6, 6, 6}, {4, 0, 0});
  EXPECT_TRUE(at(meshes::together(big, beside), {3.5, 0.5, 0.5}));
  EXPECT_TRUE(at(meshes::together(big, beside), {6.5, 0.5, 0.5}));
  const TriangleMesh hollow = meshes::together(big, meshes::inside_out(small));
  EXPECT_FALSE(at(hollow, {0.5, 0.5, 0.5}));
  EXPECT_TRUE(at(hollow, {3.5, 0.5, 0.5}));
  EXPECT_FALSE(inside_nodes(hollow, grid).negative);
  const TriangleMesh wrong = meshes::together(big, meshes::inside_out(beside));
  EXPECT_TRUE(inside_nodes(wrong, grid).negative);
  EXPECT_FALSE(at(wrong, {6.5, 0.5, 0.5}));
}

// A cell is solid if its centre is inside. The shell consists of the solid cells with a free cell among their
// 26 neighbours.
TEST(Voxelisation, ShellSeparatesInteriorFromFree) {
  const TriangleMesh ball = meshes::any_body("ball");
  const VoxelGrid grid = grid_around(ball, 1e-3);
  const std::vector<Voxel> voxels = voxels_in(ball, grid);
  int interior = 0, shell = 0;
  for_each_cell(grid, 1, [&](int i, int j, int k) {
    const Voxel voxel = voxels[cell(grid, i, j, k)];
    const Vec3 centre = node(grid, i, j, k) + Vec3::Constant(5e-4);
    const double depth = (centre - Vec3(0.01, -0.02, 0.03)).norm() - 0.01;
    if (std::abs(depth) > 3e-5) {
      EXPECT_EQ(voxel != Voxel::free, depth < 0) << depth;
    }
    if (voxel == Voxel::free) return;
    bool beside_free = false;
    for (int n = 0; n < 27; ++n)
      beside_free =
          beside_free || voxels[cell(grid, i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1)] == Voxel::free;
    EXPECT_EQ(voxel == Voxel::shell, beside_free);
    ++(voxel == Voxel::interior ? interior : shell);
  });
  EXPECT_GT(interior, 2000);
  EXPECT_GT(shell, 500);
}

// A box without bottom and lid, 30 nodes wide, is solid except for a hollow at each opening.
TEST(Voxelisation, WindingNumbersFillAnOpenMesh) {
  TriangleMesh tube = meshes::moved(box_mesh({0.03, 0.03, 0.03}), meshes::rotated(), {1e-4, 2e-4, 3e-4});
  const TriangleMesh whole = tube;
  tube.triangles.erase(tube.triangles.begin(), tube.triangles.begin() + 4);
  const VoxelGrid grid{Vec3::Constant(-0.03), 1e-3, {60, 60, 60}};
  const auto closed = inside_nodes(whole, grid).inside;
  const auto same = inside_nodes_of_open(TriangleTree(whole), grid, crossed_cells(whole, grid));
  const auto filled = inside_nodes_of_open(TriangleTree(tube), grid, crossed_cells(tube, grid));
  int count = 0, all = 0, asked = 0;
  for (std::size_t n = 0; n < filled.size(); ++n) {
    const Vec3 p =
        node(grid, static_cast<int>(n % 61), static_cast<int>(n / 61 % 61), static_cast<int>(n / 61 / 61));
    if (meshes::distance(whole, p) > 1e-8) {
      ASSERT_EQ(same[n], closed[n]) << p.transpose();
    }
    count += filled[n], all += closed[n];
    const double winding = meshes::winding(tube, p);
    if (n % 3 != 0 || std::abs(winding - 0.5) < 0.02) continue;
    ASSERT_EQ(filled[n], winding > 0.5) << p.transpose() << ": " << winding;
    ++asked;
  }
  EXPECT_GT(asked, 50000);
  EXPECT_NEAR(all, 27000, 200);
  EXPECT_LT(count, 26000);
  EXPECT_GT(count, 18000);
}

// A node in the middle of the opening of a box sees half of all directions: it is outside.
TEST(Voxelisation, TheMiddleOfAnOpeningIsOutside) {
  const TriangleMesh whole = box_mesh({0.02, 0.02, 0.02});
  const VoxelGrid grid{Vec3::Constant(-0.02), 1e-3, {40, 40, 40}};
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.01, 0.01}) {
      TriangleMesh box = whole;
      std::erase_if(box.triangles, [&](const std::array<int, 3>& triangle) {
        return std::all_of(triangle.begin(), triangle.end(), [&](int corner) {
          return whole.vertices[static_cast<std::size_t>(corner)][axis] == side;
        });
      });
      ASSERT_EQ(box.triangles.size(), 10u);
      const auto inside = inside_nodes_of_open(TriangleTree(box), grid, crossed_cells(box, grid));
      const auto at = [&](double along) {
        int node[3] = {20, 20, 20};
        node[axis] += static_cast<int>(std::lround(along / grid.size_m));
        return inside[static_cast<std::size_t>((node[2] * 41 + node[1]) * 41 + node[0])];
      };
      EXPECT_EQ(at(side), 0) << axis << " " << side;
      EXPECT_EQ(at(0.9 * side), 1) << axis << " " << side;
    }
}

struct Made {
  ToolReport report;
  VoxelTool tool;
};

Made make(const TriangleMesh& mesh, const VoxelToolSettings& settings = {}) {
  Made made;
  made.tool = make_voxel_tool(mesh, settings, made.report);
  return made;
}

const TriangleMesh kBox = box_mesh({0.03, 0.02, 0.01});

TriangleMesh without_last(TriangleMesh mesh) {
  mesh.triangles.pop_back();
  return mesh;
}

TEST(VoxelTool, IsScaledByItsLongestSideAndHasItsCentreOfMassInTheOrigin) {
  const auto [report, tool] = make(box_mesh({3, 2, 1}, {1, 2, 3}), {.size_m = 0.06});
  const Vec3 half_m(0.03, 0.02, 0.01);
  EXPECT_LT((report.sides_m - 2 * half_m).norm(), 1e-12);
  EXPECT_HAS(text(report), "60.0 x 40.0 x 20.0 mm, closed (1 part, 12 triangles)");
  EXPECT_EQ(text(report).find("outwards"), std::string::npos) << "its faces were so";
  EXPECT_NEAR(tool.volume_m3, 48e-6, 1e-14);
  for (const Vec3& v : tool.mesh.vertices) EXPECT_LT((v.cwiseAbs() - half_m).norm(), 1e-12) << v.transpose();
  EXPECT_NEAR(tool.reach_m, half_m.norm(), 1e-12);
  EXPECT_NEAR(tool.inertia_m2(0, 0), (16e-4 + 4e-4) / 12, 1e-12);
  EXPECT_EQ(tool.voxels.size(), tool.grid.cell_count());
  EXPECT_EQ(tool.distance_m.size(), tool.grid.node_count());
}

TEST(VoxelTool, TurnsFacesOutwardsAndIgnoresVerticesThatNoTriangleUses) {
  const Made right = make(kBox), turned = make(meshes::inside_out(kBox));
  EXPECT_FALSE(right.report.inverted);
  EXPECT_TRUE(turned.report.inverted);
  EXPECT_EQ(right.tool.distance_m, turned.tool.distance_m);
  EXPECT_EQ(right.tool.voxels, turned.tool.voxels);
  TriangleMesh unused = kBox;
  unused.vertices.insert(unused.vertices.begin(), Vec3(7, 7, 7));
  for (auto& triangle : unused.triangles)
    for (int& corner : triangle) ++corner;
  EXPECT_EQ(make(unused).tool.distance_m, right.tool.distance_m);
}

// The gradient is that of the interpolated field. It is compared with finite differences, in cells and
// outside the grid.
TEST(VoxelTool, TheGradientIsThatOfTheField) {
  const VoxelTool tool = make(box_mesh({0.012, 0.01, 0.008}), {.voxel_m = 1e-3}).tool;
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

TEST(VoxelTool, FieldOutsideTheGridGrowsWithTheDistance) {
  const VoxelTool tool = make(box_mesh({0.02, 0.02, 0.02})).tool;
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

TEST(VoxelTool, RefusesAMeshThatIsNoClosedBody) {
  TriangleMesh not_finite = kBox, no_vertex = kBox;
  not_finite.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  no_vertex.triangles[0][0] = 99;
  const TriangleMesh inside_out =
      meshes::together(kBox, meshes::inside_out(box_mesh({0.01, 0.01, 0.01}, {1e-2, 9e-3, 0})));
  const struct {
    TriangleMesh mesh;
    VoxelToolSettings settings;
    const char* expected;
  } rows[] = {{without_last(kBox),
               {},
               "x.obj: not closed: 3 boundary edges (1 part, 11 triangles): expected a closed mesh, or "
               "renderer.tool_repair=true"},
              {inside_out, {}, "a part of the mesh is inside out"},
              {TriangleMesh(), {}, "no triangles"},
              {kBox, {.size_m = 500}, "million voxels of 0.000500 m: expected 150 million"},
              {kBox, {.size_m = 1e300}, "million voxels"},
              {kBox, {.voxel_m = 0.05}, "no voxel of 0.050000 m lies inside"},
              {not_finite, {.repair = true}, "1 vertex that is not finite"},
              {no_vertex, {.repair = true}, "1 triangle with a corner that is not a vertex"},
              {box_mesh({0.03, 0.02, 0}), {}, "encloses no volume"},
              {box_mesh({0, 0, 0}), {}, "its size is 0 or infinite"}};
  ToolReport report;
  for (const auto& row : rows)
    EXPECT_HAS(refusal([&] { make_voxel_tool(row.mesh, row.settings, report, "x.obj"); }), row.expected);
}

TEST(VoxelTool, RepairGivesBackTheBox) {
  const auto [report, tool] = make(without_last(kBox), {.repair = true});
  EXPECT_EQ(tool.voxels, make(kBox).tool.voxels);
  EXPECT_EQ(report.repaired.filled_holes, 1);
  EXPECT_FALSE(report.by_winding_number);
  EXPECT_HAS(text(report), "repaired: filled 1 holes");
}

// A fin on an edge of a box cannot be closed; the box stays solid and the fin is shell only.
TEST(VoxelTool, AMeshThatCannotBeClosedIsSolidByWindingNumbers) {
  TriangleMesh fin = kBox;
  const Vec3 edge = fin.vertices[1] - fin.vertices[0];
  fin.vertices.push_back(fin.vertices[0] + edge / 2 + Vec3(0, -0.005, -0.005));
  fin.triangles.push_back({0, 1, 8}), fin.triangles.push_back({0, 1, 8});
  fin.triangles.push_back({2, 1, 8});
  const auto [report, tool] = make(fin, {.repair = true});
  EXPECT_TRUE(report.by_winding_number) << text(report);
  EXPECT_NEAR(tool.volume_m3, 6e-6, 0.1 * 6e-6);
  EXPECT_LT(sample_field(tool, Vec3::Zero()).distance_m, -0.003);
  EXPECT_GT(report.thin_fraction, 0.01);
  EXPECT_HAS(text(report), "solid by winding numbers");
}

TEST(VoxelTool, ReportsHowMuchIsThin) {
  EXPECT_EQ(make(kBox).report.thin_fraction, 0);
  const ToolReport report = make(meshes::together(kBox, box_mesh({0.03, 0.02, 0.0004}, {0, 0, 0.03}))).report;
  EXPECT_GT(report.thin_fraction, 0.2);
  EXPECT_HAS(text(report), "% of the surface is on parts thinner");
}

// Corners at 0 and the unit vectors: volume 1/6, centre 1/4; inertia 3/40 on and 1/80 off the diagonal.
TEST(MassProperties, AreRightForATetrahedron) {
  const MassProperties mass =
      mass_properties(meshes::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  EXPECT_NEAR(mass.volume_m3, 1.0 / 6, 1e-15);
  EXPECT_LT((mass.centre - Vec3::Constant(0.25)).norm(), 1e-15);
  const Eigen::Matrix3d expected =
      Eigen::Matrix3d::Identity() * (3.0 / 40 - 1.0 / 80) + Eigen::Matrix3d::Constant(1.0 / 80);
  EXPECT_LT((mass.inertia_m2 - expected).norm(), 1e-15) << mass.inertia_m2;
}

// Inside out, only the volume changes its sign.
TEST(MassProperties, MoveAndTurnWithTheMesh) {
  const TriangleMesh key = find_generated_tool("key")->make();
  const MassProperties before = mass_properties(key);
  const Vec3 by(0.3, -0.2, 0.1), centre = meshes::rotated() * before.centre + by;
  const Eigen::Matrix3d rotated = meshes::rotated() * before.inertia_m2 * meshes::rotated().transpose();
  const TriangleMesh moved = meshes::moved(key, meshes::rotated(), by);
  for (const double sign : {1.0, -1.0}) {
    const MassProperties after = mass_properties(sign > 0 ? moved : meshes::inside_out(moved));
    EXPECT_NEAR(after.volume_m3, sign * before.volume_m3, 1e-12 * before.volume_m3);
    EXPECT_LT((after.centre - centre).norm(), 1e-12);
    EXPECT_LT((after.inertia_m2 - rotated).norm(), 1e-10 * rotated.norm());
  }
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

}  // namespace
}  // namespace remote_touch::voxel_tool_test
