#include "core/mesh/mesh_distance.h"

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

// True if an edge of a face runs through the inside of another face. The reference goes over all pairs.
std::vector<char> crossed_by_edges(const TriangleMesh& mesh) {
  std::vector<char> is_crossed(mesh.triangles.size(), 0);
  const auto at = [&](int face, int i) -> const Vec3& { return mesh.vertices[mesh.triangles[face][i % 3]]; };
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  for (int f = 0; f < static_cast<int>(is_crossed.size()); ++f)
    for (int g = 0; g < static_cast<int>(is_crossed.size()); ++g)
      for (int i = 0; f != g && i < 3; ++i) {
        const Vec3 &p = at(f, i), &q = at(f, i + 1), &a = at(g, 0), &b = at(g, 1), &c = at(g, 2);
        if (volume(a, b, c, p) * volume(a, b, c, q) >= 0) continue;
        const double u = volume(p, q, a, b), v = volume(p, q, b, c), w = volume(p, q, c, a);
        if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) is_crossed[f] = is_crossed[g] = 1;
      }
  return is_crossed;
}

TEST(MeshSides, CrossedFacesAreThoseOfBruteForce) {
  for (const TriangleMesh& mesh : {rough_ball(15, 20, 0.6), torus(24, 12), prism(kL, 1), boxes_at_an_edge()})
    EXPECT_EQ(crossed_faces(mesh), std::vector<char>(mesh.triangles.size(), 0));
  const TriangleMesh ball = rough_ball(10, 14, 0.4);
  RandomVectors random(23);
  for (int i = 0; i < 5; ++i) {
    TriangleMesh mesh = meshes::together(ball, meshes::moved(ball, meshes::rotated(), random.direction()));
    const std::vector<char> found = crossed_faces(mesh);
    EXPECT_EQ(found, crossed_by_edges(mesh));
    EXPECT_GT(std::count(found.begin(), found.end(), 1), 10);
  }
}

TEST(MeshSides, PartsThatAreInsideOutAreFoundWhereverTheyAre) {
  const TriangleMesh cube = box_mesh({1, 1, 1}), hollow = meshes::inside_out(box_mesh({0.5, 0.5, 0.5}));
  const auto is_inverted = [&](const Vec3& by) {
    return MeshDistance(meshes::together(cube, meshes::moved(hollow, meshes::rotated(), by)))
        .has_inverted_part();
  };
  EXPECT_FALSE(is_inverted({0, 0, 0}));
  EXPECT_TRUE(is_inverted({2, 0, 0}));
  EXPECT_TRUE(is_inverted({0.9, 0.9, 0.9})) << "beside a corner, with boxes that overlap";
  EXPECT_TRUE(MeshDistance(meshes::inside_out(torus(24, 12))).has_inverted_part());
  EXPECT_FALSE(MeshDistance(torus(24, 12)).has_inverted_part());
}

TriangleMesh box_from(const Vec3& low, const Vec3& high) {
  return box_mesh(high - low, (low + high) / 2);
}

bool is_inverted_with(const TriangleMesh& mesh, const TriangleMesh& part) {
  return MeshDistance(meshes::together(mesh, meshes::inside_out(part))).has_inverted_part();
}

// The parts cross, stand on a face, have an edge or a face in common, or are the same.
TEST(MeshSides, APartThatIsInsideOutIsFoundWhereItCrossesOrTouchesAnother) {
  const TriangleMesh slab = box_from({-4, -2, -3}, {4, 0, 3});
  for (const TriangleMesh& part :
       {box_from({-1, -1, -1}, {1, 1, 1}), box_from({-1, 0, -1}, {1, 2, 1}), box_from({3, -1, 2}, {5, 1, 4}),
        box_from({-4, 0, 3}, {4, 1, 4}), box_from({-4, 0, -3}, {4, 1, 3}), box_from({-4, 0, -3}, {4, 9, 3}),
        box_from({-4, -2, -3}, {4, 1, 3}), box_from({-5, -3, -4}, {5, 1, 4}),
        box_from({-4, 1e-9, -3}, {4, 1, 3})}) {
    SCOPED_TRACE(bounding_box(part.vertices).min().transpose());
    EXPECT_TRUE(is_inverted_with(slab, part));
    EXPECT_TRUE(MeshDistance(meshes::together(meshes::inside_out(part), slab)).has_inverted_part());
    EXPECT_FALSE(MeshDistance(meshes::together(slab, part)).has_inverted_part());
  }
  EXPECT_FALSE(MeshDistance(meshes::together(slab, slab)).has_inverted_part());
  EXPECT_TRUE(is_inverted_with(meshes::inside_out(slab), slab));
}

TEST(MeshSides, AHollowLiesWhollyInOneOtherPart) {
  const TriangleMesh ell = prism(kL, 1), room = box_from({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8});
  EXPECT_FALSE(is_inverted_with(ell, room));
  const TriangleMesh column = box_from({0.4, 0.4, 0.1}, {0.5, 0.5, 0.9});
  const TriangleMesh crate = box_from({0.3, 0.3, 0.2}, {0.5, 0.5, 0.4});
  EXPECT_FALSE(is_inverted_with(meshes::together(ell, column), room)) << "a part crosses the hollow";
  EXPECT_FALSE(is_inverted_with(meshes::together(crate, ell), room)) << "a part stands in the hollow";
  EXPECT_FALSE(
      is_inverted_with(meshes::together(ell, meshes::moved(ell, meshes::rotated(), {0, 0, 0.5})), room));
  EXPECT_TRUE(is_inverted_with(ell, box_from({0.2, 0.2, 0.2}, {0.8, 0.8, 1.1}))) << "a face pokes out";
  EXPECT_TRUE(is_inverted_with(ell, box_from({0.2, 0.2, 0.2}, {0.8, 0.8, 1}))) << "a face is open";
  EXPECT_TRUE(
      is_inverted_with(ell, pyramid({{0.2, 0.2, 0.2}, {0.8, 0.2, 0.2}, {0.5, 0.8, 0.2}}, {0.5, 0.5, 1.2})))
      << "an apex pokes out";
  const TriangleMesh beam =
      meshes::moved(meshes::tetrahedron({0.9, 0.1, 0}, {2.9, 0.5, 0}, {0.5, 1.9, 0}, {0.9, 0.9, 0.2}),
                    Eigen::Matrix3d::Identity(), {0, 0, 0.4});
  EXPECT_TRUE(is_inverted_with(ell, beam)) << "an edge pokes out, and no vertex";
  EXPECT_TRUE(is_inverted_with(meshes::together(ell, meshes::inside_out(room)),
                               box_from({0.4, 0.4, 0.4}, {0.5, 0.5, 0.5})))
      << "within another hollow";
}

TEST(MeshSides, ASheetWithTwoSidesIsNotInsideOut) {
  TriangleMesh sheet = meshes::moved(Sheet(6, 0.1).mesh, meshes::rotated(), {0.1, 0.2, 0.3});
  for (std::size_t t = 0, count = sheet.triangles.size(); t < count; ++t) {
    const auto [a, b, c] = sheet.triangles[t];
    sheet.triangles.push_back({b, a, c});
  }
  EXPECT_FALSE(MeshDistance(sheet).has_inverted_part());
  EXPECT_FALSE(MeshDistance(meshes::together(box_mesh({1, 1, 1}), sheet)).has_inverted_part());
}

// A pyramid over a bent, concave base crosses itself: a pocket of it, around which it winds backwards, is
// outside.
TEST(MeshSides, APocketOfASurfaceThatCrossesItselfIsOutside) {
  const TriangleMesh mesh{{{-0.01111, 0.00839, 0.0038},
                           {-0.00215, 0.09246, -0.07542},
                           {-0.01006, 0.02453, -0.01233},
                           {-0.07108, 0.05207, 0.05727},
                           {-0.08102, 0.00691, -0.0479}},
                          {{0, 1, 2}, {0, 2, 3}, {1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}}};
  const MeshDistance surface(mesh);
  EXPECT_TRUE(surface.crosses_itself());
  EXPECT_FALSE(surface.has_inverted_part());
  RandomVectors random(24);
  int pocket = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random.in_box(bounding_box(mesh.vertices));
    const double turns = meshes::winding(mesh, p);
    const auto nearest = surface.nearest(p, kInfinity);
    if (std::abs(nearest->distance_m) < 1e-7) continue;
    ASSERT_EQ(nearest->distance_m<0, turns> 0.5) << p.transpose();
    pocket += turns < -0.5;
  }
  EXPECT_GT(pocket, 0);
}

}  // namespace
}  // namespace remote_touch::mesh_sides_test
