// The triangles of a mesh joined to a surface, and which of its faces bound the solid.
#include "core/mesh/mesh_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/mesh/mesh_shapes.h"

namespace remote_touch::mesh_sides_test {
namespace {

using namespace mesh_shapes;

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

std::size_t without_area(const TriangleMesh& mesh) {
  return static_cast<std::size_t>(std::ranges::count_if(
      mesh.triangles, [&](const auto& triangle) { return is_degenerate(mesh, triangle); }));
}

void expect_closed(const TriangleMesh& mesh, double volume_m3) {
  const MeshCheck check = check_mesh(mesh);
  EXPECT_TRUE(check.closed()) << text(check);
  EXPECT_EQ(check.degenerate_triangles, 0);
  EXPECT_NEAR(check.volume_m3, volume_m3, 1e-10);
}

TEST(WeldedMesh, HasOneVertexPerPosition) {
  const TriangleMesh loose = loose_triangles(kWedge);
  EXPECT_EQ(check_mesh(loose).boundary_edges, 24);
  const TriangleMesh welded = welded_mesh(loose);
  EXPECT_EQ(welded.vertices.size(), 6u);
  expect_closed(welded, 0.05);
}

// Vertices that no triangle uses, a very short side, triangles without area that join nothing, and small fins
// are left out. The box of the wedge is 1 m long.
TEST(WeldedMesh, IsTheWedgeWithoutWhatBoundsNoVolume) {
  TriangleMesh unused = kWedge, empty = kWedge;
  unused.vertices.insert(unused.vertices.begin(), Vec3(9, 9, 9));
  for (auto& triangle : unused.triangles)
    for (int& corner : triangle) ++corner;
  empty.vertices.emplace_back(0, 0, 0.5);
  empty.triangles.push_back({1, 1, 2});
  empty.triangles.push_back({0, 3, 6}), empty.triangles.push_back({0, 6, 3});
  const TriangleMesh needle = with_divided_side(kWedge, 0, 3, {{0, 0, 1e-12}});
  EXPECT_EQ(without_area(empty), 3u);
  EXPECT_EQ(without_area(needle), 2u);
  std::vector<TriangleMesh> all{kWedge, unused, empty, needle};
  for (const double height_m : {1e-6, 9e-4}) {
    TriangleMesh fins = kWedge;
    fins.vertices.emplace_back(-height_m, 0, 0.4), fins.vertices.emplace_back(-height_m, 0, 0.6);
    fins.triangles.insert(fins.triangles.begin() + 2, {0, 3, 6}), fins.triangles.push_back({3, 0, 7});
    all.push_back(fins);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TriangleMesh welded = welded_mesh(all[i]);
    EXPECT_EQ(welded.vertices, kWedge.vertices) << i;
    if (i != 3)
      EXPECT_EQ(welded.triangles, kWedge.triangles) << i;
    else
      EXPECT_EQ(welded.triangles.size(), 8u) << "in another order";
    expect_closed(welded, 0.05);
  }
}

// Two sides of the corners of a sheet have no other triangle, as in a fin, but the third has one neighbour
// only.
TEST(WeldedMesh, KeepsLargeFinsAndTheCornersOfASheet) {
  const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1e-4, 0}, {0, 1e-4, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  TriangleMesh large = kWedge;
  large.vertices.emplace_back(-2e-3, 0, 0.4);
  large.triangles.push_back({0, 3, 6});
  for (const TriangleMesh& mesh : {sheet, large}) EXPECT_EQ(welded_mesh(mesh).triangles, mesh.triangles);
}

// The triangles without area form a fan about one end of the edge, so only one of them has a neighbour with
// an area at first.
TEST(WeldedMesh, DividesTheNeighbourOfCaps) {
  std::vector<Vec3> row;
  for (int i = 1; i < 64; ++i) row.emplace_back(0, 0, i / 64.0);
  const std::vector<TriangleMesh> caps{
      with_divided_side(kWedge, 0, 3, {{0, 0, 0.25}}), with_divided_side(kWedge, 0, 3, {{1e-12, 0, 0.25}}),
      with_divided_side(kWedge, 0, 3, row), with_divided_side(kWedge, 3, 0, {row.rbegin(), row.rend()})};
  for (const TriangleMesh& mesh : caps) {
    const std::size_t count = mesh.vertices.size() - 6;
    ASSERT_EQ(without_area(mesh), count);
    const TriangleMesh welded = welded_mesh(mesh);
    EXPECT_EQ(welded.triangles.size(), 8 + 2 * count);
    EXPECT_EQ(welded.vertices.size(), 6 + count);
    expect_closed(welded, 0.05);
  }
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
