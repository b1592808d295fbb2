// (4.14) at other frame rates than the printed one: the critical acceleration grows with the square of the
// rate.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runners/evaluation/figures/parts/pop_through_map.h"

namespace remote_touch {

namespace {

// The accelerations between which lifts begin to pop through, at one frame rate.
struct Threshold {
  double frame_rate_hz = 0;
  double survives = 0, pops = std::numeric_limits<double>::infinity();  // m/s^2
  int out_of_order = 0;  // lifts that survived above an acceleration at which one popped through

  double critical() const { return std::sqrt(survives * pops); }
  // (4.14)
  double bound() const { return critical_acceleration({kLift.r1_m, frame_rate_hz, 0}); }
  double survives_ratio() const { return survives / bound(); }
  double pops_ratio() const { return pops / bound(); }
};

std::vector<Threshold> thresholds(const SweepResult& lifts) {
  const auto &rates = axis_values(lifts, 0), &accelerations = axis_values(lifts, 1);
  const std::vector<double>& popped = lifts.measure("popped_through");
  std::vector<Threshold> list;
  for (std::size_t rate = 0; rate < rates.size(); ++rate) {
    Threshold& threshold = list.emplace_back(Threshold{rates[rate]});
    for (std::size_t i = 0; i < accelerations.size(); ++i) {
      const double outcome = popped[lifts.run(lifts.cell_at({rate, i}), 0)];
      if (std::isnan(outcome)) threshold.pops = outcome;  // no threshold is known, so its claim fails
      const bool pops = outcome > 0.5;
      if (pops) threshold.pops = std::min(threshold.pops, accelerations[i]);
      if (!pops && threshold.pops < accelerations[i]) ++threshold.out_of_order;
      if (!pops && threshold.pops > accelerations[i]) threshold.survives = accelerations[i];
    }
  }
  return list;
}

Table threshold_table(const std::vector<Threshold>& list) {
  return table_over<Threshold>(
      "critical", "critical acceleration without noise, by frame rate", list,
      {{"frame_rate", "Hz", "f_c", &Threshold::frame_rate_hz},
       {"survives", "m/s^2", "largest acceleration below which no lift popped through", &Threshold::survives},
       {"pops", "m/s^2", "smallest acceleration with pop-through", &Threshold::pops},
       {"bound", "m/s^2", "r_1 f_c^2 (4.14)", &Threshold::bound},
       {"survives_ratio", "1", "survives, in r_1 f_c^2", &Threshold::survives_ratio},
       {"pops_ratio", "1", "pops, in r_1 f_c^2", &Threshold::pops_ratio}});
}

// Returns the bound over the frame rate, for a curve.
Table curve_table() {
  TableRows rows;
  for (int hz = 10; hz <= 70; ++hz)
    rows.push_back({static_cast<double>(hz), Threshold{static_cast<double>(hz)}.bound(), 1});
  return table_of("bound", "(4.14)",
                  {{"frame_rate", "Hz", "f_c"},
                   {"bound", "m/s^2", "r_1 f_c^2"},
                   {"ratio", "1", "r_1 f_c^2 in r_1 f_c^2"}},
                  rows);
}

// The range of 3 % has two reasons: the proxy sinks up to 0.113 mm between four points, and the axis has
// steps of 1 %. See figure "bounds".
void add_claims(Figure& figure, const std::vector<Threshold>& list) {
  const Claims claims(figure);
  int out_of_order = 0;
  for (const Threshold& threshold : list) {
    const std::string rate = std::to_string(static_cast<int>(threshold.frame_rate_hz));
    claims.between(
        "without noise the critical acceleration at " + rate + " frames per second is r_1 f_c^2: ratio",
        threshold.critical() / threshold.bound(), 0.97, 1.03, "1", "1 (4.14)");
    out_of_order += threshold.out_of_order;
  }
  claims.at_most("no lift survives above its critical acceleration: lifts that do", out_of_order, 0, "lifts");
}

}  // namespace

Figure figure_frame_rates(FigureContext& context) {
  const std::vector<Threshold> list = thresholds(context.sweep(Sweep::load("frame-rates")));
  Figure figure{
      "frame-rates", "Pop-through at other frame rates",
      "The same motion without noise, seen at 15, 30 and 60 frames per second: up to which acceleration the "
      "proxy stays on the surface. Below: the same accelerations divided by r_1 f_c^2. Rise at 0.05 m/s, "
      "acceleration for a third of a second; simulated."};
  figure.tables = {threshold_table(list), curve_table()};
  figure.panels = {
      plot("Critical acceleration", "frame rate (Hz)", "acceleration (m/s^2)",
           {{"bound", "frame_rate", "bound", CurveStyle::line, "r_1 f_c^2 (4.14)"},
            {"critical", "frame_rate", "survives", CurveStyle::dots, "no pop-through up to here"},
            {"critical", "frame_rate", "pops", CurveStyle::dots, "pop-through"}}),
      plot("Ratio to r_1 f_c^2", "frame rate (Hz)", "ratio",
           {{"bound", "frame_rate", "ratio", CurveStyle::line, "r_1 f_c^2 (4.14)"},
            {"critical", "frame_rate", "survives_ratio", CurveStyle::dots, "no pop-through up to here"},
            {"critical", "frame_rate", "pops_ratio", CurveStyle::dots, "pop-through"}},
           {.y_range = {{0.96, 1.01}}})};
  add_claims(figure, list);
  return figure;
}

}  // namespace remote_touch
