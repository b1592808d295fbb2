// Fig 5.9: the proxy keeps the distance of a forbidden region from a beating organ.
#include "runners/figures/proxy_picture.h"
#include "runners/figures/tools/tool_picture.h"

namespace remote_touch {

namespace {

constexpr double kInstant_5_9_s = 12;                  // r_f has been 0.02 m for 2 s
constexpr double kShell_5_9_m[] = {0.00499, 0.00501};  // r_1 and r_2 of Table 4.2

}  // namespace

Figure figure_5_9(const FigureContext& context) {
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
  figure.claims = {
      set_up(claim_between("5.9", "time of the picture", "-", trace.time_s[tick], kInstant_5_9_s,
                           kInstant_5_9_s, "s")),
      claim_between("5.9", "distance of the proxy's centre to the nearest point - r_f", "r_1 to r_2",
                    trace.nearest_distance_m[tick], kShell_5_9_m[0], kShell_5_9_m[1], "m"),
  };
  return figure;
}

}  // namespace remote_touch
