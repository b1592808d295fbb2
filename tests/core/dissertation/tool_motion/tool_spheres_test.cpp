#include "core/dissertation/tool_motion/sphere_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "tests/support/box_tool.h"
#include "tests/support/leaf_pairs.h"
#include "tests/support/scenes.h"

namespace remote_touch::tool_spheres_test {
namespace {

// Its longest side is the second.
const TriangleMesh kTriangle{{{0.01, 0, 0}, {0, 0, 0.03}, {0, 0.04, 0}}, {{0, 1, 2}}};

double distance(const Vec3& place, const std::vector<Vec3>& samples) {
  double min = 1;
  for (const Vec3& sample : samples) min = std::min(min, (place - sample).norm());
  return min;
}

// Two random numbers give a point of the triangle. Points beyond its third side are reflected into it.
std::vector<Vec3> places_of_triangle() {
  std::vector<Vec3> places;
  const PointCloud cloud = scenes::random_cloud(2000, 1, 3);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    double u = std::abs(cloud.point(i).x()), v = std::abs(cloud.point(i).y());
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto& corner = kTriangle.vertices;
    places.push_back(corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]));
  }
  return places;
}

TEST(SurfaceSamples, LeaveNoPlaceOfATriangleOut) {
  for (const double spacing_m : {0.001, 0.004, 0.0101, 1.0}) {
    const std::vector<Vec3> samples = surface_samples(kTriangle, spacing_m);
    for (const Vec3& corner : kTriangle.vertices) EXPECT_LT(distance(corner, samples), 1e-12) << spacing_m;
    for (const Vec3& place : places_of_triangle())
      EXPECT_LT(distance(place, samples), std::min(spacing_m, 0.03));
  }
}

TEST(SurfaceSamples, AreOfTheTriangle) {
  const auto& v = kTriangle.vertices;
  const Vec3 normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
  for (const Vec3& sample : surface_samples(kTriangle, 0.002)) {
    EXPECT_NEAR(normal.dot(sample - v[0]), 0, 1e-15);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 inwards = normal.cross(v[(i + 1) % 3] - v[i]);
      EXPECT_GT(inwards.dot(sample - v[i]), -1e-15);
    }
  }
}

TEST(SurfaceSamples, OnePlaceOfACubeIsKept) {
  const std::vector<Vec3> kept =
      thinned({{0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, {1.1, 0.1, 0.1}, {0.2, 0.2, 0.2}}, 1);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0], Vec3(0.1, 0.1, 0.1));
  EXPECT_EQ(kept[1], Vec3(1.1, 0.1, 0.1));
}

TEST(SurfaceSamples, HaveTheAreaOfABox) {
  EXPECT_NEAR(surface_area_m2(scenes::box_mesh({0.01, 0.02, 0.03})), 8 * (1 * 2 + 1 * 3 + 2 * 3) * 1e-4,
              1e-12);
}

VoxelTool tool_of(const std::string& name) {
  ToolReport report;
  return make_voxel_tool(find_generated_tool(name)->make(), {}, report);
}

constexpr double kRounding_m = 1e-9;

// Greedy search: it adds one sphere after the other, each time the one that covers most of the remaining
// points.
std::vector<Sphere> plain_cover(const std::vector<Vec3>& points, const std::vector<Sphere>& choice,
                                double inflation_m, std::size_t max) {
  std::vector<Vec3> left = points;
  std::vector<Sphere> taken;
  while (!left.empty() && taken.size() <= max) {
    std::size_t best = 0, best_count = 0;
    const auto covers = [&](const Sphere& sphere, const Vec3& p) {
      return (p - sphere.centre).norm() <= sphere.radius_m + inflation_m;
    };
    for (std::size_t i = 0; i < choice.size(); ++i) {
      const auto count = static_cast<std::size_t>(
          std::count_if(left.begin(), left.end(), [&](const Vec3& p) { return covers(choice[i], p); }));
      if (count > best_count) best = i, best_count = count;
    }
    if (best_count == 0) break;
    taken.push_back({choice[best].centre, choice[best].radius_m + inflation_m});
    std::erase_if(left, [&](const Vec3& p) { return covers(choice[best], p); });
  }
  return taken;
}

TEST(SphereCover, TakesWhatAPlainSearchTakes) {
  const PointCloud points = scenes::random_cloud(2000, 0.05, 1), centres = scenes::random_cloud(300, 0.06, 2);
  std::vector<Vec3> places;
  std::vector<Sphere> choice;
  for (std::size_t i = 0; i < points.size(); ++i) places.push_back(points.point(i));
  for (std::size_t i = 0; i < centres.size(); ++i)
    choice.push_back({centres.point(i), 0.005 + 1e-5 * static_cast<double>(i % 700)});
  const SphereCover cover(places, choice, 0.004);
  for (const double inflation_m : {0.0, 0.004, 0.02}) {
    const SphereCover::Result result = cover.cover(inflation_m, 60);
    const std::vector<Sphere> expected = plain_cover(places, choice, inflation_m, 60);
    ASSERT_EQ(result.spheres.size(), expected.size()) << inflation_m;
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_EQ(result.spheres[i].centre, expected[i].centre) << inflation_m << ", sphere " << i;
  }
}

// A box of ten metres would need 1e12 cells of a millimetre, although it holds few points.
TEST(SphereCover, TakesFewPointsFarApartWithoutACellForEveryMillimetre) {
  const Vec3 far = Vec3::Constant(5);
  const std::vector<Sphere> choice{{far, 0.001}, {-far, 0.001}, {Vec3::Zero(), 0.001}};
  for (const Vec3& middle : {Vec3(0, 0, 0), Vec3(7, -7, 7)}) {
    std::vector<Sphere> there = choice;
    for (Sphere& sphere : there) sphere.centre += middle;
    const SphereCover cover({middle - far, middle + far}, there, 0.001);
    const SphereCover::Result result = cover.cover(0, 10);
    EXPECT_EQ(result.spheres.size(), 2u);
    EXPECT_EQ(result.uncovered_count, 0u);
  }
}

// Checks that the surface lies inside the union of spheres and that the union stays close to the tool.
double outside_of_cover_m(const VoxelTool& tool, int leaves) {
  const ToolSpheres made = make_tool_spheres(tool, leaves);
  EXPECT_LE(made.spheres.leaves().size(), static_cast<std::size_t>(leaves));
  EXPECT_LE(made.outside_m, made.inflation_m + kRounding_m) << leaves;
  EXPECT_LT(made.surface_outside_m, kRounding_m) << leaves;
  return made.outside_m;
}

TEST(ToolSpheres, CoverATool) {
  EXPECT_LT(outside_of_cover_m(tool_of("husky"), 16), 0.02);
}

TEST(ToolSpheres, AreTheCloserTheMoreThereAre) {
  const auto box = scenes::box_tool({0.02, 0.005, 0.01});
  EXPECT_LT(outside_of_cover_m(*box, 112), 0.6 * outside_of_cover_m(*box, 16));
}

// Both errors are computed in another way: the distance to a box has a closed form, and its surface is easy
// to sample.
TEST(ToolSpheres, ReportedErrorsOfABoxAreTrue) {
  const Vec3 half_m(0.02, 0.005, 0.01);
  const ToolSpheres made = make_tool_spheres(*scenes::box_tool(half_m), 60);
  const PointCloud directions = scenes::random_cloud(3000, 1, 8);
  double outside_m = 0, surface_outside_m = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (const Sphere& leaf : made.spheres.leaves())
      outside_m = std::max(
          outside_m,
          scenes::box_distance(half_m, leaf.centre + leaf.radius_m * directions.point(i).normalized()));
    const Vec3 on_cube =
        directions.point(i) / directions.point(i).cwiseAbs().maxCoeff();  // a point on a side of the box
    double min_m = 1;
    for (const Sphere& leaf : made.spheres.leaves())
      min_m = std::min(min_m, (half_m.cwiseProduct(on_cube) - leaf.centre).norm() - leaf.radius_m);
    surface_outside_m = std::max(surface_outside_m, min_m);
  }
  EXPECT_GT(made.inflation_m, 1e-3);  // otherwise there would be no error to compare
  EXPECT_NEAR(made.outside_m, outside_m, 0.1 * outside_m);
  EXPECT_LT(outside_m, made.inflation_m + 1e-6);
  EXPECT_LT(surface_outside_m, 5e-5);
}

TEST(ToolSpheres, RoundsTheReportedErrorUp) {
  ToolSpheres made;
  made.outside_m = 0.001291;
  EXPECT_EQ(text(made),
            "0 spheres, at most 1.30 mm outside the mesh; its surface is at most 0.00 mm outside them");
}

TEST(ToolSpheres, ABallIsNearlyOneSphere) {
  const ToolSpheres made = make_tool_spheres(tool_of("ball"), 1);
  ASSERT_EQ(made.spheres.leaves().size(), 1u);
  EXPECT_LT(made.outside_m, 1e-3);
  EXPECT_LT(made.surface_outside_m, 1e-4);
}

// Two layers of nodes lie inside, each next to an end of the field. Balls of only one layer would have to
// grow by a voxel to cover the other side.
TEST(ToolSpheres, CoverAPlateOfAFewVoxelsClosely) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 half_m(0.53, 0.53, 0.53);
    half_m[axis] = 0.13;
    ToolReport report;
    const VoxelTool tool = make_voxel_tool(scenes::box_mesh(half_m), {.voxel_m = 0.1}, report);
    ASSERT_EQ(tool.grid.cells[static_cast<std::size_t>(axis)], 3);
    EXPECT_LT(outside_of_cover_m(tool, 400), 0.07) << axis;
  }
}

TEST(ToolSpheres, AToolWithoutInsideIsRefused) {
  VoxelTool tool = *scenes::box_tool({0.002, 0.002, 0.002});
  for (float& distance : tool.distance_m) distance = std::abs(distance) + 1e-6f;
  EXPECT_THROW(make_tool_spheres(tool, 10), InputError);
}

}  // namespace
}  // namespace remote_touch::tool_spheres_test
