// The distance field of a mesh and its bounds against loops over all triangles and finite differences.
#include "core/mesh/distance_field.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "core/mesh/voxel_tool.h"
#include "tests/support/meshes.h"

namespace remote_touch::distance_field_test {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  Vec3 vector(const Vec3& low, const Vec3& high) {
    const double x = number(low.x(), high.x()), y = number(low.y(), high.y());
    return {x, y, number(low.z(), high.z())};
  }
  Vec3 vector(double most) { return vector(Vec3::Constant(-most), Vec3::Constant(most)); }

 private:
  std::mt19937 generator_;
};

struct Field {
  explicit Field(const TriangleMesh& mesh, double voxel_m = 5e-4)
      : grid(grid_around(mesh, voxel_m)),
        values(distance_field(TriangleTree(mesh), grid, inside_nodes(mesh, grid).inside)) {}
  Vec3 place(std::size_t n) const {
    const std::size_t columns = grid.cells[0] + 1, rows = grid.cells[1] + 1;
    return grid.origin_T + grid.size_m * Vec3(n % columns, n / columns % rows, n / columns / rows);
  }
  VoxelGrid grid;
  std::vector<float> values;
};

// The error is at most the rounding of a float near the surface and a voxel elsewhere. The distance is never
// too small.
void expect_distances(const TriangleMesh& mesh, std::size_t step, double voxel_m = 5e-4) {
  SCOPED_TRACE("a mesh of " + std::to_string(mesh.triangles.size()) + " triangles");
  const Field field(mesh, voxel_m);
  ASSERT_EQ(field.values.size(), field.grid.node_count());
  int near = 0, far = 0, inside = 0;
  for (std::size_t n = 0; n < field.values.size(); n += step) {
    const Vec3 p = field.place(n);
    const double expected = meshes::distance(mesh, p), got = std::abs(field.values[n]);
    if (expected <= kExactField_m) {
      ASSERT_NEAR(got, expected, 1e-9) << p.transpose();
      ++near;
    } else {
      ASSERT_GE(got, expected - 1e-8) << p.transpose();
      ASSERT_LE(got, expected + field.grid.size_m) << p.transpose();
      ++far;
    }
    if (expected < 1e-8 || n / step % 3 != 0) continue;
    ASSERT_EQ(field.values[n]<0, meshes::winding(mesh, p)> 0.5) << p.transpose();
    inside += field.values[n] < 0;
  }
  EXPECT_GT(near, 30);
  EXPECT_GT(far, 50);
  EXPECT_GT(inside, 5);
}

// The steps have no common factor with the rows, so the nodes are spread all over the grid.
TEST(DistanceField, AgreesWithAllTriangles) {
  expect_distances(meshes::any_body("ball"), 809);
  expect_distances(meshes::any_body("husky"), 1009, 1e-3);
  expect_distances(find_generated_tool("key")->make(), 1511, 1e-3);
  expect_distances(meshes::moved(box_mesh({0.06, 0.02, 0.004}), meshes::rotated(), {0, 0, 0}), 97);
  expect_distances(meshes::any_body("fork"), 307, 2e-3);
}

// The search may begin with any face. The positions are near, on the other side and far away.
TEST(TriangleTree, FindsTheNearestFaceAndAllWithinADistance) {
  const TriangleMesh body = meshes::any_body("key");
  const TriangleTree tree(body);
  std::vector<TriangleTree::Candidate> faces;
  for (int n = 0; n < 300; ++n) {
    const double reach = n % 3 == 0 ? 0.3 : 0.08;
    const Vec3 p = reach * Vec3(n * 37 % 101 - 50, n * 53 % 103 - 51, n * 71 % 107 - 53) / 50;
    const double expected = meshes::distance(body, p);
    const TriangleTree::Nearest found = tree.nearest(p, n * 61 % static_cast<int>(body.triangles.size()));
    EXPECT_NEAR(std::sqrt(found.squared_m2), expected, 1e-12) << p.transpose();
    EXPECT_EQ(tree.squared_to(found.face, p), found.squared_m2);
    tree.faces_within(p, 1.1 * expected, faces);
    std::size_t count = 0;
    for (const auto& [a, b, c] : body.triangles)
      count += meshes::to_triangle(p, body.vertices[a], body.vertices[b], body.vertices[c]) <= 1.1 * expected;
    EXPECT_EQ(faces.size(), count);
    EXPECT_EQ(faces.front().distance_m, std::sqrt(found.squared_m2));
  }
}

// Three corners on a line: rounding alone would decide whether a position is above their triangle.
TEST(TriangleTree, ATriangleWithoutAreaIsAsFarAsItsEdges) {
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a = random.vector(0.01), along = random.vector(0.01), p = random.vector(0.01);
    const Vec3 b = a + random.number(-1, 1) * along, c = a + random.number(-1, 1) * along;
    const TriangleTree tree(TriangleMesh{{a, b, c}, {{0, 1, 2}}});
    const double expected =
        std::min({meshes::to_segment(p, a, b), meshes::to_segment(p, b, c), meshes::to_segment(p, c, a)});
    ASSERT_NEAR(std::sqrt(tree.squared_to(0, p)), expected, 1e-8) << i;
  }
}

TEST(TriangleTree, WindingNumberEqualsTheSumOfSolidAngles) {
  const TriangleMesh body = meshes::any_body("ball");
  const TriangleTree tree(body);
  for (int n = 0; n < 200; ++n) {
    const Vec3 p =
        Vec3(0.01, -0.02, 0.03) + 4e-4 * Vec3(n * 37 % 101 - 50, n * 53 % 103 - 51, n * 71 % 107 - 53);
    EXPECT_NEAR(tree.winding_number(p), meshes::winding(body, p), 0.02) << p.transpose();
  }
}

TEST(DistanceField, NeedlesAndTrianglesWithoutAreaDoNoHarm) {
  TriangleMesh body = box_mesh({0.02, 0.02, 0.02});
  const Field before(body);
  // Adds a corner on one edge and two triangles without area. The mesh stays closed.
  body.vertices.push_back(0.3 * body.vertices[0] + 0.7 * body.vertices[1]);
  body.triangles.push_back({0, 1, 8}), body.triangles.push_back({0, 8, 1});
  const Field after(body);
  for (std::size_t n = 0; n < before.values.size(); ++n)
    ASSERT_NEAR(after.values[n], before.values[n], std::abs(before.values[n]) < kExactField_m ? 1e-9 : 1e-4);
}

TEST(DistanceField, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh body = meshes::any_body("husky");
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Field one(body, 1e-3);
  const std::vector<std::uint8_t> crossed = crossed_cells(body, one.grid);
  omp_set_num_threads(3);
  EXPECT_EQ(Field(body, 1e-3).values, one.values);
  EXPECT_EQ(crossed_cells(body, one.grid), crossed);
  omp_set_num_threads(threads);
}

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

// The field is lowered by no more than its error, and only around the surface.
TEST(OuterField, IsNowhereAboveZeroInTheSolidAndIsLoweredByPartOfAVoxel) {
  const TriangleMesh turned = meshes::moved(box_mesh({0.03, 0.02, 0.01}), meshes::rotated(), Vec3::Zero());
  const struct {
    const char* name;
    TriangleMesh mesh;
    double voxel_m;
    bool convex;
  } solids[] = {{"turned box", turned, 5e-4, true},
                {"knife", knife(), 5e-4, true},
                {"coarse knife", knife(), 1.1e-3, true},
                {"fork", find_generated_tool("fork")->make(), 2e-3, false}};
  for (const auto& [name, mesh, voxel_m, convex] : solids) {
    SCOPED_TRACE(name);
    const VoxelTool plain = made(mesh, false, voxel_m), outer = made(mesh, true, voxel_m);
    const Places places = places_of(outer.mesh, convex);
    ASSERT_GT(places.inside.size(), 500u);
    EXPECT_GT(highest(plain, places.inside), 1e-5) << "nothing to lower";
    EXPECT_LE(highest(outer, places.inside), 0);
    EXPECT_LE(highest(outer, places.on_surface), 0);
    for (std::size_t n = 0; n < plain.distance_m.size(); ++n) {
      const float by = plain.distance_m[n] - outer.distance_m[n];
      EXPECT_GE(by, 0);
      EXPECT_LE(by, std::abs(plain.distance_m[n]) > 2 * voxel_m ? 0 : 0.87 * voxel_m);
    }
    EXPECT_EQ(plain.voxels, outer.voxels);
  }
}

// Positions within two cells of an edge are left out.
TEST(OuterField, IsTheFieldOnFlatFaces) {
  const TriangleMesh mesh = meshes::moved(box_mesh({0.03, 0.02, 0.01}), meshes::rotated(), Vec3::Zero());
  const VoxelTool plain = made(mesh, false), outer = made(mesh, true);
  const Vec3 half_m(0.015, 0.01, 0.005), inner_m = half_m - Vec3::Constant(2e-3);
  Random random(1);
  for (int n = 0; n < 20000; ++n) {
    Vec3 p = random.vector(-inner_m, inner_m);
    p[n % 3] = std::copysign(half_m[n % 3] + random.number(-3e-4, 3e-4), p[n % 3]);
    const Vec3 p_T = meshes::rotated() * p;
    EXPECT_NEAR(sample_field(outer, p_T).distance_m, sample_field(plain, p_T).distance_m, 1e-7);
  }
}

// The field of the knife, at positions in units of cells.
class KnifeField : public testing::Test {
 protected:
  FieldSample at(const Vec3& cells) const {
    return sample_field(tool_, tool_.grid.origin_T + tool_.grid.size_m * cells);
  }
  static const VoxelTool& knife_tool() {
    static const VoxelTool tool = made(knife(), true);
    return tool;
  }
  const VoxelTool& tool_ = knife_tool();
  const Vec3 end_{double(tool_.grid.cells[0]), double(tool_.grid.cells[1]), double(tool_.grid.cells[2])};
};

TEST_F(KnifeField, MaxSlopeIsThatOfDifferences) {
  const double bound = max_slope(tool_.grid, tool_.distance_m);
  EXPECT_LT(bound, 2.5);
  Random random(5);
  double steepest = 0;
  for (int n = 0; n < 200000; ++n) {
    const FieldSample here = at(random.vector(Vec3::Zero(), end_));
    if (std::abs(here.distance_m) < 2e-3) steepest = std::max(steepest, here.gradient_T.norm());
  }
  EXPECT_LE(steepest, bound);
  EXPECT_GT(steepest, 0.7 * bound);
}

// Second differences of the field of a cell along any direction stay below its bound.
TEST_F(KnifeField, OfACellIsTheTrilinearOne) {
  Random random(7);
  const std::size_t row = tool_.grid.cells[0] + 1, layer = row * (tool_.grid.cells[1] + 1);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 place = random.vector(Vec3::Zero(), end_);
    const Eigen::Vector3i first = place.cast<int>();
    const Vec3 in = place - first.cast<double>();
    const CellField field(tool_.grid, tool_.distance_m, {first.x(), first.y(), first.z()});
    EXPECT_NEAR(field(in), at(place).distance_m, 1e-12);
    const float stored = tool_.distance_m[first.x() + row * first.y() + layer * first.z()];
    EXPECT_EQ(field(Vec3::Zero()), stored);
    EXPECT_NEAR(at(first.cast<double>()).distance_m, stored, 1e-9);
    const Vec3 step = 0.01 * random.vector(1).normalized();
    const double bend = (field(in + step) - 2 * field(in) + field(in - step)) / 1e-4;
    EXPECT_LE(std::abs(bend), field.max_bend() * 1.05 + 1e-9);
  }
}

TEST_F(KnifeField, SlopeBlocksBoundTheChangeAlongEveryWay) {
  const SlopeBlocks slopes(tool_.grid, tool_.distance_m);
  Random random(11);
  double closest = 1;
  for (int n = 0; n < 50000; ++n) {
    const Vec3 from = random.vector(Vec3::Constant(3), end_ - Vec3::Constant(3)),
               along = random.vector(SlopeBlocks::kAround);
    const double before = at(from).distance_m;
    double least = 0;
    for (int i = 1; i <= 20; ++i) least = std::min(least, at(from + i / 20.0 * along).distance_m - before);
    const double bound = slopes.min_change_m(from, along);
    ASSERT_LE(bound, least + 1e-9);
    closest = std::min(closest, least - bound);
  }
  EXPECT_LT(closest, 1e-7);  // the bound is reached on the flat sides of the blade
}

TEST_F(KnifeField, SlopeBlocksGiveNoBoundForLongPathsAndPositionsOutside) {
  const SlopeBlocks slopes(tool_.grid, tool_.distance_m);
  const Vec3 middle(10, 10, 10);
  EXPECT_GT(slopes.min_change_m(middle, {2, -2, 2}), -1);
  EXPECT_LT(slopes.min_change_m(middle, {2.1, 0, 0}), -1);
  EXPECT_LT(slopes.min_change_m({-0.1, 10, 10}, {0, 0, 0}), -1);
  EXPECT_LT(slopes.min_change_m({10, 10, end_.z()}, {0, 0, 0}), -1);
  EXPECT_LT(slopes.min_change_m(Vec3::Constant(std::nan("")), {0, 0, 0}), -1);
}

}  // namespace
}  // namespace remote_touch::distance_field_test
