// Fig 4.11: the HIP moves above, below and above a flat grid.
#include <cmath>

#include "analysis/measures/contact_measures.h"
#include "analysis/measures/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

constexpr double kShell_m = 1e-5;

// First tick in which the HIP is below the surface.
std::size_t jump_tick(const Trace& trace) {
  std::size_t i = 0;
  while (i + 1 < trace.length() && trace.hip_position_m[i].y() >= 0) ++i;
  return i;
}

Table heights(const Trace& t) {
  TableRows rows;
  for (std::size_t i = 0; i < t.length(); ++i)
    rows.push_back({t.time_s[i], t.hip_position_m[i].y(), t.proxy_position_m[i].y()});
  return table_of("heights", "height of HIP and proxy",
                  {{"time", "s", "simulated time"},
                   {"hip_y", "m", "height of the HIP"},
                   {"proxy_y", "m", "height of the proxy's centre"}},
                  rows);
}

// The contact point while the HIP presses, from the first tick after the jump.
Table contact_heights(const Trace& trace) {
  TableRows rows;
  for (std::size_t i = jump_tick(trace) + 1; i < trace.length(); ++i)
    if (pressing(trace, i, kContactRadius_m))
      rows.push_back({trace.time_s[i], contact_point(trace, i, kContactRadius_m).y()});
  return table_of("contact", "height of the contact point",
                  {{"time", "s", "simulated time"}, {"contact_y", "m", "height of the contact point"}}, rows);
}

double peak_to_peak(const std::vector<double>& values) {
  return max_of(values) - min_of(values);
}

// Number of steps from the jump until the proxy is within the contact shell, in a run with one step per tick.
double steps_to_contact(const Trace& single) {
  const std::size_t jump = jump_tick(single);
  std::size_t i = jump;
  while (i < single.length() && !(std::abs(single.nearest_distance_m[i] - kContactRadius_m) <= kShell_m)) ++i;
  return static_cast<double>(i - jump + 1);
}

}  // namespace

Figure figure_4_11(FigureContext& context) {
  const Trace trace = context.run(Experiment::load("fig4.11"));
  // A budget of one step per tick shows, in the tick of the jump, where the first step leads.
  const Trace single = context.run(Experiment::load("fig4.11", {"renderer.steps_per_tick=1"}));
  const std::size_t jump = jump_tick(trace);

  Figure figure{
      "4.11", "Flat point cloud",
      "A flat 100 x 100 grid. The HIP moves at 2 r_c per second along the plane, for 1 s above it, 3 s "
      "below and 1 s above. Bottom: the contact point sinks a little between the points."};
  figure.tables = {heights(trace), contact_heights(trace)};
  figure.panels = {plot("Height of HIP and proxy", "time (s)", "y (m)",
                        {{"heights", "time", "hip_y", CurveStyle::dashed, "HIP"},
                         {"heights", "time", "proxy_y", CurveStyle::line, "proxy"}}),
                   plot("Height of the contact point", "time (s)", "y (m)",
                        {{"contact", "time", "contact_y", CurveStyle::line, ""}})};
  const Claims claims(figure);
  claims.between("the contact point ripples over the points of the flat grid: height from peak to peak",
                 peak_to_peak(numbers(figure.tables[1], "contact_y")), 4.0e-5, 5.7e-5, "m", "5e-5");
  claims.at_most(
      "the proxy reaches the surface in the tick in which the HIP jumps: its distance from contact at "
      "the end of that tick",
      std::abs(trace.nearest_distance_m[jump] - kContactRadius_m), kShell_m, "m", "0");
  claims.at_most(
      "with one step per tick the proxy reaches the surface in the tick in which the HIP jumps: its "
      "distance from contact at the end of that tick",
      std::abs(single.nearest_distance_m[jump] - kContactRadius_m), kShell_m, "m", "1 - 2 steps");
  claims.between("the proxy reaches the surface in 1 to 2 steps after the HIP jumps: number of steps",
                 steps_to_contact(single), 1, 2, "steps", "1 - 2");
  return figure;
}

}  // namespace remote_touch
