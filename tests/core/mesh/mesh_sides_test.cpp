#include "core/mesh/mesh_sides.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/mesh/mesh_shapes.h"

namespace remote_touch::mesh_sides_test {
namespace {

using namespace mesh_shapes;

void expect_direction(const Vec3& normal, const Vec3& expected) {
  EXPECT_LT((normal - expected.normalized()).norm(), 1e-14) << normal.transpose();
}

// Each side of a box is two triangles, so that three, four or five faces meet at a corner. The angles make up
// for it.
TEST(Pseudonormals, OfABoxPointAlongItsSymmetries) {
  const TriangleMesh box = box_mesh({2, 2, 2});
  const Pseudonormals normals = pseudonormals(box);
  ASSERT_EQ(normals.of_vertex.size(), 8u);
  for (std::size_t v = 0; v < 8; ++v) expect_direction(normals.of_vertex[v], box.vertices[v]);
  ASSERT_EQ(normals.of_face.size(), 12u);
  ASSERT_EQ(normals.of_edge.size(), 18u);
  for (std::size_t t = 0; t < 12; ++t) {
    const auto& corners = box.triangles[t];
    // Only one coordinate of a face is the same at all of its corners.
    Vec3 outwards = box.vertices[corners[0]];
    for (const int corner : corners)
      outwards = (outwards.array() == box.vertices[corner].array()).select(outwards, 0);
    expect_direction(normals.of_face[t], outwards);
    for (int side = 0; side < 3; ++side) {
      const Vec3 on_edge = (box.vertices[corners[side]] + box.vertices[corners[(side + 1) % 3]]) / 2;
      expect_direction(normals.of_edge[normals.edges_of_face[t][side]], on_edge);
    }
  }
  EXPECT_EQ(std::count(normals.edge_on_border.begin(), normals.edge_on_border.end(), 0), 18);
  EXPECT_EQ(std::count(normals.vertex_on_border.begin(), normals.vertex_on_border.end(), 0), 8);
}

// The mean that is not weighted tends to the side of many faces.
TEST(Pseudonormals, OfAVertexDoNotDependOnHowItsFacesAreDivided) {
  const Vec3 apex(0.02, 0.01, 0.3);
  const TriangleMesh plain = pyramid(kSquare, apex), divided = pyramid(divided_square(), apex);
  expect_direction(pseudonormals(divided).of_vertex.back(), pseudonormals(plain).of_vertex.back());
}

TEST(Pseudonormals, OfAnEdgeAreTheMeanOfItsFaces) {
  const TriangleMesh wedge = prism({{0, 0, 0}, {1, -0.05, 0}, {1, 0.05, 0}}, 1);
  const Pseudonormals normals = pseudonormals(wedge);
  bool found = false;
  for (std::size_t t = 0; t < wedge.triangles.size(); ++t)
    for (int side = 0; side < 3; ++side)
      if (wedge.triangles[t][side] == 0 && wedge.triangles[t][(side + 1) % 3] == 3) {
        expect_direction(normals.of_edge[normals.edges_of_face[t][side]], {-1, 0, 0});
        found = true;
      }
  EXPECT_TRUE(found);
}

TEST(Pseudonormals, MarkTheBorderOfASheet) {
  const Sheet sheet(4, 0);
  const Pseudonormals normals = pseudonormals(sheet.mesh);
  EXPECT_EQ(std::count(normals.edge_on_border.begin(), normals.edge_on_border.end(), 1), 16);
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i) {
      const bool expected = i == 0 || i == 4 || j == 0 || j == 4;
      EXPECT_EQ(normals.vertex_on_border[sheet.at(i, j)] != 0, expected) << i << " " << j;
      expect_direction(normals.of_vertex[sheet.at(i, j)], Vec3::UnitZ());
    }
}

// A flap on the edge of a box makes it an edge of three faces, at which the surface ends. A second box at the
// same edge makes it one of four.
TEST(Pseudonormals, MarkEdgesWithMoreFacesInOneDirectionAsBorder) {
  TriangleMesh box = box_mesh({2, 2, 2});
  const auto [a, b, c] = box.triangles.front();
  box.vertices.emplace_back(9, 9, 9);
  box.triangles.push_back({a, b, 8});
  const Pseudonormals flap = pseudonormals(box);
  EXPECT_EQ(std::count(flap.edge_on_border.begin(), flap.edge_on_border.end(), 1), 3);
  EXPECT_EQ(std::count(flap.vertex_on_border.begin(), flap.vertex_on_border.end(), 1), 3);
  const Pseudonormals touching = pseudonormals(boxes_at_an_edge());
  EXPECT_EQ(touching.of_edge.size(), 35u);
  EXPECT_EQ(std::count(touching.edge_on_border.begin(), touching.edge_on_border.end(), 1), 0);
}

TEST(Pseudonormals, AreThoseOfTheFirstFaceWhereTheMeanVanishes) {
  const TriangleMesh folded{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  const Pseudonormals normals = pseudonormals(folded);
  for (const Vec3& normal : normals.of_edge) EXPECT_EQ(normal, Vec3::UnitZ());
  for (const Vec3& normal : normals.of_vertex) EXPECT_EQ(normal, Vec3::UnitZ());
}

}  // namespace
}  // namespace remote_touch::mesh_sides_test
