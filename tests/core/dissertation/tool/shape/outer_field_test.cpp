#include "core/dissertation/tool/shape/outer_field.h"

#include <gtest/gtest.h>

#include <random>

#include "core/dissertation/tool/shape/cell_field.h"
#include "core/dissertation/tool/shape/slope_blocks.h"
#include "tests/support/meshes.h"

namespace remote_touch::outer_field_test {
namespace {

VoxelTool made(const TriangleMesh& mesh, bool outer_field, double voxel_m = 5e-4) {
  ToolReport report;
  return make_voxel_tool(mesh, {.voxel_m = voxel_m, .outer_field = outer_field}, report);
}

// A knife of 60 mm whose blade is 10 degrees sharp and ends in a point, turned against the grid.
TriangleMesh knife() {
  return meshes::moved(meshes::tetrahedron({0, 0, 0}, {0.06, 0, 0}, {0, 0.02, 0.0035}, {0, 0.02, -0.0035}),
                       meshes::rotated(), Vec3::Zero());
}

// Positions in a solid, on lines between positions of its surface. These lie inside if the solid is convex.
// Otherwise the winding number decides.
struct Places {
  std::vector<Vec3> inside, on_surface;
};
Places places_of(const TriangleMesh& mesh, bool convex) {
  Places places;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> fraction(0, 1);
  std::vector<double> area;
  for (const auto& [a, b, c] : mesh.triangles)
    area.push_back((mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm());
  std::discrete_distribution<std::size_t> any(area.begin(), area.end());
  for (int n = 0; n < 20000; ++n) {
    const auto& [a, b, c] = mesh.triangles[any(random)];
    double s = fraction(random), t = n % 3 == 0 ? 0 : fraction(random);  // also on edges
    if (s + t > 1) s = 1 - s, t = 1 - t;
    places.on_surface.push_back(mesh.vertices[a] + s * (mesh.vertices[b] - mesh.vertices[a]) +
                                t * (mesh.vertices[c] - mesh.vertices[a]));
  }
  for (std::size_t n = 0; n + 1 < places.on_surface.size(); ++n) {
    const double s = n % 2 == 0 ? fraction(random) : 0.02 * fraction(random);  // also close to the surface
    const Vec3 p = places.on_surface[n] + s * (places.on_surface[n + 1] - places.on_surface[n]);
    // Winding numbers need long, so only a tenth of the positions is tested.
    if (convex || (n % 20 < 2 && meshes::winding(mesh, p) > 0.5)) places.inside.push_back(p);
  }
  return places;
}

double highest(const VoxelTool& tool, const std::vector<Vec3>& places) {
  double most = -1;
  for (const Vec3& p : places) most = std::max(most, sample_field(tool, p).distance_m);
  return most;
}

struct Solid {
  const char* name;
  TriangleMesh mesh;
  double voxel_m;
  bool convex;
};

class OuterField : public testing::TestWithParam<Solid> {};
INSTANTIATE_TEST_SUITE_P(
    Solids, OuterField,
    testing::Values(Solid{"turned_box",
                          meshes::moved(box_mesh({0.03, 0.02, 0.01}), meshes::rotated(), Vec3::Zero()), 5e-4,
                          true},
                    Solid{"knife", knife(), 5e-4, true}, Solid{"coarse_knife", knife(), 1.1e-3, true},
                    Solid{"fork", find_generated_tool("fork")->make(), 2e-3, false}),
    [](const auto& solid) { return std::string(solid.param.name); });

TEST_P(OuterField, IsNowhereAboveZeroInTheSolid) {
  const VoxelTool plain = made(GetParam().mesh, false, GetParam().voxel_m),
                  outer = made(GetParam().mesh, true, GetParam().voxel_m);
  const Places places = places_of(outer.mesh, GetParam().convex);
  ASSERT_GT(places.inside.size(), 500u);
  EXPECT_GT(highest(plain, places.inside), 1e-5) << "nothing to lower";
  EXPECT_LE(highest(outer, places.inside), 0);
  EXPECT_LE(highest(outer, places.on_surface), 0);
}

// The field is lowered by no more than its error, and only around the surface.
TEST_P(OuterField, IsLoweredByPartOfAVoxel) {
  const double voxel_m = GetParam().voxel_m;
  const VoxelTool plain = made(GetParam().mesh, false, voxel_m), outer = made(GetParam().mesh, true, voxel_m);
  std::size_t lowered = 0;
  for (std::size_t n = 0; n < plain.distance_m.size(); ++n) {
    const float by = plain.distance_m[n] - outer.distance_m[n];
    EXPECT_GE(by, 0);
    EXPECT_LE(by, 0.87 * voxel_m);
    lowered += by > 0;
    if (std::abs(plain.distance_m[n]) > 2 * voxel_m) {
      EXPECT_EQ(by, 0);
    }
  }
  EXPECT_GT(lowered, 0u);
  EXPECT_EQ(plain.voxels, outer.voxels);
}

// Positions within two cells of an edge are left out.
TEST(OuterField, IsTheFieldOnFlatFaces) {
  const TriangleMesh mesh = meshes::moved(box_mesh({0.03, 0.02, 0.01}), meshes::rotated(), Vec3::Zero());
  const VoxelTool plain = made(mesh, false), outer = made(mesh, true);
  const Vec3 half_m(0.015, 0.01, 0.005);
  for (int n = 0; n < 20000; ++n) {
    std::mt19937 random(static_cast<unsigned>(n));
    std::uniform_real_distribution<double> place(-1, 1);
    Vec3 p = Vec3(place(random), place(random), place(random)).cwiseProduct(half_m - Vec3::Constant(2e-3));
    p[n % 3] = std::copysign(half_m[n % 3] + 3e-4 * place(random), p[n % 3]);
    const Vec3 p_T = meshes::rotated() * p;
    EXPECT_NEAR(sample_field(outer, p_T).distance_m, sample_field(plain, p_T).distance_m, 1e-7);
  }
}

TEST(OuterField, MaxSlopeIsThatOfDifferences) {
  const VoxelTool outer = made(knife(), true);
  const double bound = max_slope(outer.grid, outer.distance_m);
  EXPECT_LT(bound, 2.5);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> fraction(0, 1);
  double steepest = 0;
  for (int n = 0; n < 200000; ++n) {
    Vec3 at;
    for (int axis = 0; axis < 3; ++axis) at[axis] = fraction(random) * outer.grid.cells[axis];
    const FieldSample here = sample_field(outer, outer.grid.origin_T + outer.grid.size_m * at);
    if (std::abs(here.distance_m) < 2e-3) steepest = std::max(steepest, here.gradient_T.norm());
  }
  EXPECT_LE(steepest, bound);
  EXPECT_GT(steepest, 0.7 * bound);
}

TEST(CellField, IsTheTrilinearField) {
  const VoxelTool tool = made(knife(), true);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> fraction(0, 1);
  for (int n = 0; n < 2000; ++n) {
    std::array<int, 3> cell;
    Vec3 in;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<int>(fraction(random) * tool.grid.cells[axis]);
      in[axis] = fraction(random);
    }
    const CellField field(tool.grid, tool.distance_m, cell);
    const Vec3 origin = tool.grid.origin_T + tool.grid.size_m * Vec3(cell[0], cell[1], cell[2]);
    EXPECT_NEAR(field(in), sample_field(tool, origin + tool.grid.size_m * in).distance_m, 1e-12);
    // Second differences along any direction stay below the bound.
    const Vec3 direction =
        Vec3(fraction(random) - 0.5, fraction(random) - 0.5, fraction(random) - 0.5).normalized();
    const double bend = (field(in + 0.01 * direction) - 2 * field(in) + field(in - 0.01 * direction)) / 1e-4;
    EXPECT_LE(std::abs(bend), field.max_bend() * 1.05 + 1e-9);
  }
}

TEST(SlopeBlocks, BoundTheChangeAlongEveryWay) {
  const VoxelTool tool = made(knife(), true);
  const SlopeBlocks slopes(tool.grid, tool.distance_m);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> fraction(0, 1);
  double closest = 1;
  for (int n = 0; n < 50000; ++n) {
    Vec3 at, along;
    for (int axis = 0; axis < 3; ++axis) {
      at[axis] = 3 + fraction(random) * (tool.grid.cells[axis] - 6);
      along[axis] = SlopeBlocks::kAround * (2 * fraction(random) - 1);
    }
    const auto field = [&](double s) {
      return sample_field(tool, tool.grid.origin_T + tool.grid.size_m * (at + s * along)).distance_m;
    };
    double least = 0;
    for (int i = 1; i <= 20; ++i) least = std::min(least, field(i / 20.0) - field(0));
    const double bound = slopes.min_change_m(at, along);
    ASSERT_LE(bound, least + 1e-9);
    closest = std::min(closest, least - bound);
  }
  EXPECT_LT(closest, 1e-7);  // the bound is reached on the flat sides of the blade
}

TEST(SlopeBlocks, GiveNoBoundForLongPathsAndPositionsOutside) {
  const VoxelTool tool = made(knife(), false);
  const SlopeBlocks slopes(tool.grid, tool.distance_m);
  const Vec3 middle(10, 10, 10);
  EXPECT_GT(slopes.min_change_m(middle, {2, -2, 2}), -1);
  EXPECT_LT(slopes.min_change_m(middle, {2.1, 0, 0}), -1);
  EXPECT_LT(slopes.min_change_m({-0.1, 10, 10}, {0, 0, 0}), -1);
  EXPECT_LT(slopes.min_change_m({10, 10, double(tool.grid.cells[2])}, {0, 0, 0}), -1);
  EXPECT_LT(slopes.min_change_m(Vec3::Constant(std::nan("")), {0, 0, 0}), -1);
}

}  // namespace
}  // namespace remote_touch::outer_field_test
