#include "core/mesh/mesh_check.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "core/mesh/mesh_distance.h"
#include "tests/support/meshes.h"
#include "tests/support/test_files.h"

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
