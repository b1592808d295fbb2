#include "core/mesh/welded_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/mesh/mesh_check.h"
#include "tests/core/mesh/mesh_shapes.h"

namespace remote_touch::welded_mesh_test {
namespace {

using namespace mesh_shapes;

// The prism's edge from vertex 0 to vertex 3 is the sharp one, along z.
const TriangleMesh kWedge = prism({{0, 0, 0}, {1, -0.05, 0}, {1, 0.05, 0}}, 1);

std::ptrdiff_t without_area(const TriangleMesh& mesh) {
  return std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                       [&](const auto& triangle) { return is_degenerate(mesh, triangle); });
}

void expect_closed(const TriangleMesh& mesh, double volume_m3) {
  const MeshCheck check = check_mesh(mesh);
  EXPECT_TRUE(check.closed()) << text(check);
  EXPECT_EQ(check.degenerate_triangles, 0);
  EXPECT_NEAR(check.volume_m3, volume_m3, 1e-10);
}

TEST(WeldedMesh, IsTheMeshItselfIfNothingHasToBeJoined) {
  const TriangleMesh same = welded_mesh(kWedge);
  EXPECT_EQ(same.vertices, kWedge.vertices);
  EXPECT_EQ(same.triangles, kWedge.triangles);
}

TEST(WeldedMesh, HasOneVertexPerPosition) {
  const TriangleMesh loose = loose_triangles(kWedge);
  EXPECT_EQ(check_mesh(loose).boundary_edges, 24);
  const TriangleMesh welded = welded_mesh(loose);
  EXPECT_EQ(welded.vertices.size(), 6u);
  expect_closed(welded, 0.05);
}

TEST(WeldedMesh, LeavesOutVerticesThatNoTriangleUses) {
  TriangleMesh mesh = kWedge;
  mesh.vertices.insert(mesh.vertices.begin(), Vec3(9, 9, 9));
  for (auto& triangle : mesh.triangles)
    for (int& corner : triangle) ++corner;
  EXPECT_EQ(welded_mesh(mesh).vertices, kWedge.vertices);
  EXPECT_EQ(welded_mesh(mesh).triangles, kWedge.triangles);
}

TEST(WeldedMesh, DividesTheNeighbourOfACap) {
  for (const double aside : {0.0, 1e-12}) {
    const TriangleMesh cap = with_divided_side(kWedge, 0, 3, {{aside, 0, 0.25}});
    ASSERT_EQ(without_area(cap), 1);
    const TriangleMesh welded = welded_mesh(cap);
    EXPECT_EQ(welded.triangles.size(), 10u);
    EXPECT_EQ(welded.vertices.size(), 7u);
    expect_closed(welded, 0.05);
  }
}

// The triangles without area form a fan about one end of the edge, so only one of them has a neighbour with
// an area at first.
TEST(WeldedMesh, DividesTheNeighbourOfARowOfCaps) {
  std::vector<Vec3> row;
  for (int i = 1; i < 64; ++i) row.emplace_back(0, 0, i / 64.0);
  for (const auto& [from, to] : {std::pair{0, 3}, std::pair{3, 0}}) {
    const TriangleMesh caps = with_divided_side(kWedge, from, to, row);
    ASSERT_EQ(without_area(caps), 63);
    const TriangleMesh welded = welded_mesh(caps);
    EXPECT_EQ(welded.triangles.size(), 8u + 2 * 63);
    expect_closed(welded, 0.05);
    std::reverse(row.begin(), row.end());
  }
}

TEST(WeldedMesh, MergesTheEndsOfAVeryShortSide) {
  const TriangleMesh needle = with_divided_side(kWedge, 0, 3, {{0, 0, 1e-12}});
  ASSERT_EQ(without_area(needle), 2);
  const TriangleMesh welded = welded_mesh(needle);
  EXPECT_EQ(welded.triangles.size(), 8u);
  EXPECT_EQ(welded.vertices, kWedge.vertices);
  expect_closed(welded, 0.05);
}

TEST(WeldedMesh, DropsTrianglesWithoutAreaThatJoinNothing) {
  TriangleMesh mesh = kWedge;
  mesh.vertices.emplace_back(0, 0, 0.5);
  mesh.triangles.push_back({1, 1, 2});
  mesh.triangles.push_back({0, 3, 6}), mesh.triangles.push_back({0, 6, 3});
  const TriangleMesh welded = welded_mesh(mesh);
  EXPECT_EQ(welded.triangles, kWedge.triangles);
  EXPECT_EQ(welded.vertices, kWedge.vertices);
}

// The box of the wedge is 1 m long.
TEST(WeldedMesh, LeavesOutSmallFinsOnly) {
  for (const double height_m : {1e-6, 9e-4}) {
    TriangleMesh mesh = kWedge;
    mesh.vertices.emplace_back(-height_m, 0, 0.4);
    mesh.vertices.emplace_back(-height_m, 0, 0.6);
    mesh.triangles.insert(mesh.triangles.begin() + 2, {0, 3, 6});
    mesh.triangles.push_back({3, 0, 7});
    const TriangleMesh welded = welded_mesh(mesh);
    EXPECT_EQ(welded.triangles, kWedge.triangles);
    EXPECT_EQ(welded.vertices, kWedge.vertices);
  }
  TriangleMesh large = kWedge;
  large.vertices.emplace_back(-2e-3, 0, 0.4);
  large.triangles.push_back({0, 3, 6});
  EXPECT_EQ(welded_mesh(large).triangles, large.triangles);
}

// Two sides of such triangles have no other triangle, as in a fin, but the third has one neighbour only.
TEST(WeldedMesh, KeepsTheCornersOfASheet) {
  const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1e-4, 0}, {0, 1e-4, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(welded_mesh(sheet).triangles, sheet.triangles);
}

TEST(WeldedMesh, IsEmptyIfNoTriangleHasAnArea) {
  const TriangleMesh line{{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {0, 0, 0}}, {{0, 1, 2}, {0, 3, 1}, {2, 1, 0}}};
  EXPECT_TRUE(welded_mesh(line).triangles.empty());
  EXPECT_TRUE(welded_mesh(line).vertices.empty());
}

}  // namespace
}  // namespace remote_touch::welded_mesh_test
