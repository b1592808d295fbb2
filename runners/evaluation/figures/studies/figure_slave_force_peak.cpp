// The largest force on a slave that approaches a surface and presses: over its bandwidth, the delay, and what
// the hand feels.
#include <cmath>
#include <numbers>

#include "analysis/theory/haptic_loops.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/tool_and_slave_measures.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/slave_tasks.h"

namespace remote_touch {

namespace {

struct Felt {
  const char *name, *title, *feedback;
  double region_m;
};
constexpr Felt kFelt[] = {{"rendered", "Rendered force", "rendered", 0},
                          {"region", "Rendered force, region of 5 mm", "rendered", 0.005},
                          {"none", "No force", "none", 0},
                          {"slave_force", "Force of the slave", "slave-force", 0}};
constexpr std::size_t kRendered = 0, kRegion = 1, kNone = 2, kSlaveForce = 3;

constexpr double kHitFrom_m = 0.1;
constexpr double kHitFrequencies_hz[] = {1, 2, 4, 8, 16};

struct SlavePress {
  double frequency_hz;
  std::vector<double> peaks_N = {};  // over kLinkDelays_s
  double derived_N = 0;
};

// Returns how the slave reaches the surface. The force of the slave does not change the commands before the
// slave touches, so the impact is that without a force.
std::optional<Impact> impact_of(const Felt& felt, double frequency_hz) {
  const bool stops = felt.feedback == std::string("rendered");
  const double end_m = stops ? stopped_height_m(felt.region_m) : kApproachTo_m;
  return first_impact({kApproach_m_per_s, kHitFrom_m - end_m, end_m - kSlaveRadius_m, frequency_hz});
}

// Without a force on the hand the drive pushes with at most its spring at the end of the path and its damper
// while the command still moves. A rendered command waits at the surface; the ball between four points lies a
// little below it. With the force of the slave the result is that of the first impact without a push.
double derived_N(const Felt& felt, double frequency_hz) {
  const std::optional<Impact> touch = impact_of(felt, frequency_hz);
  if (!touch) return 0;
  const double w = 2 * std::numbers::pi * frequency_hz, spring = kSlaveMass_kg * w * w;
  double push_N = 0;
  if (felt.feedback == std::string("none"))
    push_N = spring * (kSlaveRadius_m - kApproachTo_m) + 2 * kSlaveMass_kg * w * kApproach_m_per_s;
  if (felt.feedback == std::string("rendered") && felt.region_m == 0)
    push_N = spring * (kSlaveRadius_m - stopped_height_m(0));
  return impact_force_N(push_N, kSlaveStiffness_N_per_m, kSlaveMass_kg, touch->speed_m_per_s);
}

std::vector<std::vector<SlavePress>> presses(FigureContext& context) {
  std::vector<Experiment> runs;
  for (const Felt& felt : kFelt)
    for (const double frequency_hz : kHitFrequencies_hz)
      for (const double delay_s : kLinkDelays_s)
        runs.push_back(
            approach_task({frequency_hz, delay_s, felt.feedback, felt.region_m}, kHitFrom_m, true));
  const std::vector<double> peaks_N = context.measure(runs, max_slave_force_N);
  auto next = peaks_N.begin();
  std::vector<std::vector<SlavePress>> all;
  for (const Felt& felt : kFelt) {
    all.emplace_back();
    for (const double frequency_hz : kHitFrequencies_hz) {
      all.back().push_back(
          {frequency_hz, {next, next + std::size(kLinkDelays_s)}, derived_N(felt, frequency_hz)});
      next += std::size(kLinkDelays_s);
    }
  }
  return all;
}

std::string milliseconds(double time_s) {
  return std::to_string(std::lround(1000 * time_s));
}

Panel press_panel(Figure& figure, const Felt& felt, const std::vector<SlavePress>& list) {
  Table table = table_over<SlavePress>(
      felt.name, felt.title, list,
      {{"frequency", "Hz", "natural frequency of the slave",
        [](const SlavePress& p) { return p.frequency_hz; }},
       {"derived", "N", "derived force", [](const SlavePress& p) { return p.derived_N; }}});
  const bool is_bound = felt.feedback != std::string("slave-force");
  Panel panel{felt.title, "natural frequency (Hz)", "largest force (N)"};
  panel.curves.push_back({felt.name, "frequency", "derived", CurveStyle::dashed,
                          is_bound ? "bound of the impact" : "first impact, derived"});
  for (std::size_t k = 0; k < std::size(kLinkDelays_s); ++k) {
    const std::string name = "delay_" + milliseconds(kLinkDelays_s[k]) + "_ms";
    add_columns<SlavePress>(
        table, list,
        {{name, "N", "largest force on the slave", [k](const SlavePress& p) { return p.peaks_N[k]; }}});
    panel.curves.push_back(
        {felt.name, "frequency", name, CurveStyle::dots, milliseconds(kLinkDelays_s[k]) + " ms"});
  }
  figure.tables.push_back(table);
  return panel;
}

// Returns the peaks as fractions of the derived forces, for delays of from_s and more.
std::vector<double> ratios(const std::vector<SlavePress>& list, double from_s) {
  std::vector<double> all;
  for (const SlavePress& press : list)
    for (std::size_t k = 0; k < std::size(kLinkDelays_s); ++k)
      if (kLinkDelays_s[k] >= from_s && press.derived_N > 0)
        all.push_back(press.peaks_N[k] / press.derived_N);
  return all;
}

// Returns the smallest of the peaks as fractions of the derived forces.
double smallest_ratio(const std::vector<std::vector<SlavePress>>& all) {
  std::vector<double> smallest;
  for (const std::vector<SlavePress>& list : all) smallest.push_back(min_of(ratios(list, 0)));
  return min_of(smallest);
}

double largest_without_touch_N(const std::vector<SlavePress>& list) {
  std::vector<double> peaks_N;
  for (const SlavePress& press : list)
    if (press.derived_N == 0) peaks_N.insert(peaks_N.end(), press.peaks_N.begin(), press.peaks_N.end());
  return max_of(peaks_N);
}

double largest_change_with_delay_N(const std::vector<std::vector<SlavePress>>& all) {
  std::vector<double> changes_N;
  for (const std::size_t felt : {kRendered, kRegion, kNone})
    for (const SlavePress& press : all[felt])
      changes_N.push_back(max_of(press.peaks_N) - min_of(press.peaks_N));
  return max_of(changes_N);
}

}  // namespace

Figure figure_slave_force_peak(FigureContext& context) {
  Figure figure{
      "slave-force-peak", "How hard a slave hits a surface at rest",
      "A hand approaches a plane at 0.2 m/s and presses 20 mm below it; a slave of 2 kg follows. The dots "
      "show the largest force of the scene on the slave over its natural frequency, for several delays in "
      "each direction. The dashed line is F + (F^2 + K m v^2)^(1/2), with the derived speed v of the slave "
      "at the surface and the largest force F of its drive; F is 0 behind a region and with the force of "
      "the slave. There is no noise. Simulated."};
  figure.source = "the theory of a linear slave";
  const std::vector<std::vector<SlavePress>> all = presses(context);
  for (std::size_t i = 0; i < std::size(kFelt); ++i)
    figure.panels.push_back(press_panel(figure, kFelt[i], all[i]));
  place_in_rows(figure, 2);
  const Claims claims(figure, "a slave that hits a plane: ");
  claims.at_most(
      "without a force on the hand no impact is harder than F + (F^2 + K m v^2)^(1/2): largest ratio",
      max_of(ratios(all[kNone], 0)), 1, "1");
  claims.at_most("with the rendered force no impact is harder than that of the derived speed: largest ratio",
                 max_of(ratios(all[kRendered], 0)), 1.02, "1");
  claims.at_most("behind a region of 5 mm no impact is harder than that of the derived speed: largest ratio",
                 max_of(ratios(all[kRegion], 0)), 1.02, "1");
  claims.at_least("a slave that is derived to touch hits the plane: smallest ratio to the derived force",
                  smallest_ratio(all), 0.25, "1");
  claims.at_most(
      "a region keeps a slave from touching if its derived overshoot is smaller than the radius of the "
      "region: largest force",
      largest_without_touch_N(all[kRegion]), 0, "N");
  claims.at_most(
      "a delay does not change the impact on a plane at rest unless the hand feels the force of the slave: "
      "largest change of the force",
      largest_change_with_delay_N(all), 0.5, "N");
  claims.at_least(
      "the force of the slave comes too late to soften the first impact, from 50 ms in each direction on: "
      "smallest ratio to v (K m)^(1/2)",
      min_of(ratios(all[kSlaveForce], 0.05)), 0.9, "1");
  return figure;
}

}  // namespace remote_touch
