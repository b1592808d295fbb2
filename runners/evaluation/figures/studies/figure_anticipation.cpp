// The time by which the hand feels a contact before the slave touches.
#include <cmath>
#include <limits>

#include "analysis/theory/haptic_loops.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/tool_and_slave_measures.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/slave_tasks.h"

namespace remote_touch {

namespace {

constexpr double kWarnedFrom_m = 0.04;
constexpr const char* kFeedbacks[] = {"rendered", "slave-force"};

struct Warning {
  double delay_s, measured_s, derived_s;
};

// The rendered force begins when the HIP reaches the surface, r_c after the proxy has. The commands arrive
// delay_s late, and the slave is behind them. The force of the slave arrives delay_s after its touch.
double derived_s(const RemoteSide& remote) {
  if (remote.feedback == "slave-force") return -remote.delay_s;
  const double end_m = stopped_height_m(remote.region_m);
  const std::optional<Impact> touch =
      first_impact({kApproach_m_per_s, kWarnedFrom_m - end_m, end_m - kSlaveRadius_m, remote.frequency_hz});
  if (!touch) return std::numeric_limits<double>::quiet_NaN();
  return touch->time_s + remote.delay_s - kWarnedFrom_m / kApproach_m_per_s;
}

std::string table_name(const std::string& feedback, double frequency_hz) {
  const std::string hz = std::to_string(std::lround(frequency_hz)) + "_hz";
  return feedback == "rendered" ? "rendered_" + hz : "slave_force_" + hz;
}

struct Warnings {
  std::string feedback;
  double frequency_hz;
  std::vector<Warning> over_delay;
};

std::vector<Warnings> all_warnings(FigureContext& context) {
  std::vector<Warnings> all;
  std::vector<Experiment> runs;
  for (const char* feedback : kFeedbacks)
    for (const double frequency_hz : kSlaveFrequencies_hz) {
      all.push_back({feedback, frequency_hz, {}});
      for (const double delay_s : kLinkDelays_s) {
        const RemoteSide remote{frequency_hz, delay_s, feedback};
        all.back().over_delay.push_back({delay_s, 0, derived_s(remote)});
        runs.push_back(approach_task(remote, kWarnedFrom_m, false));
      }
    }
  const std::vector<double> measured_s = context.measure(runs, slave_anticipation_s);
  auto next = measured_s.begin();
  for (Warnings& warnings : all)
    for (Warning& warning : warnings.over_delay) warning.measured_s = *next++;
  return all;
}

Panel warning_panel(Figure& figure, const std::vector<Warnings>& all, const std::string& feedback,
                    const std::string& title) {
  Panel panel{title, "delay in each direction (s)", "anticipation (s)"};
  for (const Warnings& warnings : all) {
    if (warnings.feedback != feedback) continue;
    const std::string name = table_name(feedback, warnings.frequency_hz);
    const std::string hz = std::to_string(std::lround(warnings.frequency_hz)) + " Hz";
    figure.tables.push_back(table_over<Warning>(
        name, title + ", " + hz, warnings.over_delay,
        {{"delay", "s", "delay of commands and forces", [](const Warning& w) { return w.delay_s; }},
         {"measured", "s", "time from the force on the hand to that on the slave",
          [](const Warning& w) { return w.measured_s; }},
         {"derived", "s", "derived time", [](const Warning& w) { return w.derived_s; }}}));
    panel.curves.push_back({name, "delay", "derived", CurveStyle::line, hz + ", derived"});
    panel.curves.push_back({name, "delay", "measured", CurveStyle::dots, hz});
  }
  return panel;
}

double largest_error_s(const std::vector<Warnings>& all, const std::string& feedback) {
  std::vector<double> errors_s;
  for (const Warnings& warnings : all)
    if (warnings.feedback == feedback)
      for (const Warning& w : warnings.over_delay) errors_s.push_back(std::abs(w.measured_s - w.derived_s));
  return max_of(errors_s);
}

}  // namespace

Figure figure_anticipation(FigureContext& context) {
  Figure figure{
      "anticipation", "The time by which the hand feels a contact before the slave touches",
      "A hand on a path approaches a plane at 0.2 m/s, from 40 mm above it. The panels show the time from "
      "the first force on the hand to the first force on the slave, over the delay in each direction, for "
      "slaves of several natural frequencies: measured (dots), and derived from delay, response of the slave "
      "and r_c / v (lines). If it is negative, the hand feels the contact after the slave. There is no noise "
      "and no region. Simulated."};
  figure.source = "the theory of a linear slave";
  const std::vector<Warnings> all = all_warnings(context);
  figure.panels = {warning_panel(figure, all, "rendered", "Rendered force"),
                   warning_panel(figure, all, "slave-force", "Force of the slave")};
  place_in_rows(figure, 2);
  const Claims claims(figure, "a slave that approaches a plane: ");
  // A tick for each of the two first forces, and one in which the command moves the slave.
  claims.at_most(
      "the rendered force comes before the touch by the delay of the commands and the lag of the slave, "
      "less r_c / v: largest difference",
      largest_error_s(all, "rendered"), 0.003, "s");
  claims.at_most(
      "the force of the slave comes after the touch by the delay of the forces: largest difference",
      largest_error_s(all, "slave-force"), 0.003, "s");
  return figure;
}

}  // namespace remote_touch
