#include "core/mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/mesh_distance.h"
#include "core/mesh/triangle_tree.h"
#include "tests/core/mesh/mesh_shapes.h"
#include "tests/support/meshes.h"
#include "tests/support/test_files.h"

namespace remote_touch::triangle_mesh_test {
namespace {

using Polygon = std::vector<Vec3>;

Vec3 area_of(const Polygon& p, const std::array<int, 3>& t) {
  return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]) / 2;
}

Vec3 area_of(const Polygon& p) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) sum += p[i].cross(p[(i + 1) % p.size()]) / 2;
  return sum;
}

// All triangles have the orientation of the polygon, and their areas add up to its area.
void expect_covered(const Polygon& polygon) {
  const auto triangles = polygon_triangles(polygon);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), polygon.size() - 2);
  const Vec3 whole = area_of(polygon);
  double sum = 0;
  for (const auto& triangle : *triangles) {
    EXPECT_GT(area_of(polygon, triangle).dot(whole), 0);
    sum += area_of(polygon, triangle).norm();
  }
  EXPECT_NEAR(sum, whole.norm(), 1e-9 * whole.norm());
}

// Checks the polygon with each corner as the first, in both directions, in several planes.
void expect_covered_from_everywhere(Polygon polygon) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    expect_covered(polygon);
    expect_covered({polygon.rbegin(), polygon.rend()});
    Polygon turned;
    for (const Vec3& p : polygon) turned.push_back(meshes::rotated() * p + Vec3(1, 2, 3));
    expect_covered(turned);
  }
}

// A regular polygon, or a star if the step is above one.
Polygon around(int corners, int step) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i * step / corners;
    polygon.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  return polygon;
}

TEST(PolygonTriangles, AreAFanForAConvexPolygon) {
  const auto triangles = polygon_triangles(around(6, 1));
  ASSERT_TRUE(triangles);
  EXPECT_EQ(*triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
}

TEST(PolygonTriangles, LeaveTheNotchesOfConcavePolygonsEmpty) {
  expect_covered_from_everywhere(
      {{4, 4, 0}, {4, 1, 0}, {2, 1, 0}, {2, 4, 0}, {0, 4, 0}, {0, 0, 0}, {6, 0, 0}, {6, 4, 0}});
  expect_covered_from_everywhere({{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}});  // an arrow
}

TEST(PolygonTriangles, CoverAStarAndAComb) {
  Polygon star = around(14, 1), comb{{0, 0, 0}, {21, 0, 0}};
  for (std::size_t i = 0; i < star.size(); i += 2) star[i] *= 0.2;
  expect_covered_from_everywhere(star);
  for (int x = 20; x >= 0; --x) comb.emplace_back(x, x % 2 == 0 ? 5 : 1, 0);
  expect_covered_from_everywhere(comb);
}

TEST(PolygonTriangles, HaveAnAreaAlsoIfCornersLieOnStraightEdges) {
  expect_covered_from_everywhere(
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
}

// The triangles of a polygon that is not flat have its area as seen along its normal, and none is turned.
bool is_covered_along_normal(const Polygon& polygon) {
  const auto triangles = polygon_triangles(polygon);
  if (!triangles) return false;
  const Vec3 whole = area_of(polygon), normal = whole.normalized();
  double sum = 0;
  for (const auto& triangle : *triangles) {
    EXPECT_GT(area_of(polygon, triangle).dot(normal), 0);
    sum += area_of(polygon, triangle).dot(normal);
  }
  EXPECT_EQ(triangles->size(), polygon.size() - 2);
  EXPECT_NEAR(sum, whole.norm(), 1e-9 * whole.norm());
  return true;
}

// True if two edges that are no neighbours meet, seen along the normal. The polygon has no straight corner.
bool crosses_itself(const Polygon& polygon) {
  const Vec3 normal = area_of(polygon).normalized();
  const auto turn = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b - a).cross(c - a).dot(normal);
  };
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n == i) continue;
      const Vec3 &a = polygon[i], &b = polygon[i + 1], &c = polygon[j], &d = polygon[(j + 1) % n];
      if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) return true;
    }
  return false;
}

// Random polygons that are not quite flat, concave and crossing ones: the answer depends neither on the axes,
// nor on the corner that comes first, nor on the direction.
TEST(PolygonTriangles, DependOnTheShapeOfABentPolygonAlone) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  int covered = 0, refused = 0;
  for (int i = 0; i < 600; ++i) {
    Polygon polygon;
    for (int corner = 0; corner < 4 + i % 3; ++corner)
      polygon.emplace_back(any(random), any(random), 0.03 * any(random));
    if (area_of(polygon).norm() < 0.05) continue;  // the normal of such a polygon is that of its bends
    const bool expected = !crosses_itself(polygon);
    (expected ? covered : refused) += 1;
    const Vec3 axis = Vec3(any(random), any(random), any(random)).normalized();
    for (const Eigen::Matrix3d& turned : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), meshes::rotated(),
                                          Eigen::AngleAxisd(3 * any(random), axis).toRotationMatrix()})
      for (std::size_t first = 0; first < polygon.size(); ++first) {
        Polygon same;
        for (std::size_t j = 0; j < polygon.size(); ++j)
          same.push_back(turned * polygon[(first + j) % polygon.size()] + Vec3(1, 2, 3));
        ASSERT_EQ(is_covered_along_normal(same), expected) << i << " " << first;
        ASSERT_EQ(is_covered_along_normal({same.rbegin(), same.rend()}), expected) << i << " " << first;
      }
  }
  EXPECT_GT(covered, 150);
  EXPECT_GT(refused, 150);
}

// Seen along x, the axis nearest to its normal, the edges of this dart meet.
TEST(PolygonTriangles, FollowTheNormalOfABentDart) {
  const auto triangles = polygon_triangles(
      {{-0.011, 0.008, 0.004}, {-0.002, 0.092, -0.075}, {-0.010, 0.025, -0.012}, {-0.071, 0.052, 0.057}});
  ASSERT_TRUE(triangles);
  for (const auto& triangle : *triangles)
    EXPECT_EQ(
        std::count(triangle.begin(), triangle.end(), 0) + std::count(triangle.begin(), triangle.end(), 2), 2);
}

TEST(PolygonTriangles, DoNotExistWhereEdgesCrossOrTouch) {
  EXPECT_FALSE(polygon_triangles({{0, 0, 0}, {2, 1, 0}, {2, 0, 0}, {0, 2, 0}}));  // figure 8, unequal loops
  EXPECT_FALSE(polygon_triangles({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}));  // equal loops: no area
  EXPECT_FALSE(polygon_triangles(around(5, 2)));
  Polygon twice = around(4, 1);
  twice.insert(twice.end(), twice.begin(), twice.begin() + 4);
  EXPECT_FALSE(polygon_triangles(twice));
  EXPECT_FALSE(
      polygon_triangles({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}));  // touches an edge
  EXPECT_FALSE(
      polygon_triangles({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {9, 2, 0}, {4, 2, 0}, {0, 4, 0}}));  // a spike
}

TEST(PolygonTriangles, AreAFanForAPolygonWithoutArea) {
  const auto triangles = polygon_triangles({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}});
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), 2u);
}

}  // namespace
}  // namespace remote_touch::triangle_mesh_test

namespace remote_touch::mesh_check_test {
namespace {

const TriangleMesh kBox = box_mesh({2, 3, 4}, {1, 1, 1});

TEST(MeshCheck, ABoxIsClosed) {
  const MeshCheck check = check_mesh(kBox);
  EXPECT_TRUE(check.closed());
  EXPECT_FALSE(check.inverted());
  EXPECT_EQ(check.parts, 1);
  EXPECT_NEAR(check.volume_m3, 24, 1e-12);
  EXPECT_EQ(text(check), "closed (1 part, 12 triangles)");
}

TEST(MeshCheck, AMissingTriangleLeavesThreeBoundaryEdges) {
  TriangleMesh open = kBox;
  open.triangles.pop_back();
  const MeshCheck check = check_mesh(open);
  EXPECT_FALSE(check.closed());
  EXPECT_EQ(check.boundary_edges, 3);
  EXPECT_EQ(text(check), "not closed: 3 boundary edges (1 part, 11 triangles)");
}

TEST(MeshCheck, ATurnedTriangleDisagreesWithItsNeighbours) {
  TriangleMesh rotated = kBox;
  std::swap(rotated.triangles[4][0], rotated.triangles[4][1]);
  const MeshCheck check = check_mesh(rotated);
  EXPECT_FALSE(check.closed());
  EXPECT_EQ(check.inconsistent_edges, 3);
  EXPECT_EQ(check.boundary_edges, 0);
}

TEST(MeshCheck, AFinMakesAnEdgeOfThree) {
  TriangleMesh fin = kBox;
  fin.vertices.emplace_back(9, 9, 9);
  fin.triangles.push_back({0, 1, 8});
  const MeshCheck check = check_mesh(fin);
  EXPECT_EQ(check.non_manifold_edges, 1);
  EXPECT_EQ(check.boundary_edges, 2);
}

TEST(MeshCheck, CountsPartsAndFindsThoseInsideOut) {
  const TriangleMesh two = meshes::together(kBox, box_mesh({1, 1, 1}, {10, 0, 0}));
  EXPECT_EQ(check_mesh(two).parts, 2);
  const MeshCheck check = check_mesh(meshes::inside_out(two));
  EXPECT_TRUE(check.closed());
  EXPECT_TRUE(check.inverted());
  EXPECT_NEAR(check.volume_m3, -25, 1e-12);
  EXPECT_HAS(text(check), "inside out");
}

TEST(MeshCheck, CountsBadVerticesAndIndices) {
  TriangleMesh bad = kBox;
  bad.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  bad.vertices[4].x() = std::numeric_limits<double>::infinity();
  bad.triangles[0][0] = 8, bad.triangles[1][2] = -1;
  const MeshCheck check = check_mesh(bad);
  EXPECT_EQ(check.bad_vertices, 2);
  EXPECT_EQ(check.bad_indices, 2);
  EXPECT_FALSE(check.closed());
  EXPECT_FALSE(check_mesh({}).closed());
  EXPECT_EQ(text(check_mesh({})), "no triangles");
}

TEST(MeshCheck, TrianglesWithoutAreaAreCounted) {
  TriangleMesh flat = kBox;
  flat.triangles.push_back({1, 1, 2});
  EXPECT_EQ(check_mesh(flat).degenerate_triangles, 1);
  flat.vertices.push_back((flat.vertices[0] + flat.vertices[1]) / 2);
  flat.triangles.push_back({0, 1, 8});
  EXPECT_EQ(check_mesh(flat).degenerate_triangles, 2);
}

TEST(MeshCheck, ANeedleHasNoArea) {
  TriangleMesh needle = kBox;
  const Vec3 edge = needle.vertices[1] - needle.vertices[0],
             aside(0, 1e-12 * edge.norm(), 1e-12 * edge.norm());
  needle.vertices.push_back(needle.vertices[1] + aside);
  needle.triangles.push_back({0, 1, 8});
  EXPECT_EQ(check_mesh(needle).degenerate_triangles, 1);
}

// A box as loose triangles: each has corners of its own, one occurs twice, every second one is turned, two
// are missing.
TEST(MeshRepair, PutsABoxTogetherAgain) {
  TriangleMesh soup;
  for (std::size_t t = 0; t < 10; ++t) {
    const auto [a, b, c] = kBox.triangles[t];
    const int first = static_cast<int>(soup.vertices.size());
    for (const int corner : {a, b, c})
      soup.vertices.push_back(kBox.vertices[corner] + Vec3(1e-9, 0, 0) * (t % 3));
    soup.triangles.push_back(
        {first, first + 1 + static_cast<int>(t % 2), first + 2 - static_cast<int>(t % 2)});
  }
  soup.triangles.push_back(soup.triangles[4]);
  soup.triangles.push_back({3, 3, 5});
  EXPECT_GT(check_mesh(soup).boundary_edges, 20);
  MeshRepair done;
  const TriangleMesh whole = repair_mesh(soup, done);
  const MeshCheck check = check_mesh(whole);
  EXPECT_TRUE(check.closed()) << text(check);
  EXPECT_NEAR(check.volume_m3, 24, 1e-6);
  EXPECT_EQ(done.welded_vertices, 22);
  EXPECT_EQ(done.dropped_triangles, 2);
  EXPECT_EQ(done.filled_holes, 1);
  EXPECT_GT(done.flipped_triangles, 0);
  EXPECT_HAS(text(done), "welded 22 vertices, dropped 2 triangles, turned");
}

TEST(MeshRepair, TurnsEachPartOutwardsForItself) {
  MeshRepair done;
  const TriangleMesh mixed = meshes::together(kBox, meshes::inside_out(box_mesh({1, 1, 1}, {10, 0, 0})));
  EXPECT_NEAR(check_mesh(repair_mesh(mixed, done)).volume_m3, 25, 1e-12);
  EXPECT_EQ(done.flipped_triangles, 12);
}

TEST(MeshRepair, TurnsAPartOutwardsThatCrossesOrTouchesAnother) {
  const double top = kBox.vertices.back().z();
  for (const double height : {0.0, 0.5}) {
    const TriangleMesh post = box_mesh({1, 1, 1}, {1, 1, top + height});
    const TriangleMesh mixed = meshes::together(kBox, meshes::inside_out(post));
    EXPECT_TRUE(MeshDistance(mixed).has_inverted_part());
    MeshRepair done;
    const MeshDistance repaired(repair_mesh(mixed, done));
    EXPECT_EQ(done.flipped_triangles, 12);
    EXPECT_FALSE(repaired.has_inverted_part());
    EXPECT_NEAR(repaired.nearest({1, 1, top + height + 0.25}, 1)->distance_m, -0.25, 1e-12);
  }
}

// The walk begins at the only triangle that is the wrong way round, so it turns all others first.
TEST(MeshRepair, ATriangleThatIsTurnedTwiceIsNotCounted) {
  TriangleMesh mesh = kBox;
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  MeshRepair done;
  const TriangleMesh repaired = repair_mesh(mesh, done);
  EXPECT_NEAR(check_mesh(repaired).volume_m3, 24, 1e-12);
  EXPECT_EQ(done.flipped_triangles, 1);
}

TEST(MeshRepair, LeavesAClosedMeshAlone) {
  MeshRepair done;
  done.flipped_triangles = 7;  // left over from an earlier mesh
  const TriangleMesh same = repair_mesh(kBox, done);
  EXPECT_EQ(same.triangles, kBox.triangles);
  EXPECT_EQ(same.vertices, kBox.vertices);
  EXPECT_EQ(text(done), "nothing");
}

}  // namespace
}  // namespace remote_touch::mesh_check_test

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
