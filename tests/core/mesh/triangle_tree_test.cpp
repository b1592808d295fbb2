#include "core/mesh/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/core/mesh/mesh_shapes.h"

namespace remote_touch::face_tree_test {
namespace {

using namespace mesh_shapes;

std::vector<int> visited(const FaceTree& tree, const Vec3& p, double limit_m) {
  std::vector<int> faces;
  tree.visit(p, limit_m, [&](int face) { faces.push_back(face); });
  std::sort(faces.begin(), faces.end());
  return faces;
}

double to_face(const TriangleMesh& mesh, int face, const Vec3& p) {
  const auto& [a, b, c] = mesh.triangles[face];
  return meshes::to_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
}

// Every nearest face is visited, exactly once, also if its distance is the limit. Of several nearest faces,
// the reference has other roundings than the tree.
void expect_the_nearest(const TriangleMesh& mesh, const std::string& what) {
  SCOPED_TRACE(what);
  const FaceTree tree(mesh);
  const BoundingBox box = bounding_box(mesh.vertices);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-0.7, 0.7);
  for (int n = 0; n < 200; ++n) {
    const Vec3 p = box.center() + box.sizes().cwiseProduct(Vec3(any(random), any(random), any(random)));
    const double nearest_m = meshes::distance(mesh, p),
                 rounding_m = 1e-14 * (box.diagonal().norm() + nearest_m);
    for (const double limit_m : {nearest_m, 2 * nearest_m, std::numeric_limits<double>::infinity()}) {
      const std::vector<int> faces = visited(tree, p, limit_m);
      ASSERT_EQ(std::adjacent_find(faces.begin(), faces.end()), faces.end()) << p.transpose();
      for (int f = 0; f < static_cast<int>(mesh.triangles.size()); ++f) {
        const bool is_nearest = to_face(mesh, f, p) <= nearest_m + rounding_m;
        ASSERT_TRUE(!is_nearest || std::binary_search(faces.begin(), faces.end(), f))
            << f << " of " << p.transpose();
      }
    }
  }
}

TEST(FaceTree, VisitsTheNearestFaces) {
  for (const int rings : {1, 2, 3, 7, 40})
    expect_the_nearest(rough_ball(rings, rings + 2, 0.4), std::to_string(rings) + " rings");
  expect_the_nearest(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, "one face");
  expect_the_nearest(prism(kL, 1), "an L");
}

// Single precision has steps of 0.06 mm at 1000 m, but the tree knows no position so far from its centre.
TEST(FaceTree, VisitsTheNearestFacesFarFromTheOrigin) {
  const Eigen::Matrix3d turned = meshes::rotated();
  expect_the_nearest(meshes::moved(rough_ball(20, 20, 0.4), 0.1 * turned, {1000, -900, 800}), "small");
  expect_the_nearest(meshes::moved(rough_ball(20, 20, 0.4), 1e4 * turned, {1000, -900, 800}), "large");
}

// The normals of such faces have errors of up to 1e-6.
TEST(FaceTree, VisitsTheNearestOfSlimFaces) {
  TriangleMesh flat = meshes::moved(rough_ball(20, 20, 0.4), Vec3(1, 1, 1e-9).asDiagonal(), {0, 0, 0});
  expect_the_nearest(meshes::moved(flat, meshes::rotated(), {0, 0, 0}), "flat");
  const Eigen::Matrix3d long_one = Vec3(1e-8, 1, 1e-8).asDiagonal();
  expect_the_nearest(meshes::moved(meshes::moved(rough_ball(20, 20, 0.4), long_one, {0, 0, 0}),
                                   meshes::rotated(), {0, 0, 0}),
                     "long");
}

// An upper bound that a tree without bounds could not keep.
TEST(FaceTree, VisitsFewFaces) {
  const TriangleMesh ball = rough_ball(80, 80, 0.02);
  const FaceTree tree(ball);
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  std::size_t faces = 0;
  for (int n = 0; n < 100; ++n) {
    const Vec3 p = Vec3(normal(random), normal(random), normal(random)).normalized();
    faces += visited(tree, p, std::numeric_limits<double>::infinity()).size();
  }
  EXPECT_LT(faces, 300u);
}

// There are more nearest faces than the tree remembers.
TEST(FaceTree, VisitsAllOfManyNearestFaces) {
  Base circle;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 1000;
    circle.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  const TriangleMesh cone = pyramid(circle, {0, 0, 1});
  const std::vector<int> faces = visited(FaceTree(cone), {0, 0, 1.5}, 1);
  const int last = static_cast<int>(cone.triangles.size());
  for (int f = last - 1000; f < last; ++f)
    ASSERT_TRUE(std::binary_search(faces.begin(), faces.end(), f)) << f;
}

TEST(FaceTree, VisitsNoFaceBeyondTheLimit) {
  const FaceTree tree(prism(kL, 1));
  EXPECT_TRUE(visited(tree, {-1, 0.5, 0.5}, 0.999).empty());
  EXPECT_FALSE(visited(tree, {-1, 0.5, 0.5}, 1).empty());
}

TEST(FaceTree, VisitsNoFaceFromPositionsThatAreNotFiniteOrTooFar) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const FaceTree tree(prism(kL, 1));
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity, 1e16, 1e300})
    EXPECT_TRUE(visited(tree, {0, x, 0}, kInfinity).empty()) << x;
}

}  // namespace
}  // namespace remote_touch::face_tree_test
