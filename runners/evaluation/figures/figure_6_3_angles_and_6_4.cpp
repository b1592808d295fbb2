// Fig 6.3 for other angles: how far the tool turns in the box, over the commanded angle, the spacing of the
// points and the contact rule.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/trace/force_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"

namespace remote_touch {

namespace {

constexpr double kFreeDeg = 10;     // the tool does not reach the walls up to this angle
constexpr double kBlockedDeg = 30;  // the walls hold the tool from this angle on

// The runs of one rule and spacing, over the commanded angle.
struct Turning {
  std::string rule, spacing;
  Table table;

  const Numbers& operator[](const char* column) const { return numbers(table, column); }
  // Returns the rotations of the tool over the angles from kBlockedDeg on.
  Numbers stops_deg() const {
    const Numbers &commanded = (*this)["commanded"], &turned = (*this)["turned"];
    return values_where(
        turned.size(), [&](std::size_t i) { return commanded[i] >= kBlockedDeg; },
        [&](std::size_t i) { return turned[i]; });
  }
};

// reference: the table that this one is compared with; null: itself.
Turning turning(const SweepResult& sweep, std::size_t rule, std::size_t spacing, const Table* reference) {
  const std::vector<std::size_t> runs = runs_at(sweep, {{}, spacing, rule});
  const std::string mm = std::to_string(std::lround(1e3 * axis_values(sweep, 1)[spacing]));
  const std::string rules[] = {"look-ahead", "voxels"}, names[] = {"look_ahead_", "voxels_"};
  const Numbers& commanded = axis_values(sweep, 0);
  // The device stays at the commanded angle for as long as the tool needs; the lag is largest there.
  const Numbers lag_rad = measured(sweep, "max_tool_lag_angle", runs);
  Table table{
      names[rule] + mm + "mm",
      "contact rule " + rules[rule] + ", points " + mm + " mm apart",
      {{"commanded", "deg", "angle to which the device is turned", commanded},
       {"turned", "deg", "angle to which the tool turns at most",
        each_of(runs.size(), [&](std::size_t i) { return commanded[i] - lag_rad[i] / kRadiansPerDegree; })},
       {"contacts", "1", "maximum number of points that touch", measured(sweep, "max_contact_count", runs)},
       {"torque", "N m", "maximum torque", measured(sweep, "max_torque", runs)},
       {"penetration", "m", "maximum depth of a point in the tool at the end of a tick",
        measured(sweep, "max_tool_penetration", runs)}}};
  const auto less = [&](const char* column) {
    return minus(numbers(table, column), numbers(reference ? *reference : table, column));
  };
  table.add("turned_difference", "deg", "angle of the tool less that of look-ahead, 1 mm", less("turned"));
  table.add("torque_difference", "N m", "torque less that of look-ahead, 1 mm", less("torque"));
  return {rules[rule], mm + " mm", table};
}

Panel panel(const std::vector<Turning>& runs, const std::string& title, const std::string& column,
            const std::string& y_label) {
  Panel made{title, "commanded rotation (deg)", y_label};
  for (const Turning& run : runs)
    made.curves.push_back(
        {run.table.name, "commanded", column, CurveStyle::line, run.rule + ", " + run.spacing});
  return made;
}

void add_claims(Figure& figure, const std::vector<Turning>& runs, const Numbers& exhausted) {
  // The largest value(run) over the runs of a rule, or over all runs if `rule` is empty.
  const auto largest = [&](const std::string& rule, const auto& value) {
    return max_where(
        runs.size(), [&](std::size_t i) { return rule.empty() || runs[i].rule == rule; },
        [&](std::size_t i) { return value(runs[i]); });
  };
  const auto free_lag = [](const Turning& run) {
    const Numbers &commanded = run["commanded"], &turned = run["turned"];
    return max_where(
        turned.size(), [&](std::size_t i) { return commanded[i] <= kFreeDeg; },
        [&](std::size_t i) { return commanded[i] - turned[i]; });
  };
  const auto stop = [](const Turning& run) { return max_of(run.stops_deg()); };
  const auto minus_stop = [](const Turning& run) { return -max_of(run.stops_deg()); };
  const auto history = [](const Turning& run) { return max_of(run.stops_deg()) - min_of(run.stops_deg()); };
  const auto depth = [](const Turning& run) { return max_of(run["penetration"]); };
  const Claims claims(figure);
  claims.at_most("the tool follows the device up to 10 deg: largest lag", largest("", free_lag), 1e-4, "deg");
  claims.at_most(
      "the tool stops at one angle, however far beyond 30 deg the device turns: largest difference",
      largest("", history), 0.1, "deg");
  claims.at_most(
      "contact rule look-ahead: the tool stops at the same angle with points 1, 2 and 3 mm apart: "
      "largest difference",
      largest("look-ahead", stop) + largest("look-ahead", minus_stop), 0.1, "deg");
  claims.at_most(
      "contact rule look-ahead: no point is in the tool at the end of a tick: depth of the deepest point",
      largest("look-ahead", depth), 1e-4, "m");
  claims.at_most(
      "contact rule voxels: no point is deeper in the tool than a voxel (0.5 mm) at the end of a tick: "
      "depth of the deepest point",
      largest("voxels", depth), 5e-4, "m");
  claims.at_most("no tick uses up its budget of detections: largest fraction of the ticks of a run",
                 max_of(exhausted), 0, "fraction");
}

}  // namespace

Figure figure_6_3_angles(FigureContext& context) {
  const SweepResult sweep = context.sweep(Sweep::load("fig6.3-angles"));
  std::vector<Turning> runs;
  for (const std::size_t rule : {0, 1})
    for (std::size_t spacing = 0; spacing < axis_values(sweep, 1).size(); ++spacing)
      runs.push_back(turning(sweep, rule, spacing, runs.empty() ? nullptr : &runs.front().table));
  Figure figure{
      "6.3-angles", "A tool turned in a box, over angle, spacing and rule",
      "The experiment of Fig 6.3 with the device turned by 5 to 50 deg, for points 1 to 3 mm apart and both "
      "contact rules; simulated. The tool follows until its sides touch the walls, and then stays at one "
      "angle, however far the device turns: the torque grows with the remaining angle. The curves differ so "
      "little that the panels on the right show their differences from look-ahead with points 1 mm apart. "
      "The voxels rule uses points only, so its stop depends on their spacing; look-ahead treats each point "
      "as a disk. A line style is a spacing, a colour is a rule."};
  for (const Turning& run : runs) figure.tables.push_back(run.table);
  figure.panels = {
      panel(runs, "Rotation of the tool", "turned", "tool rotation (deg)"),
      panel(runs, "Rotation less that of look-ahead, 1 mm", "turned_difference", "difference (deg)"),
      panel(runs, "Torque", "torque", "torque (N m)"),
      panel(runs, "Torque less that of look-ahead, 1 mm", "torque_difference", "difference (N m)"),
      panel(runs, "Contacts", "contacts", "touching points"),
      panel(runs, "Deepest point in the tool", "penetration", "depth (m)")};
  place_in_rows(figure, 2);
  add_claims(figure, runs, sweep.measure("exhausted_fraction"));
  return figure;
}

// Fig 6.4: tools of meshes slide over recorded objects.

namespace {

constexpr std::size_t kTableStride_6_4 = 5;        // ticks, in tables
constexpr double kSlides_s = 0.8, kLifts_s = 2.4;  // start of sliding and of lifting, in all three runs
constexpr double kFirst_s = 1.0, kSecond_s = 2.3;  // moments of the pictures
constexpr double kVoxel_m = 5e-4;
// A point in the shell is within 1.5 sqrt(3) voxels of the centre of a free voxel, which is outside the tool.
constexpr double kDeepestInShell_m = 2.5981 * kVoxel_m;

// A picture of a run: the part of the recording around the object, and the viewpoint.
struct DrawnMoment {
  const char *experiment, *table, *label;
  double left_m, right_m, top_m, bottom_m, max_depth_m;
  Vec3 eye, target;
  double width_m;
};

const DrawnMoment kDrawnMoments[] = {{"fig6.4", "bunny", "Bunny, printed cube", -0.25, 0.10, -0.20, 0.16,
                                      0.62, Vec3(0.36, -0.16, 0.22), Vec3(-0.03, 0.02, 0.42), 0.30},
                                     {"fig6.4-organ", "hand", "Hand, organ model", -0.02, 0.32, -0.22, 0.14,
                                      0.75, Vec3(-0.23, -0.17, 0.33), Vec3(0.12, -0.03, 0.58), 0.36},
                                     {"fig6.4-box", "drill", "Power drill, cereal box", -0.32, 0.14, -0.05,
                                      0.26, 0.80, Vec3(-0.36, -0.10, 0.24), Vec3(-0.01, 0.13, 0.52), 0.46}};

struct TouchRun {
  const DrawnMoment* shown;
  std::string rule;  // contact_rule
  Experiment experiment;
  Trace trace;
};

// True for the rule as printed. False for look-ahead, whose runs are drawn.
bool is_printed(const TouchRun& run) {
  return run.rule == "voxels";
}

std::string table_name(const TouchRun& run) {
  return std::string(run.shown->table) + (is_printed(run) ? "_voxels" : "");
}

// Distance from the tool to the device in each tick.
Numbers lags_m(const Trace& t) {
  return norms_between(t.hip_position_m, t.proxy_position_m);
}

Table touch_table(const TouchRun& run) {
  const Trace& t = run.trace;
  return every(
      kTableStride_6_4,
      {table_name(run),
       run.shown->label + (", contact rule " + run.rule),
       {{"time", "s", "simulated time", t.time_s},
        {"frame", "1", "frame in use", doubles(t.frame_index)},
        {"lag", "m", "from the tool's centre of mass to the device", lags_m(t)},
        {"lag_rotation", "deg", "between their orientations",
         each_of(t.length(), [&](std::size_t i) { return lag_rad(t, i) / kRadiansPerDegree; })},
        {"points", "1", "points that touch the tool", doubles(t.contact_count)},
        {"active", "1", "constraints that hold it", doubles(t.active_constraints)},
        {"clusters", "1", "10 mm cells of the tool with points that touch", doubles(t.contact_clusters)},
        {"penetration", "m", "deepest point in the tool at the end of the tick", t.tool_penetration_m},
        {"detections", "1", "collision detections in the tick", doubles(t.detections)},
        {"exhausted", "1", "the tick ended before the tool was at rest", doubles(t.budget_exhausted)},
        {"force", "N", "magnitude of the force", norms(t.force_N)},
        {"torque", "N m", "magnitude of the torque", norms(t.torque_Nm)}}});
}

// Returns every second pixel, in a chequered pattern, of the part of the recording that is shown.
std::vector<std::size_t> seen_points(const PointCloud& cloud, const DrawnMoment& shown) {
  const auto width = static_cast<std::size_t>(cloud.image->camera.width);
  return chosen_points(cloud, [&](std::size_t i) {
    const Vec3 p = cloud.point(i);  // a point that is NaN fails the test below
    return (i / width + i % width) % 2 == 0 && p.x() > shown.left_m && p.x() < shown.right_m &&
           p.y() > shown.top_m && p.y() < shown.bottom_m && p.z() < shown.max_depth_m;
  });
}

void add_picture_tables(Figure& figure, const FigureContext& context, const TouchRun& run) {
  const PointCloud cloud = processed_cloud(run.experiment, context.kernels(), 0);
  const std::string name = run.shown->table;
  const std::shared_ptr<const VoxelTool> tool = tool_of(run.experiment);
  figure.tables.push_back(cloud_table(name + "_cloud", "points of the first frame, every second pixel", cloud,
                                      seen_points(cloud, *run.shown)));
  add_tool_tables(figure, name, tool->mesh, run.trace,
                  {tick_of(run.trace, kFirst_s), tick_of(run.trace, kSecond_s)});
}

void add_panels(Figure& figure, const TouchRun& run, int row) {
  const DrawnMoment& shown = *run.shown;
  for (std::size_t instant = 0; instant < 2; ++instant) {
    const double time_s = run.trace.time_s[tick_of(run.trace, instant == 0 ? kFirst_s : kSecond_s)];
    figure.panels.push_back(
        scene_panel(std::string(shown.label) + ", " + std::to_string(time_s).substr(0, 3) + " s", row,
                    static_cast<int>(instant),
                    {shown.eye, shown.target, -Vec3::UnitY(), shown.width_m, 0.8,
                     tool_in_cloud(shown.table, instant, 0.003)}));
  }
  figure.panels.push_back(plot(
      "", "time (s)", "force (N)",
      {{shown.table, "time", "force", CurveStyle::line, "look-ahead"},
       {std::string(shown.table) + "_voxels", "time", "force", CurveStyle::dashed, "voxels, as printed"}},
      {{{row, 2}}, {{0, 3.2}}, {{0, 9}}}));
}

// Returns the share of the ticks while the tool slides in which it touches.
double touching_fraction(const Trace& t) {
  const std::size_t from = tick_of(t, kSlides_s), until = tick_of(t, kLifts_s);
  return mean_where(
      until, [&](std::size_t i) { return i >= from; }, [&](std::size_t i) { return t.contact_count[i] > 0; });
}

// Returns the largest penetration of the tool over the ticks without a new frame; NaN if one of them has no
// value or there are none.
double deepest_m(const Trace& trace) {
  return max_where(
      trace.length(), [&](std::size_t i) { return !trace.frame_update(i); },
      [&](std::size_t i) { return trace.tool_penetration_m[i]; });
}

// Counts the ticks whose log contradicts itself. No tick may make more detections than the budget, and a tick
// must report a used-up budget exactly if it is not at rest. It must then have made all its detections.
double inconsistent_ticks(const TouchRun& run) {
  const int budget = run.experiment.value_at_start("renderer.detections_per_tick");
  const Trace& t = run.trace;
  return count_where(t.length(), [&](std::size_t i) {
    const bool used_up = t.budget_exhausted[i] != 0;
    return t.detections[i] > budget || (used_up && t.detections[i] < budget) || used_up != !t.converged[i];
  });
}

void add_claims(Figure& figure, const TouchRun& run) {
  const Trace& t = run.trace;
  const Claims claims(figure, run.shown->label + std::string(is_printed(run) ? ", as printed: " : ": "));
  claims.at_most("all numbers are finite: fraction of ticks with one that is not", non_finite_fraction(t), 0,
                 "fraction");
  claims.at_most(
      "points stay out of the tool: depth of the deepest one at the end of a tick without a new frame",
      deepest_m(t), is_printed(run) ? kDeepestInShell_m : kVoxel_m, "m", "0");
  claims.at_most("the log of used-up budgets fits the detections: ticks in which it does not",
                 inconsistent_ticks(run), 0, "ticks");
  claims.at_least("the tool touches while it slides: fraction of that time", touching_fraction(t), 0.9,
                  "fraction");
  claims.at_least("the object holds the tool back: largest distance from tool to device", max_of(lags_m(t)),
                  0.005, "m");
  claims.at_most("no force remains when the tool was lifted: force at the end",
                 t.force_N[t.length() - 1].norm(), 0, "N", "0");
}

Table summary_table(const std::vector<TouchRun>& runs) {
  std::vector<std::string> names;
  for (const TouchRun& run : runs) names.push_back(table_name(run));
  const auto max = [](const std::vector<std::int32_t>& counts) { return max_of(doubles(counts)); };
  using R = const TouchRun&;
  return quantity_table<TouchRun>(
      "runs", "what happened in each run", names, runs,
      {{"ticks", "1", [](R r) { return r.trace.length(); }},
       {"most points that touch at once", "1", [&](R r) { return max(r.trace.contact_count); }},
       {"most active constraints at once", "1", [&](R r) { return max(r.trace.active_constraints); }},
       {"deepest point at the end of any tick", "m", [](R r) { return max_of(r.trace.tool_penetration_m); }},
       {"ticks that used up their detections", "1",
        [](R r) { return std::ranges::count(r.trace.budget_exhausted, 1); }},
       {"points of a frame without a normal, at most", "1",
        [&](R r) { return max(r.trace.disabled_points); }},
       {"maximum force", "N", [](R r) { return max_force_N(r.trace); }},
       {"largest force jump at a frame", "N", [](R r) { return max_force_jump_N(r.trace); }}});
}

std::vector<TouchRun> touch_runs(FigureContext& context) {
  std::vector<Experiment> experiments;
  std::vector<std::pair<const DrawnMoment*, std::string>> of;
  for (const DrawnMoment& shown : kDrawnMoments)
    for (const std::string rule : {"look-ahead", "voxels"}) {
      of.emplace_back(&shown, rule);
      experiments.push_back(Experiment::load(shown.experiment, {"renderer.contact_rule=" + rule}));
    }
  std::vector<Trace> traces = context.run(experiments);
  std::vector<TouchRun> runs;
  for (std::size_t r = 0; r < of.size(); ++r)
    runs.push_back({of[r].first, of[r].second, std::move(experiments[r]), std::move(traces[r])});
  return runs;
}

}  // namespace

Figure figure_6_4(FigureContext& context) {
  const std::vector<TouchRun> runs = touch_runs(context);
  Figure figure{
      "6.4", "Tools of meshes in recorded point clouds",
      "The tool as a filled solid, the device's pose transparent. A bunny on a printed cube and a hand on an "
      "organ model, five frames of a camera at rest played to and fro at 10 Hz; a power drill on a cereal "
      "box, one frame. Every frame is filtered and gets normals. The device comes from the camera's side, "
      "goes about 10 mm into the object, moves some tens of millimetres along it while it turns, and leaves. "
      "The points are shown from beside the camera, so what it did not see is empty. The pictures are of the "
      "rule look-ahead; the force of the printed rule is beside it."};
  int row = 0;
  for (const TouchRun& run : runs) {
    figure.tables.push_back(touch_table(run));
    if (!is_printed(run)) {
      add_picture_tables(figure, context, run);
      add_panels(figure, run, row++);
    }
    add_claims(figure, run);
  }
  figure.tables.push_back(summary_table(runs));
  return figure;
}

}  // namespace remote_touch
