#include "core/dissertation/tool/shape/distance_field.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "core/dissertation/tool/shape/voxelisation.h"
#include "tests/support/meshes.h"

namespace remote_touch::distance_field_test {
namespace {

struct Field {
  explicit Field(const TriangleMesh& mesh, double voxel_m = 5e-4)
      : grid(grid_around(mesh, voxel_m)),
        values(distance_field(TriangleTree(mesh), grid, inside_nodes(mesh, grid).inside)) {}
  Vec3 place(std::size_t n) const {
    const std::size_t columns = grid.cells[0] + 1, rows = grid.cells[1] + 1;
    return grid.origin_T + grid.size_m * Vec3(n % columns, n / columns % rows, n / columns / rows);
  }
  VoxelGrid grid;
  std::vector<float> values;
};

// The error is at most the rounding of a float near the surface and a voxel elsewhere. The distance is never
// too small.
void expect_distances(const TriangleMesh& mesh, std::size_t step, double voxel_m = 5e-4) {
  SCOPED_TRACE("a mesh of " + std::to_string(mesh.triangles.size()) + " triangles");
  const Field field(mesh, voxel_m);
  ASSERT_EQ(field.values.size(), field.grid.node_count());
  int near = 0, far = 0, inside = 0;
  for (std::size_t n = 0; n < field.values.size(); n += step) {
    const Vec3 p = field.place(n);
    const double expected = meshes::distance(mesh, p), got = std::abs(field.values[n]);
    if (expected <= kExactField_m) {
      ASSERT_NEAR(got, expected, 1e-9) << p.transpose();
      ++near;
    } else {
      ASSERT_GE(got, expected - 1e-8) << p.transpose();
      ASSERT_LE(got, expected + field.grid.size_m) << p.transpose();
      ++far;
    }
    if (expected < 1e-8 || n / step % 3 != 0) continue;
    ASSERT_EQ(field.values[n]<0, meshes::winding(mesh, p)> 0.5) << p.transpose();
    inside += field.values[n] < 0;
  }
  EXPECT_GT(near, 30);
  EXPECT_GT(far, 50);
  EXPECT_GT(inside, 5);
}

// The steps have no common factor with the rows, so the nodes are spread all over the grid.
TEST(DistanceField, AgreesWithAllTriangles) {
  expect_distances(meshes::any_body("ball"), 809);
  expect_distances(meshes::any_body("husky"), 1009, 1e-3);
  expect_distances(find_generated_tool("key")->make(), 1511, 1e-3);
  expect_distances(meshes::moved(box_mesh({0.06, 0.02, 0.004}), meshes::rotated(), {0, 0, 0}), 97);
  expect_distances(meshes::any_body("fork"), 307, 2e-3);
}

// The search may begin with any face. The positions are near, on the other side and far away.
TEST(TriangleTree, FindsTheNearestFaceAndAllWithinADistance) {
  const TriangleMesh body = meshes::any_body("key");
  const TriangleTree tree(body);
  std::vector<TriangleTree::Candidate> faces;
  for (int n = 0; n < 300; ++n) {
    const double reach = n % 3 == 0 ? 0.3 : 0.08;
    const Vec3 p = reach * Vec3(n * 37 % 101 - 50, n * 53 % 103 - 51, n * 71 % 107 - 53) / 50;
    const double expected = meshes::distance(body, p);
    const TriangleTree::Nearest found = tree.nearest(p, n * 61 % static_cast<int>(body.triangles.size()));
    EXPECT_NEAR(std::sqrt(found.squared_m2), expected, 1e-12) << p.transpose();
    EXPECT_EQ(tree.squared_to(found.face, p), found.squared_m2);
    tree.faces_within(p, 1.1 * expected, faces);
    std::size_t count = 0;
    for (const auto& [a, b, c] : body.triangles)
      count += meshes::to_triangle(p, body.vertices[a], body.vertices[b], body.vertices[c]) <= 1.1 * expected;
    EXPECT_EQ(faces.size(), count);
    EXPECT_EQ(faces.front().distance_m, std::sqrt(found.squared_m2));
  }
}

// Three corners on a line: rounding alone would decide whether a position is above their triangle.
TEST(TriangleTree, ATriangleWithoutAreaIsAsFarAsItsEdges) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> within(-0.01, 0.01);
  const auto draw = [&] { return Vec3(within(random), within(random), within(random)); };
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a = draw(), along = draw(), p = draw();
    const Vec3 b = a + 100 * within(random) * along, c = a + 100 * within(random) * along;
    const TriangleTree tree(TriangleMesh{{a, b, c}, {{0, 1, 2}}});
    const double expected =
        std::min({meshes::to_segment(p, a, b), meshes::to_segment(p, b, c), meshes::to_segment(p, c, a)});
    ASSERT_NEAR(std::sqrt(tree.squared_to(0, p)), expected, 1e-8) << i;
  }
}

TEST(TriangleTree, WindingNumberEqualsTheSumOfSolidAngles) {
  const TriangleMesh body = meshes::any_body("ball");
  const TriangleTree tree(body);
  for (int n = 0; n < 200; ++n) {
    const Vec3 p =
        Vec3(0.01, -0.02, 0.03) + 4e-4 * Vec3(n * 37 % 101 - 50, n * 53 % 103 - 51, n * 71 % 107 - 53);
    EXPECT_NEAR(tree.winding_number(p), meshes::winding(body, p), 0.02) << p.transpose();
  }
}

// The distance to a box has a closed form inside and outside, also for edges and corners.
TEST(DistanceField, AgreesWithTheClosedFormOfABox) {
  const Vec3 half(0.02, 0.01, 0.005);
  const Field field(box_mesh(2 * half));
  for (std::size_t n = 0; n < field.values.size(); ++n) {
    const Vec3 q = field.place(n).cwiseAbs() - half;
    const double expected = q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
    const double larger_by = (expected < 0 ? -1 : 1) * (field.values[n] - expected);
    ASSERT_GE(larger_by, -1e-8) << field.place(n).transpose();
    ASSERT_LE(larger_by, std::abs(expected) <= kExactField_m ? 1e-8 : 1e-4) << field.place(n).transpose();
  }
}

TEST(DistanceField, NeedlesAndTrianglesWithoutAreaDoNoHarm) {
  TriangleMesh body = box_mesh({0.02, 0.02, 0.02});
  const Field before(body);
  // Adds a corner on one edge and two triangles without area. The mesh stays closed.
  body.vertices.push_back(0.3 * body.vertices[0] + 0.7 * body.vertices[1]);
  body.triangles.push_back({0, 1, 8}), body.triangles.push_back({0, 8, 1});
  const Field after(body);
  for (std::size_t n = 0; n < before.values.size(); ++n)
    ASSERT_NEAR(after.values[n], before.values[n], std::abs(before.values[n]) < kExactField_m ? 1e-9 : 1e-4);
}

TEST(DistanceField, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh body = meshes::any_body("ball");
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Field one(body, 1e-3);
  omp_set_num_threads(3);
  EXPECT_EQ(Field(body, 1e-3).values, one.values);
  omp_set_num_threads(threads);
}

}  // namespace
}  // namespace remote_touch::distance_field_test
