// Fig 5.5: the region around a single point.
#include <algorithm>
#include <cmath>

#include "analysis/measures/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

constexpr double kFixtureRadius_m = 0.1, kBoundary_m = 0.105;
constexpr double kStiffness_N_per_m = 600;
constexpr double kShell_5_5_m = 1e-5;  // r_2 - r_c: a proxy in contact may rest anywhere in this shell

// The point is the origin, so distances to it are lengths. Both radii are columns, to be drawn as lines.
Table distances(const Trace& t) {
  TableRows rows;
  for (std::size_t i = 0; i < t.length(); ++i)
    rows.push_back({t.time_s[i], t.proxy_position_m[i].norm(), t.hip_position_m[i].norm(),
                    t.force_N[i].norm(), kFixtureRadius_m, kBoundary_m});
  return table_of("distances", "distances to the point, and the force",
                  {{"time", "s", "simulated time"},
                   {"proxy", "m", "distance of the proxy's centre to the point"},
                   {"hip", "m", "distance of the HIP to the point"},
                   {"force", "N", "magnitude of the force"},
                   {"radius", "m", "r_f"},
                   {"boundary", "m", "r_f + r_c"}},
                  rows);
}

double entrenched_ticks(const Trace& trace) {
  return static_cast<double>(std::count(trace.state.begin(), trace.state.end(),
                                        static_cast<std::int32_t>(ContactState::entrenched)));
}

// Returns the largest distance between proxy and HIP over the ticks in which the HIP is outside the region;
// NaN if it never is.
double max_gap_outside(const Trace& trace) {
  return max_where(
      trace.length(), [&](std::size_t i) { return trace.hip_position_m[i].norm() > kBoundary_m; },
      [&](std::size_t i) { return (trace.proxy_position_m[i] - trace.hip_position_m[i]).norm(); });
}

// Returns the largest difference between the force and k_s times the depth of the HIP in the region, over the
// ticks in which the HIP is inside; NaN if it never is. The depth is the distance from the HIP to the contact
// point of a proxy that rests where the region is nearest to the HIP.
double max_force_error(const Trace& trace) {
  const auto depth_m = [&](std::size_t i) { return kFixtureRadius_m - trace.hip_position_m[i].norm(); };
  return max_where(
      trace.length(), [&](std::size_t i) { return !(depth_m(i) <= 0); },
      [&](std::size_t i) { return std::abs(trace.force_N[i].norm() - kStiffness_N_per_m * depth_m(i)); });
}

}  // namespace

Figure figure_5_5(FigureContext& context) {
  const Trace trace = context.run(Experiment::load("fig5.5"));
  Figure figure{"5.5", "Single point virtual fixture",
                "One point at the origin with r_f = 100 mm. The HIP passes through its region, leaves it and "
                "crosses its rim. The proxy's centre stays r_f + r_c away; the force is k_s times the depth "
                "of the HIP in the region."};
  figure.tables = {distances(trace)};
  figure.panels = {
      plot("Distance to the point", "time (s)", "distance (m)",
           {{"distances", "time", "boundary", CurveStyle::dashed, "r_f + r_c"},
            {"distances", "time", "radius", CurveStyle::dashed, "boundary of the region, r_f"},
            {"distances", "time", "hip", CurveStyle::dashed, "HIP"},
            {"distances", "time", "proxy", CurveStyle::line, "proxy"}}),
      plot("Force", "time (s)", "force (N)", {{"distances", "time", "force", CurveStyle::line, ""}})};
  const Claims claims(figure);
  claims.between(
      "the proxy stays out of the region around the point: smallest distance of its centre to the point",
      min_of(numbers(figure.tables[0], "proxy")), kBoundary_m - 1e-6, kBoundary_m + 1e-6, "m", ">= 0.105");
  claims.at_most("no tick ends with the proxy entrenched: ticks that do", entrenched_ticks(trace), 0,
                 "ticks");
  claims.at_most("the proxy is at the HIP while the HIP is outside the region: largest distance",
                 max_gap_outside(trace), kShell_5_5_m, "m", "0");
  claims.at_most("the force is k_s times the depth of the HIP in the region: largest difference",
                 max_force_error(trace), kStiffness_N_per_m * kShell_5_5_m, "N");
  Claims(figure, "", &Claim::set_up)
      .at_most("the HIP enters the region: its smallest distance to the point",
               min_of(numbers(figure.tables[0], "hip")), kBoundary_m, "m");
  return figure;
}

}  // namespace remote_touch
