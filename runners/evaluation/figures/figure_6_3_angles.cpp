// Fig 6.3 for other angles: how far the tool turns in the box, over the commanded angle, the spacing of the
// points and the contact rule.
#include <cmath>

#include "analysis/measures/interval_estimates.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

constexpr double kFreeDeg = 10;     // the tool does not reach the walls up to this angle
constexpr double kBlockedDeg = 30;  // the walls hold the tool from this angle on

// The runs of one rule and spacing, over the commanded angle.
struct Turning {
  std::string rule;
  double spacing_m = 0;
  std::vector<double> commanded_deg, turned_deg, penetration_m, contacts, torque_Nm, exhausted;

  std::string name() const {
    return (rule == "voxels" ? "voxels_" : "look_ahead_") + std::to_string(std::lround(1e3 * spacing_m)) +
           "mm";
  }
  // Returns the minimum and maximum rotation of the tool, over the angles from kBlockedDeg on; NaN if there
  // are none.
  std::pair<double, double> stop_deg() const {
    const auto blocked = [this](std::size_t i) { return commanded_deg[i] >= kBlockedDeg; };
    const auto turned = [this](std::size_t i) { return turned_deg[i]; };
    return {min_where(commanded_deg.size(), blocked, turned),
            max_where(commanded_deg.size(), blocked, turned)};
  }
};

std::vector<Turning> turnings(const SweepResult& result) {
  const std::vector<double>& spacings = axis_values(result, 1);
  std::vector<Turning> list;
  for (const char* rule : {"look-ahead", "voxels"})
    for (const double spacing_m : spacings) list.push_back({rule, spacing_m, {}, {}, {}, {}, {}, {}});
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const std::vector<std::size_t> indices = result.axis_indices(result.cell_of(run));
    Turning& one = list[indices[2] * spacings.size() + indices[1]];
    const double angle_deg = axis_values(result, 0)[indices[0]];
    one.commanded_deg.push_back(angle_deg);
    // The device stays at the commanded angle for as long as the tool needs; the lag is largest there.
    one.turned_deg.push_back(angle_deg - result.measure("max_tool_lag_angle")[run] / kRadiansPerDegree);
    one.penetration_m.push_back(result.measure("max_tool_penetration")[run]);
    one.contacts.push_back(result.measure("max_contact_count")[run]);
    one.torque_Nm.push_back(result.measure("max_torque")[run]);
    one.exhausted.push_back(result.measure("exhausted_fraction")[run]);
  }
  return list;
}

std::vector<double> differences(std::vector<double> values, const std::vector<double>& others) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= others.at(i);
  return values;
}

// reference: the run that the others are compared with.
Table turning_table(const Turning& run, const Turning& reference) {
  Table table{run.name(), "contact rule " + run.rule + ", points " +
                              std::to_string(std::lround(1e3 * run.spacing_m)) + " mm apart"};
  table.add("commanded", "deg", "angle to which the device is turned", run.commanded_deg);
  table.add("turned", "deg", "angle to which the tool turns at most", run.turned_deg);
  table.add("contacts", "1", "maximum number of points that touch", run.contacts);
  table.add("torque", "N m", "maximum torque", run.torque_Nm);
  table.add("penetration", "m", "maximum depth of a point in the tool at the end of a tick",
            run.penetration_m);
  table.add("turned_difference", "deg", "angle of the tool less that of look-ahead, 1 mm",
            differences(run.turned_deg, reference.turned_deg));
  table.add("torque_difference", "N m", "torque less that of look-ahead, 1 mm",
            differences(run.torque_Nm, reference.torque_Nm));
  return table;
}

Panel panel(const std::vector<Turning>& runs, const std::string& title, const std::string& column,
            const std::string& y_label) {
  Panel made{title, "commanded rotation (deg)", y_label};
  for (const Turning& run : runs)
    made.curves.push_back({run.name(), "commanded", column, CurveStyle::line,
                           run.rule + ", " + std::to_string(std::lround(1e3 * run.spacing_m)) + " mm"});
  return made;
}

// Returns the largest value(run) over the runs of a rule, or over all runs if `rule` is empty; NaN if there
// are none.
template <class Value>
double max_of_rule(const std::vector<Turning>& runs, const std::string& rule, Value&& value) {
  return max_where(
      runs.size(), [&](std::size_t i) { return rule.empty() || runs[i].rule == rule; },
      [&](std::size_t i) { return value(runs[i]); });
}

void add_claims(Figure& figure, const std::vector<Turning>& runs) {
  const auto free_lag = [](const Turning& run) {
    return max_where(
        run.commanded_deg.size(), [&](std::size_t i) { return run.commanded_deg[i] <= kFreeDeg; },
        [&](std::size_t i) { return run.commanded_deg[i] - run.turned_deg[i]; });
  };
  const auto history = [](const Turning& run) { return run.stop_deg().second - run.stop_deg().first; };
  const auto stop = [](const Turning& run) { return run.stop_deg().second; };
  const auto minus_stop = [](const Turning& run) { return -run.stop_deg().second; };
  const auto depth = [](const Turning& run) { return max_of(run.penetration_m); };
  const auto exhausted = [](const Turning& run) { return max_of(run.exhausted); };
  const Claims claims(figure);
  claims.at_most("the tool follows the device up to 10 deg: largest lag", max_of_rule(runs, "", free_lag),
                 1e-4, "deg");
  claims.at_most(
      "the tool stops at one angle, however far beyond 30 deg the device turns: largest difference",
      max_of_rule(runs, "", history), 0.1, "deg");
  claims.at_most(
      "contact rule look-ahead: the tool stops at the same angle with points 1, 2 and 3 mm apart: "
      "largest difference",
      max_of_rule(runs, "look-ahead", stop) + max_of_rule(runs, "look-ahead", minus_stop), 0.1, "deg");
  claims.at_most(
      "contact rule look-ahead: no point is in the tool at the end of a tick: depth of the deepest point",
      max_of_rule(runs, "look-ahead", depth), 1e-4, "m");
  claims.at_most(
      "contact rule voxels: no point is deeper in the tool than a voxel (0.5 mm) at the end of a tick: "
      "depth of the deepest point",
      max_of_rule(runs, "voxels", depth), 5e-4, "m");
  claims.at_most("no tick uses up its budget of detections: largest fraction of the ticks of a run",
                 max_of_rule(runs, "", exhausted), 0, "fraction");
}

}  // namespace

Figure figure_6_3_angles(FigureContext& context) {
  const std::vector<Turning> runs = turnings(context.sweep(Sweep::load("fig6.3-angles")));
  Figure figure{
      "6.3-angles", "A tool turned in a box, over angle, spacing and rule",
      "The experiment of Fig 6.3 with the device turned by 5 to 50 deg, for points 1 to 3 mm apart and both "
      "contact rules; simulated. The tool follows until its sides touch the walls, and then stays at one "
      "angle, however far the device turns: the torque grows with the remaining angle. The curves differ so "
      "little that the panels on the right show their differences from look-ahead with points 1 mm apart. "
      "The voxels rule uses points only, so its stop depends on their spacing; look-ahead treats each point "
      "as a disk. A line style is a spacing, a colour is a rule."};
  for (const Turning& run : runs) figure.tables.push_back(turning_table(run, runs.front()));
  figure.panels = {
      panel(runs, "Rotation of the tool", "turned", "tool rotation (deg)"),
      panel(runs, "Rotation less that of look-ahead, 1 mm", "turned_difference", "difference (deg)"),
      panel(runs, "Torque", "torque", "torque (N m)"),
      panel(runs, "Torque less that of look-ahead, 1 mm", "torque_difference", "difference (N m)"),
      panel(runs, "Contacts", "contacts", "touching points"),
      panel(runs, "Deepest point in the tool", "penetration", "depth (m)")};
  place_in_rows(figure, 2);
  add_claims(figure, runs);
  return figure;
}

}  // namespace remote_touch
