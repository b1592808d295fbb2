// Fig 7.5 for other stiffnesses of guidance, with six motors and with five: where the hand is led.

#include "analysis/measures/interval_estimates.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

// Results at the end of the task for one device, one entry for each stiffness of guidance.
struct GuidedEnds {
  std::string name, label;
  std::vector<double> stiffness_N_per_m, error_mm, error_deg, clearance_mm;
};

std::vector<GuidedEnds> guided_ends(const SweepResult& result) {
  std::vector<GuidedEnds> list = {{"six_motors", "six motors", {}, {}, {}, {}},
                                  {"five_motors", "no motor about x", {}, {}, {}, {}}};
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const std::vector<std::size_t> indices = result.axis_indices(result.cell_of(run));
    GuidedEnds& one = list[indices[1]];  // the axis is torque_x: true, false
    one.stiffness_N_per_m.push_back(axis_values(result, 0)[indices[0]]);
    one.error_mm.push_back(1e3 * result.measure("guidance_error")[run]);
    one.error_deg.push_back(result.measure("guidance_error_angle")[run] / kRadiansPerDegree);
    one.clearance_mm.push_back(1e3 * result.measure("min_clearance")[run]);
  }
  return list;
}

Table guided_table(const GuidedEnds& one) {
  Table table{one.name, "end of the task, " + one.label};
  table.add("stiffness", "N/m", "stiffness of guidance", one.stiffness_N_per_m);
  table.add("error", "mm", "distance of the tool from the goal at the end", one.error_mm);
  table.add("angle", "deg", "angle between tool and goal at the end", one.error_deg);
  table.add("clearance", "mm", "minimum gap between the tool and a region", one.clearance_mm);
  return table;
}

Panel guided_panel(const std::string& title, const std::string& column, const std::string& y_label,
                   const std::vector<GuidedEnds>& list) {
  Panel panel{title, "stiffness of guidance (N/m)", y_label};
  for (const GuidedEnds& one : list)
    panel.curves.push_back({one.name, "stiffness", column,
                            one.name == "five_motors" ? CurveStyle::dashed : CurveStyle::line, one.label});
  return panel;
}

}  // namespace

Figure figure_7_5_guidance(FigureContext& context) {
  const std::vector<GuidedEnds> list = guided_ends(context.sweep(Sweep::load("fig7.5-guidance")));
  const GuidedEnds &six = list[0], &five = list[1];
  Figure figure{
      "7.5-guidance", "Where guidance leads the hand",
      "The task of Fig 7.5 with guidance of 50 to 300 N/m, frames at 10 Hz, a device with six motors and "
      "one without torque about x; simulated. The operator has relaxed at 3.3 s. The position is reached in "
      "both cases. Without the motor an error of the angle remains at every stiffness of guidance."};
  figure.tables = {guided_table(six), guided_table(five)};
  figure.panels = {guided_panel("Distance from the goal", "error", "distance (mm)", list),
                   guided_panel("Angle to the goal", "angle", "angle (deg)", list)};
  const Claims claims(figure);
  claims.at_most("the hand arrives at the goal in all runs: largest distance at the end",
                 max_or_nan(max_of(six.error_mm), max_of(five.error_mm)), 2, "mm");
  claims.at_most("six motors: the tool turns to the goal: largest angle to it at the end",
                 max_of(six.error_deg), 0.1, "deg");
  claims.at_least("five motors: the tool stays turned away from the goal: smallest angle to it at the end",
                  min_of(five.error_deg), 20, "deg");
  claims.at_most(
      "five motors: the final angle to the goal hardly depends on the stiffness of guidance: largest "
      "difference",
      max_of(five.error_deg) - min_of(five.error_deg), 1, "deg");
  claims.at_least("the tool stays out of the forbidden region: smallest gap of all ticks",
                  min_or_nan(min_of(six.clearance_mm), min_of(five.clearance_mm)), -0.1, "mm");
  return figure;
}

}  // namespace remote_touch
