#include "core/dissertation/tool_shape/generated_tools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "tests/support/meshes.h"

namespace remote_touch::generated_tools_test {
namespace {

Vec3 sides(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  return high - low;
}

TEST(GeneratedTools, AreClosedBodiesOfOnePart) {
  for (const GeneratedTool& tool : generated_tools()) {
    const MeshCheck check = check_mesh(tool.make());
    EXPECT_TRUE(check.closed()) << tool.name << ": " << text(check);
    EXPECT_GT(check.volume_m3, 0) << tool.name;
    EXPECT_EQ(check.parts, 1) << tool.name;
    EXPECT_EQ(check.degenerate_triangles, 0) << tool.name;
    EXPECT_EQ(find_generated_tool(tool.name), &tool);
  }
  EXPECT_EQ(find_generated_tool("wolf"), nullptr);
}

TEST(GeneratedTools, HaveTheSizesThatTheirSummariesState) {
  const std::map<std::string, Vec3> mm = {
      {"ball", {20, 20, 20}},    {"bar", {80, 20, 10}},     {"block", {95, 20, 68}},
      {"fork", {126, 22, 77}},   {"husky", {95, 20, 68}},   {"key", {151, 28, 90}},
      {"slab-5", {40, 5, 40}},   {"slab-10", {40, 10, 40}}, {"slab-20", {40, 20, 40}},
      {"slab-40", {40, 40, 40}},
  };
  EXPECT_EQ(mm.size(), generated_tools().size());
  for (const GeneratedTool& tool : generated_tools()) {
    const Vec3 got = 1e3 * sides(tool.make()), expected = mm.at(tool.name);
    const bool sharp = std::string(tool.name) == "bar" || std::string(tool.name).starts_with("slab");
    EXPECT_LT((got - expected).cwiseAbs().maxCoeff(), sharp ? 1e-12 : 0.3)
        << tool.name << ": " << got.transpose();
  }
}

TEST(GeneratedTools, AreTheSameEveryTime) {
  for (const GeneratedTool& tool : generated_tools()) {
    const TriangleMesh once = tool.make(), again = tool.make();
    EXPECT_EQ(once.triangles, again.triangles) << tool.name;
    EXPECT_EQ(once.vertices, again.vertices) << tool.name;
  }
}

TEST(GeneratedTools, TheBallIsRound) {
  const TriangleMesh ball = find_generated_tool("ball")->make();
  for (const Vec3& v : ball.vertices) EXPECT_NEAR(v.norm(), 0.01, 5e-5);
  for (const auto& [a, b, c] : ball.triangles) {
    const Vec3 middle = (ball.vertices[a] + ball.vertices[b] + ball.vertices[c]) / 3;
    EXPECT_NEAR(middle.norm(), 0.01, 1e-4);
  }
}

// Returns the angle at which the tool, free to move in x and z, is stopped by the box of Fig 6.3, 110 x 90
// mm: its extent first reaches that of the box.
double stops_at_deg(const TriangleMesh& mesh, double sense) {
  for (double deg = 0; deg < 90; deg += 0.01) {
    const double angle = sense * deg * 3.14159265358979323846 / 180;
    const double c = std::cos(angle), s = std::sin(angle);
    Eigen::Matrix3d about_y;
    about_y << c, 0, s, 0, 1, 0, -s, 0, c;
    const Vec3 extent = sides(meshes::moved(mesh, about_y, Vec3::Zero()));
    if (extent.x() >= 0.110 || extent.z() >= 0.090) return deg;
  }
  return 90;
}

TEST(GeneratedTools, TheHuskyIsStoppedByTheNarrowBox) {
  const TriangleMesh husky = find_generated_tool("husky")->make();
  const double plus = stops_at_deg(husky, 1), minus = stops_at_deg(husky, -1);
  EXPECT_GE(plus, 21.2);
  EXPECT_LE(plus, 21.5);
  EXPECT_GE(minus, 21.2);
  EXPECT_LE(minus, 21.5);
}

// The angle of the bar in a slot of 40 mm: 80 sin a + 10 cos a = 40.
TEST(GeneratedTools, TheBarFitsASlotUpTo22Degrees) {
  const double a = 22.62 * 3.14159265358979323846 / 180;
  Eigen::Matrix3d about_y;
  about_y << std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a);
  const TriangleMesh bar = meshes::moved(find_generated_tool("bar")->make(), about_y, Vec3::Zero());
  EXPECT_NEAR(sides(bar).z(), 0.040, 1e-6);
}

TEST(MarchingTetrahedra, RefusesABodyThatIsCutOff) {
  const auto ball = [](const Vec3& p) { return p.norm() - 1; };
  EXPECT_TRUE(check_mesh(marching_tetrahedra(ball, Vec3::Constant(-1.2), Vec3::Constant(1.2), 0.3)).closed());
  EXPECT_THROW(marching_tetrahedra(ball, Vec3(-1.2, -0.5, -1.2), Vec3::Constant(1.2), 0.3), InputError);
}

// The function vanishes exactly at nodes. The second case is two bodies that touch in one node.
TEST(MarchingTetrahedra, MeshIsClosedIfTheFunctionVanishesAtNodes) {
  const auto diamond = [](const Vec3& p) { return p.cwiseAbs().sum() - 2; };
  const auto two = [](const Vec3& p) {
    return std::min((p - Vec3(1, 0, 0)).norm(), (p + Vec3(1, 0, 0)).norm()) - 1;
  };
  for (const std::function<double(const Vec3&)>& body :
       {std::function<double(const Vec3&)>(diamond), {two}}) {
    const MeshCheck check = check_mesh(marching_tetrahedra(body, Vec3::Constant(-4), Vec3::Constant(4), 0.5));
    EXPECT_TRUE(check.closed()) << text(check);
    EXPECT_EQ(check.degenerate_triangles, 0);
  }
}

}  // namespace
}  // namespace remote_touch::generated_tools_test
