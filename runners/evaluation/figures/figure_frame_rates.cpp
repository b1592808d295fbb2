// (4.14) at other frame rates than the printed one: the critical acceleration grows with the square of the
// rate.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runners/evaluation/figures/pop_through_map.h"

namespace remote_touch {

namespace {

const std::string kRatesFigure = "frame-rates";

// The accelerations between which lifts begin to pop through, at one frame rate.
struct Threshold {
  double frame_rate_hz = 0;
  double survives = 0, pops = std::numeric_limits<double>::infinity();  // m/s^2
  int out_of_order = 0;  // lifts that survived above an acceleration at which one popped through

  double critical() const { return std::sqrt(survives * pops); }
  // (4.14)
  double bound() const { return critical_acceleration({kLift.r1_m, frame_rate_hz, 0}); }
};

std::vector<Threshold> thresholds(const SweepResult& lifts) {
  const auto& rates = std::get<std::vector<double>>(lifts.axes[0].values);
  const auto& accelerations = std::get<std::vector<double>>(lifts.axes[1].values);
  const std::vector<double>& popped = lifts.measure("popped_through");
  std::vector<Threshold> list;
  for (std::size_t rate = 0; rate < rates.size(); ++rate) {
    Threshold& threshold = list.emplace_back(Threshold{rates[rate]});
    for (std::size_t i = 0; i < accelerations.size(); ++i) {
      const bool pops = popped[lifts.run(lifts.cell_at({rate, i}), 0)] > 0.5;
      if (pops) threshold.pops = std::min(threshold.pops, accelerations[i]);
      if (!pops && threshold.pops < accelerations[i]) ++threshold.out_of_order;
      if (!pops && threshold.pops > accelerations[i]) threshold.survives = accelerations[i];
    }
  }
  return list;
}

Table threshold_table(const std::vector<Threshold>& list) {
  std::vector<double> rate, survives, pops, bound;
  for (const Threshold& threshold : list) {
    rate.push_back(threshold.frame_rate_hz), bound.push_back(threshold.bound());
    survives.push_back(threshold.survives), pops.push_back(threshold.pops);
  }
  Table table{"critical", "critical acceleration without noise, by frame rate"};
  table.add("frame_rate", "Hz", "f_c", rate);
  table.add("survives", "m/s^2", "largest acceleration below which no lift popped through", survives);
  table.add("pops", "m/s^2", "smallest acceleration with pop-through", pops);
  table.add("bound", "m/s^2", "r_1 f_c^2 (4.14)", bound);
  return table;
}

// Returns the bound over the frame rate, for a curve.
Table curve_table() {
  std::vector<double> rate, bound;
  for (int hz = 10; hz <= 70; ++hz)
    rate.push_back(hz), bound.push_back(critical_acceleration({kLift.r1_m, rate.back(), 0}));
  Table table{"bound", "(4.14)"};
  table.add("frame_rate", "Hz", "f_c", rate);
  table.add("bound", "m/s^2", "r_1 f_c^2", bound);
  return table;
}

// The range of 3 % has two reasons: the proxy sinks up to 0.113 mm between four points, and the axis has
// steps of 1 %. See figure "bounds".
std::vector<Claim> rate_claims(const std::vector<Threshold>& list) {
  std::vector<Claim> claims;
  int out_of_order = 0;
  for (const Threshold& threshold : list) {
    const std::string rate = std::to_string(static_cast<int>(threshold.frame_rate_hz));
    claims.push_back(claim_between(
        kRatesFigure,
        "critical acceleration without noise at " + rate + " frames per second, in units of r_1 f_c^2",
        "1 (4.14)", threshold.critical() / threshold.bound(), 0.97, 1.03, "1"));
    out_of_order += threshold.out_of_order;
  }
  claims.push_back(claim_at_most(kRatesFigure, "lifts that survived above their critical acceleration", "-",
                                 out_of_order, 0, "lifts"));
  return claims;
}

}  // namespace

Figure figure_frame_rates(const FigureContext& context) {
  const std::vector<Threshold> list = thresholds(context.sweep(Sweep::load("frame-rates")));
  const Panel panel{"Critical acceleration",
                    "frame rate (Hz)",
                    "acceleration (m/s^2)",
                    false,
                    {{"bound", "frame_rate", "bound", CurveStyle::line, "r_1 f_c^2 (4.14)"},
                     {"critical", "frame_rate", "survives", CurveStyle::dots, "no pop-through up to here"},
                     {"critical", "frame_rate", "pops", CurveStyle::dots, "pop-through"}}};
  return {
      kRatesFigure,
      "Pop-through at other frame rates",
      "The same motion without noise, seen at 15, 30 and 60 frames per second: up to which acceleration the "
      "proxy stays on the surface. Rise at 0.05 m/s, acceleration for a third of a second; simulated.",
      {threshold_table(list), curve_table()},
      {panel},
      rate_claims(list)};
}

}  // namespace remote_touch
