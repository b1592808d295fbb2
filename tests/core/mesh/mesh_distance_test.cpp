// The distance to a mesh and its sign against a loop over all triangles, and the faces that a tree visits.
#include "core/mesh/mesh_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"
#include "tests/core/mesh/mesh_shapes.h"

namespace remote_touch::mesh_distance_test {
namespace {

using namespace mesh_shapes;

// The references go over all triangles: the distance to each, and the sum of the solid angles, by which the
// inside of a closed mesh is known without any normal.
void expect_right_at(const TriangleMesh& mesh, const MeshDistance& surface, const Vec3& p,
                     bool closed = true) {
  const auto nearest = surface.nearest(p, kInfinity);
  ASSERT_TRUE(nearest);
  const double expected = meshes::distance(mesh, p), rounding = 1e-14 * (1 + p.norm());
  ASSERT_NEAR(std::abs(nearest->distance_m), expected, rounding) << p.transpose();
  ASSERT_NEAR((p - nearest->point).norm(), expected, rounding) << p.transpose();
  ASSERT_LT(meshes::distance(mesh, nearest->point), rounding) << p.transpose();
  ASSERT_NEAR(nearest->normal.norm(), 1, 1e-15);
  if (!closed) return;
  ASSERT_FALSE(nearest->on_border);
  if (expected < 1e-6) return;
  ASSERT_EQ(nearest->distance_m<0, meshes::winding(mesh, p)> 0.5) << p.transpose();
}

// Positions all around the mesh, and others close to a vertex or an edge.
void expect_right_around(const TriangleMesh& mesh, const MeshDistance& surface) {
  ASSERT_TRUE(surface.is_closed());
  const BoundingBox box = bounding_box(mesh.vertices);
  const double size = box.sizes().maxCoeff();
  RandomVectors random(11);
  for (int i = 0; i < 400 && !testing::Test::HasFatalFailure(); ++i)
    expect_right_at(mesh, surface, random.in_box(box));
  const std::size_t step = 1 + mesh.triangles.size() / 100;
  for (std::size_t t = 0; t < mesh.triangles.size() && !testing::Test::HasFatalFailure(); t += step)
    for (int i = 0; i < 3; ++i) {
      const Vec3& corner = mesh.vertices[mesh.triangles[t][i]];
      const Vec3 middle = (corner + mesh.vertices[mesh.triangles[t][(i + 1) % 3]]) / 2;
      for (const double away : {0.1 * size, 1e-3 * size, 1e-5 * size}) {
        expect_right_at(mesh, surface, corner + away * random.direction());
        expect_right_at(mesh, surface, middle + away * random.direction());
      }
    }
}

void expect_right(const TriangleMesh& mesh, const std::string& what) {
  SCOPED_TRACE(what);
  ASSERT_TRUE(check_mesh(mesh).closed()) << text(check_mesh(mesh));
  ASSERT_FALSE(check_mesh(mesh).inverted());
  expect_right_around(mesh, MeshDistance(mesh));
}

TEST(MeshDistance, IsThatOfBruteForce) {
  expect_right(box_mesh({2, 3, 4}, {1, 1, 1}), "a box");
  expect_right(meshes::tetrahedron({0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0}, {0.1, 0.3, 1}), "a tetrahedron");
  expect_right(prism(kL, 1), "an L");
  expect_right(torus(24, 12), "a torus");
  expect_right(rough_ball(15, 20, 0.01), "a ball");
  expect_right(rough_ball(15, 20, 0.6), "a rough ball");
  expect_right(meshes::together(box_mesh({4, 4, 4}), meshes::inside_out(rough_ball(9, 12, 0.3))), "a hollow");
  expect_right(meshes::together(meshes::together(box_mesh({0.5, 0.4, 0.3}), box_mesh({4, 4, 4})),
                                meshes::inside_out(rough_ball(9, 12, 0.3))),
               "a core within a hollow");
  expect_right(pyramid(kSquare, {0, 0, 1}), "a spike");
  expect_right(pyramid(divided_square(), {0, 0, 0.3}), "a spike with a divided side");
  expect_right(prism({{0, 0, 0}, {1, -0.01, 0}, {1, 0.01, 0}}, 1), "a wedge");
  expect_right(prism({{0, 0, 0}, {2, 0, 0}, {1, 0.05, 0}, {0, 2, 0}}, 1), "a prism with a notch");
  expect_right(meshes::moved(rough_ball(9, 9, 0.6), Vec3(1, 1, 0.02).asDiagonal(), {0, 0, 0}), "a flat ball");
}

// Positions near the apex of a pyramid that are outside, but behind one of its faces: the normal of that face
// gives the wrong sign. Where one side has many faces, so does the mean that is not weighted by angles.
TEST(MeshDistance, HasTheRightSignWhereSimplerNormalsFail) {
  const Vec3 apex(0, 0, 0.3);
  const TriangleMesh mesh = pyramid(divided_square(), apex);
  const MeshDistance surface(mesh);
  const auto end = static_cast<int>(mesh.vertices.size()) - 1;
  std::vector<Vec3> normals;
  Vec3 mean = Vec3::Zero();
  for (const auto& [a, b, c] : mesh.triangles) {
    if (c != end) continue;
    normals.push_back((mesh.vertices[b] - mesh.vertices[a]).cross(apex - mesh.vertices[a]).normalized());
    mean += normals.back();
  }
  ASSERT_EQ(normals.size(), 23u);
  RandomVectors random(3);
  int behind_a_face = 0, behind_the_mean = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = apex + 0.01 * random.direction();
    const auto nearest = surface.nearest(p, 1);
    ASSERT_TRUE(nearest);
    if (nearest->point != apex) continue;
    ASSERT_GT(meshes::winding(mesh, p), -0.5);
    ASSERT_LT(meshes::winding(mesh, p), 0.5);
    ASSERT_GT(nearest->distance_m, 0) << p.transpose();
    const auto behind = [&](const Vec3& normal) { return normal.dot(p - apex) < 0; };
    behind_a_face += std::any_of(normals.begin(), normals.end(), behind);
    behind_the_mean += behind(mean);
  }
  EXPECT_GT(behind_a_face, 100);
  EXPECT_GT(behind_the_mean, 10);
}

// Positions on the surface itself, and those that several faces are equally near to.
TEST(MeshDistance, IsRightOnVerticesEdgesAndPlanesOfSymmetry) {
  const TriangleMesh body = prism(kL, 1);
  const MeshDistance surface(body);
  for (const Vec3& v : body.vertices) {
    const auto nearest = surface.nearest(v, 1);
    ASSERT_TRUE(nearest);
    EXPECT_EQ(nearest->distance_m, 0);
    EXPECT_EQ(nearest->point, v);
    EXPECT_NEAR(nearest->normal.norm(), 1, 1e-15);
  }
  EXPECT_LT((surface.nearest({1, 1, 0.5}, 1)->normal - Vec3(1, 1, 0).normalized()).norm(), 1e-15);
  EXPECT_LT((surface.nearest({0, 0, 0}, 1)->normal - Vec3(-1, -1, -1).normalized()).norm(), 1e-15);
  const TriangleMesh box = box_mesh({2, 2, 2});  // three, four or five faces meet at a corner
  for (const Vec3& v : box.vertices)
    EXPECT_LT((MeshDistance(box).nearest(v, 1)->normal - v.normalized()).norm(), 1e-14);
  for (double x = -1; x <= 4; x += 0.25)
    for (double y = -1; y <= 3; y += 0.25)
      for (double z = -1; z <= 2; z += 0.25) {
        const Vec3 p(x, y, z);
        expect_right_at(body, surface, p);
        const double to_low = surface.nearest(p, kInfinity)->distance_m;
        const bool inside = x > 0 && y > 0 && z > 0 && z < 1 && ((x < 3 && y < 1) || (x < 1 && y < 2));
        ASSERT_EQ(to_low < 0, inside) << p.transpose();
      }
}

// The solid is where the mesh winds around a position, by the solid angles of all triangles. Faces within it
// are no surface.
TEST(MeshDistance, OfPartsWithinOthersIsThatOfTheOuterOnes) {
  const TriangleMesh outer = meshes::moved(box_mesh({4, 4, 4}), meshes::rotated(), {1, 2, 3});
  const auto inside = [](const TriangleMesh& part) {
    return meshes::moved(part, meshes::rotated().transpose(), {1.2, 1.9, 3.1});
  };
  const TriangleMesh ball = inside(rough_ball(9, 12, 0.3)), core = inside(box_mesh({0.5, 0.4, 0.3}));
  const MeshDistance alone(outer), nested(meshes::together(ball, outer)),
      twice(meshes::together(meshes::together(core, outer), ball));
  for (const MeshDistance* surface : {&alone, &nested, &twice}) {
    EXPECT_TRUE(surface->is_closed());
    EXPECT_FALSE(surface->has_inverted_part());
    EXPECT_FALSE(surface->crosses_itself());
  }
  EXPECT_EQ(nested.vertices().size(), 8u);
  RandomVectors random(21);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.in_box(bounding_box(outer.vertices));
    const auto expected = alone.nearest(p, kInfinity);
    for (const MeshDistance* surface : {&nested, &twice}) {
      const auto found = surface->nearest(p, kInfinity);
      ASSERT_EQ(found->distance_m, expected->distance_m) << p.transpose();
      ASSERT_EQ(found->normal, expected->normal) << p.transpose();
      ASSERT_FALSE(found->on_border);
    }
  }
}

// Balls and boxes that cross, that stand on a part of another one's face, and that do both.
TEST(MeshDistance, HasTheSignOfTheWindingNumberWherePartsCross) {
  const TriangleMesh ball = rough_ball(9, 12, 0.3), cube = box_mesh({1, 1, 1});
  const auto at = [](const TriangleMesh& part, const Vec3& by) {
    return meshes::moved(part, Eigen::Matrix3d::Identity(), by);
  };
  const TriangleMesh standing = meshes::together(cube, at(box_mesh({0.5, 0.5, 1}), {0.2, 0.3, 1}));
  const TriangleMesh cubes = meshes::together(cube, at(cube, {0.5, 0.25, 0.125}));
  TriangleMesh many = meshes::together(cubes, at(ball, {0.3, -0.4, 0.8}));
  many = meshes::moved(meshes::together(many, at(ball, {-0.9, 0.2, 0.1})), meshes::rotated(), {0, 0, 0});
  for (const TriangleMesh& mesh : {standing, cubes, many}) {
    const MeshDistance surface(mesh);
    EXPECT_TRUE(surface.is_closed());
    EXPECT_TRUE(surface.crosses_itself());
    EXPECT_FALSE(surface.has_inverted_part());
    RandomVectors random(22);
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = random.in_box(bounding_box(mesh.vertices));
      const auto nearest = surface.nearest(p, kInfinity);
      const double to_a_face = meshes::distance(mesh, p);
      if (to_a_face < 1e-6) continue;
      const bool is_inside = meshes::winding(mesh, p) > 0.5;
      ASSERT_EQ(nearest->distance_m < 0, is_inside) << p.transpose();
      ASSERT_GE(nearest->distance_m * (p - nearest->point).dot(nearest->normal), 0);
      if (is_inside)
        ASSERT_GE(-nearest->distance_m, to_a_face - 1e-14) << "faces within the solid may be left out";
      else
        ASSERT_NEAR(nearest->distance_m, to_a_face, 1e-14) << p.transpose();
      inside += is_inside;
    }
    EXPECT_GT(inside, 200);
  }
}

// Four faces meet at the edge, so check_mesh() does not count the surface as closed. Nevertheless it bounds a
// solid, and the sum of the solid angles is the reference there, too.
TEST(MeshDistance, HasTheRightSignWherePartsTouchAlongAnEdge) {
  const TriangleMesh boxes = boxes_at_an_edge();
  EXPECT_EQ(text(check_mesh(boxes)), "not closed: 1 non-manifold edge (1 part, 24 triangles)");
  expect_right_around(boxes, MeshDistance(boxes));
  // The first prism has a sharp edge on the z axis, and the second one an obtuse one.
  const TriangleMesh sharp = prism({{0, 0, 0}, {1, -0.1, 0}, {1, 0.1, 0}}, 1);
  const TriangleMesh obtuse = prism({{0, 0, 0}, {-0.1, 1, 0}, {-1, 0, 0}, {-0.1, -1, 0}}, 1);
  const TriangleMesh both = meshes::together(sharp, obtuse);
  expect_right_around(both, MeshDistance(both));
  EXPECT_EQ(check_mesh({MeshDistance(both).vertices(), MeshDistance(both).triangles()}).non_manifold_edges,
            1);
}

// A triangle on an edge of the box bounds no volume. It is left out where it is small; a large one makes the
// side unknown near it.
TEST(MeshDistance, IsClosedInSpiteOfASmallFin) {
  for (const double height : {1e-4, 0.1}) {
    TriangleMesh mesh = box_mesh({1, 1, 1});
    const auto [a, b, c] = mesh.triangles.front();
    const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b]) / 2;
    mesh.vertices.push_back((1 + height) * middle);
    mesh.triangles.push_back({a, b, 8});
    const MeshDistance surface(mesh);
    EXPECT_EQ(surface.is_closed(), height < 1e-3);
    if (surface.is_closed()) expect_right_around(box_mesh({1, 1, 1}), surface);
    EXPECT_EQ(surface.nearest(2 * middle, 1)->on_border, !surface.is_closed());
  }
  EXPECT_FALSE(MeshDistance(Sheet(2, 0).mesh).is_closed());
}

TEST(MeshDistance, UsesTheFirstOfEquallyNearFaces) {
  TriangleMesh box = box_mesh({2, 2, 2});
  for (int turn = 0; turn < 12; ++turn) {
    const auto& [a, b, c] = box.triangles.front();
    const Vec3 normal =
        (box.vertices[b] - box.vertices[a]).cross(box.vertices[c] - box.vertices[a]).normalized();
    EXPECT_EQ(MeshDistance(box).nearest({0, 0, 0}, 2)->normal, normal) << turn;
    std::rotate(box.triangles.begin(), box.triangles.begin() + 1, box.triangles.end());
  }
}

TEST(MeshDistance, IsNotKnownBeyondItsReachAndDoesNotDependOnIt) {
  const TriangleMesh ball = rough_ball(15, 20, 0.3);
  const MeshDistance surface(ball), other(ball);
  RandomVectors random(4);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random.in_box(bounding_box(ball.vertices));
    const auto expected = surface.nearest(p, kInfinity);
    const double distance_m = std::abs(expected->distance_m);
    EXPECT_FALSE(surface.nearest(p, distance_m));
    EXPECT_FALSE(surface.nearest(p, 0.9 * distance_m));
    for (const double reach_m : {std::nextafter(distance_m, 1e9), 1.1 * distance_m, 1e6}) {
      const auto same = other.nearest(p, reach_m);
      ASSERT_TRUE(same);
      EXPECT_EQ(same->distance_m, expected->distance_m);
      EXPECT_EQ(same->point, expected->point);
      EXPECT_EQ(same->normal, expected->normal);
    }
  }
  for (const double reach_m : {0.0, -1.0, std::nan("")}) EXPECT_FALSE(surface.nearest({0, 0, 2}, reach_m));
  for (const double x : {std::nan(""), kInfinity, -kInfinity, 1e16, 1e300})
    EXPECT_FALSE(surface.nearest({0, x, 0}, kInfinity)) << x;
}

TEST(MeshDistance, OfASheetIsKnownOnBothSidesButNotBeyondItsBorder) {
  const Sheet sheet(8, 0.1);
  for (const TriangleMesh& mesh : {sheet.mesh, loose_triangles(sheet.mesh)}) {
    const MeshDistance surface(mesh);
    EXPECT_EQ(surface.vertices().size(), 81u);
    RandomVectors random(5);
    int above = 0, below = 0, beyond = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = random.in_box(BoundingBox(Vec3(0, 0, -0.2), Vec3(1, 1, 0.3)));
      expect_right_at(sheet.mesh, surface, p, false);
      const auto nearest = surface.nearest(p, kInfinity);
      const double x = nearest->point.x(), y = nearest->point.y();
      ASSERT_EQ(nearest->on_border, x == 0 || x == 1 || y == 0 || y == 1) << p.transpose();
      beyond += nearest->on_border;
      if (nearest->on_border || p.x() < 0 || p.x() > 1 || p.y() < 0 || p.y() > 1) continue;
      const bool is_above = p.z() > sheet.height_at(p.x(), p.y());
      ASSERT_EQ(nearest->distance_m > 0, is_above) << p.transpose();
      above += is_above, below += !is_above;
    }
    EXPECT_GT(above, 200);
    EXPECT_GT(below, 200);
    EXPECT_GT(beyond, 200);
  }
}

TEST(MeshDistance, RejectsAMeshWithoutArea) {
  const TriangleMesh line{{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}, {{0, 1, 2}, {1, 1, 2}}};
  EXPECT_THROW(MeshDistance{line}, std::invalid_argument);
}

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
  RandomVectors random(5);
  for (int n = 0; n < 200; ++n) {
    const Vec3 p = random.in_box(box);
    const double nearest_m = meshes::distance(mesh, p),
                 rounding_m = 1e-14 * (box.diagonal().norm() + nearest_m);
    for (const double limit_m : {nearest_m, 2 * nearest_m, kInfinity}) {
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

// Single precision has steps of 0.06 mm at 1000 m, but the tree knows no position so far from its centre. The
// normals of slim faces have errors of up to 1e-6.
TEST(FaceTree, VisitsTheNearestFaces) {
  for (const int rings : {1, 2, 3, 7, 40})
    expect_the_nearest(rough_ball(rings, rings + 2, 0.4), std::to_string(rings) + " rings");
  expect_the_nearest(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, "one face");
  expect_the_nearest(prism(kL, 1), "an L");
  const TriangleMesh ball = rough_ball(20, 20, 0.4);
  const Vec3 far(1000, -900, 800);
  expect_the_nearest(meshes::moved(ball, 0.1 * meshes::rotated(), far), "small and far from the origin");
  expect_the_nearest(meshes::moved(ball, 1e4 * meshes::rotated(), far), "large and far from the origin");
  for (const Vec3& scale : {Vec3(1, 1, 1e-9), Vec3(1e-8, 1, 1e-8)})
    expect_the_nearest(meshes::moved(ball, meshes::rotated() * scale.asDiagonal(), {0, 0, 0}), "slim faces");
}

// An upper bound that a tree without bounds could not keep.
TEST(FaceTree, VisitsFewFaces) {
  const FaceTree tree(rough_ball(80, 80, 0.02));
  RandomVectors random(6);
  std::size_t faces = 0;
  for (int n = 0; n < 100; ++n) faces += visited(tree, random.direction(), kInfinity).size();
  EXPECT_LT(faces, 300u);
  const FaceTree ell(prism(kL, 1));
  EXPECT_TRUE(visited(ell, {-1, 0.5, 0.5}, 0.999).empty()) << "none beyond the limit";
  EXPECT_FALSE(visited(ell, {-1, 0.5, 0.5}, 1).empty());
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

}  // namespace
}  // namespace remote_touch::mesh_distance_test
