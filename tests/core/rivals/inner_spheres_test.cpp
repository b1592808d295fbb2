// The packing compared with closed forms for a cube and a ball, and with every pair of spheres.
#include "core/rivals/inner_sphere_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"
#include "core/parameters/parameter.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::inner_spheres_test {
namespace {

constexpr double kRounding_m = 1e-9;
const Vec3 kHalf_m(0.02, 0.005, 0.01);

VoxelTool tool_of(const std::string& name, double voxel_m = 5e-4) {
  ToolReport report;
  return make_voxel_tool(find_generated_tool(name)->make(), {.voxel_m = voxel_m}, report);
}

const InnerSpheres& in_box() {
  static const InnerSpheres made = make_inner_spheres(*scenes::box_tool(kHalf_m), 400);
  return made;
}

double gap_m(const Sphere& a, const Sphere& b) {
  return (a.centre - b.centre).norm() - a.radius_m - b.radius_m;
}

void expect_no_overlap(const std::vector<Sphere>& spheres) {
  double smallest_m = 1;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) smallest_m = std::min(smallest_m, gap_m(spheres[i], spheres[j]));
  EXPECT_GT(smallest_m, -kRounding_m);
}

TEST(InnerSpheres, DoNotOverlap) {
  ASSERT_GT(in_box().spheres.size(), 300u);
  expect_no_overlap(in_box().spheres);
  expect_no_overlap(make_inner_spheres(tool_of("fork", 1e-3), 300).spheres);
}

TEST(InnerSpheres, LieInsideABox) {
  for (const Sphere& sphere : in_box().spheres) {
    EXPECT_GE(sphere.radius_m, 0.9 * 5e-4);
    EXPECT_LE(scenes::box_distance(kHalf_m, sphere.centre), -sphere.radius_m + kRounding_m);
  }
}

// The winding number says which side of the mesh a centre is on.
TEST(InnerSpheres, LieInsideAMeshThatIsNotConvex) {
  const VoxelTool tool = tool_of("fork", 1e-3);
  const TriangleTree tree(tool.mesh);
  for (const Sphere& sphere : make_inner_spheres(tool, 300).spheres) {
    EXPECT_GT(tree.winding_number(sphere.centre), 0.9);
    EXPECT_GE(std::sqrt(tree.nearest(sphere.centre, 0).squared_m2), sphere.radius_m - kRounding_m);
  }
}

// The largest sphere in a cube of half side a has the radius a. The next eight touch it and three faces:
// r = a (sqrt 3 - 1) / (sqrt 3 + 1).
TEST(InnerSpheres, AreTheLargestThatFitIntoACube) {
  constexpr double a = 0.01;
  const std::vector<Sphere> spheres = make_inner_spheres(*scenes::box_tool({a, a, a}), 9).spheres;
  ASSERT_EQ(spheres.size(), 9u);
  EXPECT_NEAR(spheres[0].radius_m, a, 1e-6);
  EXPECT_NEAR(spheres[0].centre.norm(), 0, 1e-6);
  const double root = std::sqrt(3.0), r = a * (root - 1) / (root + 1);
  for (std::size_t i = 1; i < 9; ++i) {
    EXPECT_NEAR(spheres[i].radius_m, r, 0.02 * r) << i;
    EXPECT_NEAR((spheres[i].centre.cwiseAbs() - Vec3::Constant(a - r)).norm(), 0, 0.05 * r) << i;
  }
}

TEST(InnerSpheres, ABallIsOneSphere) {
  const InnerSpheres made = make_inner_spheres(tool_of("ball"), 1000);
  EXPECT_NEAR(made.spheres.front().radius_m, 0.01, 1e-4);
  EXPECT_GT(made.coverage, 0.97);
}

TEST(InnerSpheres, CoverageIsTheirShareOfTheVolume) {
  double volume_m3 = 0;
  for (const Sphere& s : in_box().spheres) volume_m3 += 4 * std::numbers::pi / 3 * std::pow(s.radius_m, 3);
  EXPECT_NEAR(in_box().coverage, volume_m3 / (8 * kHalf_m.prod()), 1e-12);
}

// Equal spheres in a cubic lattice fill 52 % of space.
TEST(InnerSpheres, FillTheMoreTheMoreThereAre) {
  const auto tool = scenes::box_tool(kHalf_m);
  double before = 0;
  for (const int count : {4, 40, 400}) {
    const InnerSpheres made = make_inner_spheres(*tool, count);
    EXPECT_LE(made.spheres.size(), static_cast<std::size_t>(count));
    EXPECT_GT(made.coverage, before);
    before = made.coverage;
  }
  EXPECT_GT(before, 0.6);
  EXPECT_LT(before, 1);
}

TEST(InnerSpheres, EqualTheirMirrorImagesInABox) {
  const std::vector<Sphere>& spheres = in_box().spheres;
  const std::size_t complete = spheres.size() < 400 ? spheres.size() : 400 - 8;  // the last may lack images
  for (std::size_t i = 0; i < complete; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 image = spheres[i].centre;
      image[axis] = -image[axis];
      EXPECT_TRUE(std::any_of(spheres.begin(), spheres.end(),
                              [&](const Sphere& other) {
                                return other.centre == image && other.radius_m == spheres[i].radius_m;
                              }))
          << i << " " << axis;
    }
}

TEST(InnerSpheres, NeighboursAreThePairsWithSmallGaps) {
  const InnerSpheres& made = in_box();
  const auto count = static_cast<std::uint32_t>(made.spheres.size());
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t j = 0; j < count; ++j) {
      const auto of_i = made.neighbours(i), of_j = made.neighbours(j);
      const bool is_listed = std::binary_search(of_i.begin(), of_i.end(), j);
      EXPECT_EQ(is_listed, std::binary_search(of_j.begin(), of_j.end(), i));
      if (i != j && gap_m(made.spheres[i], made.spheres[j]) <= 5e-4) {
        EXPECT_TRUE(is_listed);
      }
    }
}

// Thirty spheres in a key lie so far apart that few of them are neighbours by their gaps.
TEST(InnerSpheres, EverySphereCanBeReached) {
  for (const InnerSpheres& made : {in_box(), make_inner_spheres(tool_of("key", 1e-3), 30)}) {
    std::vector<std::uint32_t> reached{0};
    std::vector<bool> is_reached(made.spheres.size(), false);
    is_reached[0] = true;
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const std::uint32_t to : made.neighbours(reached[i])) {
        if (!is_reached[to]) reached.push_back(to);
        is_reached[to] = true;
      }
    EXPECT_EQ(reached.size(), made.spheres.size());
  }
}

TEST(InnerSpheres, AreTheSameEveryTime) {
  const InnerSpheres again = make_inner_spheres(*scenes::box_tool(kHalf_m), 400);
  ASSERT_EQ(again.spheres.size(), in_box().spheres.size());
  for (std::size_t i = 0; i < again.spheres.size(); ++i) {
    EXPECT_EQ(again.spheres[i].centre, in_box().spheres[i].centre);
    EXPECT_EQ(again.spheres[i].radius_m, in_box().spheres[i].radius_m);
  }
  EXPECT_EQ(again.neighbour, in_box().neighbour);
}

TEST(InnerSpheres, AskForASmallerVoxelIfNoneFits) {
  VoxelTool tool = *scenes::box_tool({0.002, 0.002, 0.002});
  for (float& distance : tool.distance_m) distance = std::abs(distance) + 1e-6f;
  EXPECT_THROW(make_inner_spheres(tool, 10), InputError);
}

TEST(InnerSpheres, TextRoundsTheCoverageDown) {
  InnerSpheres made;
  made.spheres.resize(12);
  made.coverage = 0.70599;
  EXPECT_EQ(text(made), "12 inner spheres fill 70.5 % of the tool");
}

// Compares with a search through all spheres.
TEST(SphereLocator, FindsTheSphereThatContainsAPosition) {
  const std::vector<Sphere>& spheres = in_box().spheres;
  const SphereLocator locator(spheres);
  const PointCloud positions = scenes::random_cloud(20000, 0.021, 3);
  int found = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const Vec3 p = positions.point(k);
    std::optional<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < spheres.size() && !expected; ++i)
      if ((p - spheres[i].centre).squaredNorm() < spheres[i].radius_m * spheres[i].radius_m) expected = i;
    EXPECT_EQ(locator.at(p), expected);
    found += expected ? 1 : 0;
  }
  EXPECT_GT(found, 1000);
  EXPECT_LT(found, 19000);
}

TEST(SphereLocator, FindsNothingAtNan) {
  const SphereLocator locator(in_box().spheres);
  EXPECT_TRUE(locator.at(in_box().spheres[0].centre));
  EXPECT_FALSE(locator.at({0, std::nan(""), 0}));
  EXPECT_FALSE(locator.at({1e300, 0, 0}));
}

}  // namespace
}  // namespace remote_touch::inner_spheres_test
