// Fig 4.10: the proxy on a flat grid, and the HIP below it.
#include <cmath>

#include "runners/figures/proxy_picture.h"
#include "runners/figures/tools/tool_picture.h"

namespace remote_touch {

namespace {

constexpr double kInstant_4_10_s = 2.5;  // in the middle of the phase below the points
constexpr double kShell_4_10_m = 1e-5;   // r_2 - r_c of Table 4.2
constexpr double kSpring_4_10_N_per_m = 600;

}  // namespace

Figure figure_4_10(const FigureContext& context) {
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
  // In the middle between four points a ball that touches them is deepest.
  const double spacing_m = (cloud.point(1) - cloud.point(0)).norm();
  const double sinks_m =
      kContactRadius_m - std::sqrt(kContactRadius_m * kContactRadius_m - spacing_m * spacing_m / 2);
  const double spring_m = (proxy_W - hip_W).norm() - kContactRadius_m;
  figure.claims = {
      claim_between("4.10", "height of the proxy's centre over the points",
                    "r_c = 0.005, or less between the points", proxy_W.y(),
                    kContactRadius_m - sinks_m - kShell_4_10_m, kContactRadius_m + kShell_4_10_m, "m"),
      claim_between("4.10", "force, against k_s (distance of HIP and proxy - r_c)", "(4.15), (4.16)",
                    trace.force_N[tick].norm() / (kSpring_4_10_N_per_m * spring_m), 1 - 1e-9, 1 + 1e-9, "1"),
  };
  return figure;
}

}  // namespace remote_touch
