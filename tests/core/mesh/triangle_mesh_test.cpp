// Polygons as triangles, the check and the repair of a mesh, and the meshes that need no file.
#include "core/mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/mesh_distance.h"
#include "core/parameters/parameter.h"
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

// Returns false if there are no triangles. Those of a polygon have its area as seen along its normal, and
// none is turned.
bool is_covered(const Polygon& polygon) {
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

// Expects the same answer with each corner as the first, in both directions, and turned and moved.
void expect_covered(const Polygon& polygon, bool expected, const Eigen::Matrix3d& turn = meshes::rotated()) {
  for (const Eigen::Matrix3d& turned : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turn})
    for (std::size_t first = 0; first < polygon.size(); ++first) {
      Polygon same;
      for (std::size_t j = 0; j < polygon.size(); ++j)
        same.push_back(turned * polygon[(first + j) % polygon.size()] + Vec3(1, 2, 3));
      EXPECT_EQ(is_covered(same), expected) << first;
      EXPECT_EQ(is_covered({same.rbegin(), same.rend()}), expected) << first;
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

TEST(PolygonTriangles, AreAFanForAConvexPolygonAndForOneWithoutArea) {
  const auto triangles = polygon_triangles(around(6, 1));
  ASSERT_TRUE(triangles);
  EXPECT_EQ(*triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
  const auto line = polygon_triangles({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->size(), 2u);
}

// Notches, an arrow, corners on straight edges, a star and a comb.
TEST(PolygonTriangles, CoverConcavePolygons) {
  Polygon star = around(14, 1), comb{{0, 0, 0}, {21, 0, 0}};
  for (std::size_t i = 0; i < star.size(); i += 2) star[i] *= 0.2;
  for (int x = 20; x >= 0; --x) comb.emplace_back(x, x % 2 == 0 ? 5 : 1, 0);
  for (const Polygon& polygon : std::vector<Polygon>{
           {{4, 4, 0}, {4, 1, 0}, {2, 1, 0}, {2, 4, 0}, {0, 4, 0}, {0, 0, 0}, {6, 0, 0}, {6, 4, 0}},
           {{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}},
           {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}},
           star,
           comb})
    expect_covered(polygon, true);
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
    expect_covered(polygon, expected, Eigen::AngleAxisd(3 * any(random), axis).toRotationMatrix());
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
  Polygon twice = around(4, 1);
  twice.insert(twice.end(), twice.begin(), twice.begin() + 4);
  for (const auto& [what, polygon] : std::map<std::string, Polygon>{
           {"figure 8, unequal loops", {{0, 0, 0}, {2, 1, 0}, {2, 0, 0}, {0, 2, 0}}},
           {"figure 8, equal loops: no area", {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}},
           {"a star", around(5, 2)},
           {"twice around", twice},
           {"touches an edge", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}},
           {"a spike", {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {9, 2, 0}, {4, 2, 0}, {0, 4, 0}}}})
    EXPECT_FALSE(polygon_triangles(polygon)) << what;
}

const TriangleMesh kBox = box_mesh({2, 3, 4}, {1, 1, 1});

// Returns the box with another vertex and another triangle.
TriangleMesh box_and(const Vec3& vertex, const std::array<int, 3>& triangle) {
  TriangleMesh mesh = kBox;
  mesh.vertices.push_back(vertex), mesh.triangles.push_back(triangle);
  return mesh;
}

TEST(MeshCheck, CountsWhatIsWrong) {
  TriangleMesh open = kBox, turned = kBox, bad_vertices = kBox, bad_indices = kBox;
  open.triangles.pop_back();
  std::swap(turned.triangles[4][0], turned.triangles[4][1]);
  bad_vertices.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  bad_vertices.vertices[4].x() = std::numeric_limits<double>::infinity();
  bad_indices.triangles[0][0] = 8, bad_indices.triangles[1][2] = -1;
  const TriangleMesh two = meshes::together(kBox, box_mesh({1, 1, 1}, {10, 0, 0}));
  const Vec3 corner = kBox.vertices[0], end = kBox.vertices[1];
  const double needle = 1e-12 * (end - corner).norm();
  const std::pair<TriangleMesh, const char*> rows[] = {
      {kBox, "closed (1 part, 12 triangles)"},
      {two, "closed (2 parts, 24 triangles)"},
      {meshes::inside_out(two), "closed (2 parts, 24 triangles, inside out)"},
      {TriangleMesh(), "no triangles"},
      {open, "not closed: 3 boundary edges (1 part, 11 triangles)"},
      {turned, "not closed: 3 edges between faces of opposite orientation (1 part, 12 triangles)"},
      {box_and({9, 9, 9}, {0, 1, 8}),
       "not closed: 2 boundary edges, 1 non-manifold edge (1 part, 13 triangles)"},
      {bad_vertices, "2 vertices that are not finite"},
      {bad_indices, "2 triangles with a corner that is not a vertex"}};
  for (const auto& [mesh, expected] : rows) {
    EXPECT_EQ(text(check_mesh(mesh)), expected);
    EXPECT_EQ(check_mesh(mesh).closed(), std::string(expected).starts_with("closed"));
  }
  for (const auto& flat : {box_and({9, 9, 9}, {1, 1, 2}), box_and((corner + end) / 2, {0, 1, 8}),
                           box_and(end + Vec3(0, needle, needle), {0, 1, 8})})
    EXPECT_EQ(check_mesh(flat).degenerate_triangles, 1);
  EXPECT_NEAR(check_mesh(two).volume_m3, 25, 1e-12);
  EXPECT_NEAR(check_mesh(meshes::inside_out(two)).volume_m3, -25, 1e-12);
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

Vec3 sides(const TriangleMesh& mesh) {
  return bounding_box(mesh.vertices).sizes();
}

TEST(GeneratedTools, AreClosedBodiesOfTheSizesThatTheirSummariesState) {
  const std::map<std::string, Vec3> mm = {
      {"ball", {20, 20, 20}},    {"bar", {80, 20, 10}},     {"block", {95, 20, 68}},
      {"fork", {126, 22, 77}},   {"husky", {95, 20, 68}},   {"key", {151, 28, 90}},
      {"slab-5", {40, 5, 40}},   {"slab-10", {40, 10, 40}}, {"slab-20", {40, 20, 40}},
      {"slab-40", {40, 40, 40}},
  };
  EXPECT_EQ(mm.size(), generated_tools().size());
  for (const GeneratedTool& tool : generated_tools()) {
    SCOPED_TRACE(tool.name);
    const TriangleMesh mesh = tool.make(), again = tool.make();
    const MeshCheck check = check_mesh(mesh);
    EXPECT_TRUE(check.closed()) << text(check);
    EXPECT_GT(check.volume_m3, 0);
    EXPECT_EQ(check.parts, 1);
    EXPECT_EQ(check.degenerate_triangles, 0);
    EXPECT_EQ(find_generated_tool(tool.name), &tool);
    const bool sharp = std::string(tool.name) == "bar" || std::string(tool.name).starts_with("slab");
    EXPECT_LT((1e3 * sides(mesh) - mm.at(tool.name)).cwiseAbs().maxCoeff(), sharp ? 1e-12 : 0.3);
    EXPECT_TRUE(mesh.triangles == again.triangles && mesh.vertices == again.vertices)
        << "the same every time";
  }
  EXPECT_EQ(find_generated_tool("wolf"), nullptr);
}

// Returns the angle at which the tool, free to move in x and z, is stopped by the box of Fig 6.3, 110 x 90
// mm: its extent first reaches that of the box.
double stops_at_deg(const TriangleMesh& mesh, double sense) {
  for (double deg = 0; deg < 90; deg += 0.05) {
    const Eigen::AngleAxisd about_y(sense * deg * kRadiansPerDegree, Vec3::UnitY());
    const Vec3 extent = sides(meshes::moved(mesh, about_y.toRotationMatrix(), Vec3::Zero()));
    if (extent.x() >= 0.110 || extent.z() >= 0.090) return deg;
  }
  return 90;
}

TEST(GeneratedTools, TheHuskyIsStoppedByTheNarrowBox) {
  const TriangleMesh husky = find_generated_tool("husky")->make();
  EXPECT_NEAR(stops_at_deg(husky, 1), 21.35, 0.15);
  EXPECT_NEAR(stops_at_deg(husky, -1), 21.35, 0.15);
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
}  // namespace remote_touch::triangle_mesh_test
