#include "core/mesh/voxel_tool.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "core/mesh/distance_field.h"
#include "tests/support/meshes.h"

namespace remote_touch::voxelisation_test {
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

// Compares the inside nodes with winding numbers from solid angles, except on the surface.
void expect_inside(const TriangleMesh& mesh, double voxel, int step) {
  const VoxelGrid grid = grid_around(mesh, voxel);
  const std::vector<std::uint8_t> inside = inside_nodes(mesh, grid).inside;
  int in = 0, out = 0;
  for_each_cell(grid, step, [&](int i, int j, int k) {
    const Vec3 p = node(grid, i, j, k);
    const double winding = meshes::winding(mesh, p);
    const bool expected = winding > 0.5;
    const bool got = inside[i + (grid.cells[0] + 1) * (j + (grid.cells[1] + std::size_t(1)) * k)];
    if (got != expected && meshes::distance(mesh, p) < 1e-8) return;  // either is right on the surface
    ASSERT_EQ(got, expected) << p.transpose();
    ++(expected ? in : out);
  });
  EXPECT_GT(in, 30);
  EXPECT_GT(out, 100);
}

TEST(Voxelisation, InsideHasANonzeroWindingNumber) {
  expect_inside(meshes::any_body("ball"), 1e-3, 4);
  expect_inside(meshes::any_body("husky"), 2e-3, 5);
  expect_inside(find_generated_tool("key")->make(), 2e-3, 5);
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

TEST(Voxelisation, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh body = meshes::any_body("husky");
  const VoxelGrid grid = grid_around(body, 1e-3);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto shell = crossed_cells(body, grid);
  const auto inside = inside_nodes(body, grid).inside;
  omp_set_num_threads(3);
  EXPECT_EQ(crossed_cells(body, grid), shell);
  EXPECT_EQ(inside_nodes(body, grid).inside, inside);
  omp_set_num_threads(threads);
}

}  // namespace
}  // namespace remote_touch::voxelisation_test
