// Fig 4.10: the proxy on a flat grid, and the HIP below it. Fig 5.9: the proxy keeps the distance of a
// forbidden region from a beating organ. Both are pictures of one tick of a run.
#include <cmath>
#include <string>
#include <vector>

#include "core/dissertation/tool/shape/generated_tools.h"
#include "core/geometry/point_cloud.h"
#include "runners/evaluation/figures/figures.h"
#include "runners/evaluation/figures/tools/figure_form.h"
#include "runners/evaluation/figures/tools/tool_picture.h"

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

// Returns a bar that starts at the origin and extends along z.
TriangleMesh bar_of(double length_m) {
  return box_mesh({kBar_m, kBar_m, length_m}, {0, 0, 0.5 * length_m});
}

Table pose_rows(const std::string& name, const Trace& trace, std::size_t tick) {
  const Vec3 &proxy_W = trace.proxy_position_m[tick], &hip_W = trace.hip_position_m[tick];
  const auto row = [](const Vec3& p, const Vec3& direction) {
    // q is the shortest rotation from z to n: scalar part 1 + z . n, vector part z x n, normalised; a half
    // turn about x for n = -z. Eigen's FromTwoVectors() takes 6 s to compile.
    const Vec3 n = direction.normalized();
    const auto q = n.z() <= -1 ? Eigen::Quaterniond(0, 1, 0, 0)
                               : Eigen::Quaterniond(1 + n.z(), -n.y(), n.x(), 0).normalized();
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

// Adds the chosen points, and a tick of a trace: the proxy as a ball of radius r_c, the HIP as a smaller
// ball, the normal as a pin in the proxy, and the force on the hand as a bar that starts at the HIP. Tables
// are NAME_cloud, NAME_proxy, NAME_hip, NAME_ball_triangles, NAME_normal, NAME_force, NAME_bar_triangles and
// NAME_poses.
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

// point_m: diameter of a point.
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

// Returns the indices of the points of a cloud in a box around a position, up to reach_m along each axis.
std::vector<std::size_t> points_near(const PointCloud& cloud, const Vec3& place_W, const Vec3& reach_m) {
  return chosen_points(cloud, [&](std::size_t i) {
    return cloud.is_measured(i) && ((cloud.point(i) - place_W).cwiseAbs().array() <= reach_m.array()).all();
  });
}

constexpr double kInstant_4_10_s = 2.5;  // middle of the phase below the points
constexpr double kShell_4_10_m = 1e-5;   // r_2 - r_c of Table 4.2
constexpr double kSpring_4_10_N_per_m = 600;

constexpr double kInstant_5_9_s = 12;                  // r_f has been 0.02 m for 2 s
constexpr double kShell_5_9_m[] = {0.00499, 0.00501};  // r_1 and r_2 of Table 4.2

}  // namespace

Figure figure_4_10(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig4.11");
  const Trace trace = context.run(experiment);
  const auto tick = static_cast<std::size_t>(kInstant_4_10_s * experiment.settings().haptic_rate_hz);
  const PointCloud cloud = experiment.build_scenario(context.kernels())->cloud(0);
  const Vec3 &proxy_W = trace.proxy_position_m[tick], &hip_W = trace.hip_position_m[tick];
  Figure figure{
      "4.10", "The proxy on a flat point cloud",
      "The run of figure 4.11 after 2.5 s: the HIP is 5 mm below the grid, the proxy, as large as r_c, "
      "on it. The pin is the estimated normal, 20 mm long; the force on the hand is 5 mm long for 1 N. "
      "Points within 3 cm of the proxy."};
  add_proxy_tables(figure, "touch", cloud, points_near(cloud, proxy_W, {0.03, 0.03, 0.03}), trace, tick,
                   0.005);
  const Scene scene{proxy_W + Vec3(0.05, 0.035, 0.075), proxy_W, Vec3::UnitY(), 0.075, 0.7,
                    proxy_in_cloud("touch", 0.0005)};
  figure.panels = {scene_panel("After 2.5 s", 0, 0, scene)};
  // A ball that touches four points is deepest in the middle between them.
  const double spacing_m = (cloud.point(1) - cloud.point(0)).norm();
  const double sinks_m =
      kContactRadius_m - std::sqrt(kContactRadius_m * kContactRadius_m - spacing_m * spacing_m / 2);
  const double spring_m = (proxy_W - hip_W).norm() - kContactRadius_m;
  const Claims claims(figure);
  claims.between("the proxy rests on the grid: height of its centre over the points", proxy_W.y(),
                 kContactRadius_m - sinks_m - kShell_4_10_m, kContactRadius_m + kShell_4_10_m, "m",
                 "r_c = 0.005, or less between the points");
  claims.between("the force is k_s (|u| - r_c), u from the proxy to the HIP: ratio of the two",
                 trace.force_N[tick].norm() / (kSpring_4_10_N_per_m * spring_m), 1 - 1e-9, 1 + 1e-9, "1",
                 "(4.15), (4.16)");
  return figure;
}

Figure figure_5_9(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig5.8", {"duration_s=12.001"});
  const Trace trace = context.run(experiment);
  const std::size_t tick = trace.length() - 1;
  const PointCloud cloud = experiment.build_scenario(context.kernels())->cloud(trace.frame_index[tick]);
  const Vec3& proxy_W = trace.proxy_position_m[tick];
  Figure figure{
      "5.9", "The proxy at the distance of a forbidden region",
      "The run of figure 5.8 after 12 s, simulated camera: the HIP is just inside the beating organ, and "
      "the proxy, a ball of radius r_c, touches the forbidden region, r_f = 0.02 m around every point. The "
      "pin is the estimated normal of the region, 20 mm long; the force on the hand is 1.5 mm long for 1 N. "
      "Points within 10 cm of the proxy."};
  add_proxy_tables(figure, "held", cloud, points_near(cloud, proxy_W, {0.1, 0.1, 0.1}), trace, tick, 0.0015);
  const Scene scene{proxy_W + Vec3(0.10, 0.06, 0.19), proxy_W - Vec3(0, 0.012, 0), Vec3::UnitY(), 0.12, 0.75,
                    proxy_in_cloud("held", 0.001)};
  figure.panels = {scene_panel("After 12 s", 0, 0, scene)};
  const Claims claims(figure);
  Claims(figure, "", &Claim::set_up)
      .between("the picture shows the chosen tick: its time", trace.time_s[tick], kInstant_5_9_s,
               kInstant_5_9_s, "s");
  claims.between(
      "the proxy stays at the boundary of the forbidden region: distance of its centre to the nearest "
      "point, minus r_f",
      trace.nearest_distance_m[tick], kShell_5_9_m[0], kShell_5_9_m[1], "m", "r_1 to r_2");
  return figure;
}

}  // namespace remote_touch
