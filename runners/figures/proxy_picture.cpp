#include "runners/figures/proxy_picture.h"

#include "core/tool/mesh/generated_tools.h"
#include "runners/figures/fixture_run.h"
#include "runners/figures/tools/tool_picture.h"

namespace remote_touch {

namespace {

constexpr double kHipRadius_m = 0.002, kPin_m = 0.02, kBar_m = 0.0006;
constexpr std::uint32_t kProxyColour = 0x0072B2, kHipColour = 0xE69F00, kNormalColour = 0x009E73,
                        kForceColour = 0xD55E00;

TriangleMesh ball_of(double radius_m) {
  TriangleMesh mesh = find_generated_tool("ball")->make();
  for (Vec3& p : mesh.vertices) p *= radius_m / p.norm();
  return mesh;
}

// A bar along z from the origin on.
TriangleMesh bar_of(double length_m) {
  return box_mesh({kBar_m, kBar_m, length_m}, {0, 0, 0.5 * length_m});
}

Table pose_rows(const std::string& name, const Trace& trace, std::size_t tick) {
  const Vec3 &proxy_W = trace.proxy_position_m[tick], &hip_W = trace.hip_position_m[tick];
  const auto row = [](const Vec3& p, const Vec3& direction) {
    const auto q = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), direction);
    return std::vector<double>{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  };
  return table_of(name, "of proxy, HIP, normal and force",
                  {{"x", "m", "x of its begin or centre"},
                   {"y", "m", "y of its begin or centre"},
                   {"z", "m", "z of its begin or centre"},
                   {"qw", "1", "orientation"},
                   {"qx", "1", "orientation"},
                   {"qy", "1", "orientation"},
                   {"qz", "1", "orientation"}},
                  {row(proxy_W, Vec3::UnitZ()), row(hip_W, Vec3::UnitZ()), row(proxy_W, trace.normal[tick]),
                   row(hip_W, trace.force_N[tick])});
}

}  // namespace

void add_proxy_tables(Figure& figure, const std::string& name, const PointCloud& cloud,
                      const std::vector<std::size_t>& chosen, const Trace& trace, std::size_t tick,
                      double force_m_per_N) {
  const TriangleMesh proxy = ball_of(kContactRadius_m), pin = bar_of(kPin_m);
  const auto add = [&](Table table) { figure.tables.push_back(std::move(table)); };
  add(cloud_table(name + "_cloud", "points around the proxy", cloud, chosen));
  add(vertex_table(name + "_proxy", proxy));
  add(vertex_table(name + "_hip", ball_of(kHipRadius_m)));
  add(triangle_table(name + "_ball_triangles", proxy));
  add(vertex_table(name + "_normal", pin));
  add(vertex_table(name + "_force", bar_of(force_m_per_N * trace.force_N[tick].norm())));
  add(triangle_table(name + "_bar_triangles", pin));
  add(pose_rows(name + "_poses", trace, tick));
}

std::vector<ScenePart> proxy_in_cloud(const std::string& name, double point_m) {
  ScenePart cloud{ScenePart::Kind::points, name + "_cloud", 0x9A9A9A, point_m};
  const auto solid = [&](const char* what, const char* triangles, int row, std::uint32_t colour) {
    ScenePart part{ScenePart::Kind::solid, name + "_" + what, colour};
    part.triangles = name + triangles, part.poses = name + "_poses", part.pose_row = row,
    part.label = what == std::string("hip") ? "HIP" : what;
    return part;
  };
  return {cloud, solid("proxy", "_ball_triangles", 0, kProxyColour),
          solid("hip", "_ball_triangles", 1, kHipColour), solid("normal", "_bar_triangles", 2, kNormalColour),
          solid("force", "_bar_triangles", 3, kForceColour)};
}

std::vector<std::size_t> points_near(const PointCloud& cloud, const Vec3& place_W, const Vec3& reach_m) {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.is_measured(i) && ((cloud.point(i) - place_W).cwiseAbs().array() <= reach_m.array()).all())
      near.push_back(i);
  return near;
}

}  // namespace remote_touch
