// Fig 6.3: a tool is turned in a narrow box of points until its sides hold it.
#include <algorithm>
#include <cmath>
#include <span>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

namespace {

constexpr std::size_t kTableStride_6_3 = 5;  // ticks, in tables
constexpr double kAgree_m = 1e-6, kAgree_rad = 1e-6;
constexpr double kBlocked_rad = kRadiansPerDegree;
constexpr double kBoxVoxel_m = 5e-4;
const std::vector<std::pair<std::string, std::string>> kRules = {{"look_ahead", "look-ahead"},
                                                                 {"voxels", "voxels"}};
const std::vector<int> kSpacings_mm = {3, 2, 1};

struct BoxRun {
  std::string name, tool, rule;  // name in tables; tool and rule of the experiment
  int spacing_mm;
  Trace trace;
};

double rotated_deg(const Eigen::Quaterniond& q) {
  return rotation_vector(q).y() / kRadiansPerDegree;
}

double device_deg(const Trace& trace, std::size_t i) {
  return rotated_deg(trace.hip_orientation[i]);
}

double tool_deg(const Trace& trace, std::size_t i) {
  return rotated_deg(trace.tool_orientation[i]);
}

// Returns the first tick in which the device has turned farthest.
std::size_t plateau_tick(const Trace& trace) {
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (device_deg(trace, i) > device_deg(trace, farthest)) farthest = i;
  return farthest;
}

double max(const std::vector<std::int32_t>& counts) {
  return max_of(doubles(counts));
}

bool agrees(const Trace& t, std::size_t i) {
  return lag_m(t, i) <= kAgree_m && lag_rad(t, i) <= kAgree_rad;
}

// True while the device is not turned: it moves into the box or out of it.
bool moves_along(const Trace& t, std::size_t i) {
  return rotation_vector(t.hip_orientation[i]).norm() < kAgree_rad;
}

bool any_count(const Trace& t, std::size_t i) {
  return t.contact_count[i] != 0 || t.active_constraints[i] != 0 || t.contact_clusters[i] != 0;
}

// Number of ticks for which holds(i) is true.
template <class Holds>
double ticks_with(const Trace& trace, Holds&& holds) {
  return count_where(trace.length(), holds);
}

Table motion_table(const BoxRun& run) {
  const Trace& t = run.trace;
  const auto each_tick = [&](const auto& value) {
    return each_of(t.length(), [&](std::size_t i) { return value(t, i); });
  };
  const auto from_start_m = [&](const std::vector<Vec3>& p) {
    return each(p, [&](const Vec3& at) { return at.y() - t.hip_position_m[0].y(); });
  };
  return every(
      kTableStride_6_3,
      {run.name,
       "contact rule " + run.rule + ", points 3 mm apart",
       {{"time", "s", "simulated time", t.time_s},
        {"device_y", "m", "displacement of the device along y from its start",
         from_start_m(t.hip_position_m)},
        {"tool_y", "m", "displacement of the tool along y from the same place",
         from_start_m(t.proxy_position_m)},
        {"device_rotation", "deg", "rotation of the device about y", each_tick(device_deg)},
        {"tool_rotation", "deg", "rotation of the tool about y", each_tick(tool_deg)},
        {"points", "1", "points that touch the tool", doubles(t.contact_count)},
        {"active", "1", "constraints that hold it", doubles(t.active_constraints)},
        {"clusters", "1", "10 mm cells of the tool with points that touch", doubles(t.contact_clusters)},
        {"force", "N", "magnitude of the force", norms(t.force_N)},
        {"torque", "N m", "magnitude of the torque", norms(t.torque_Nm)}}});
}

// Returns a table of all runs, one row for each.
Table summary_table(const std::vector<BoxRun>& runs) {
  std::vector<std::string> tools, rules;
  for (const BoxRun& run : runs) tools.push_back(run.tool), rules.push_back(run.rule);
  const auto of_each = [&](const auto& value) {
    return each(runs, [&](const BoxRun& run) { return value(run.trace); });
  };
  using T = const Trace&;
  return {
      "runs",
      "both rules, points 3, 2 and 1 mm apart",
      {{"tool", "1", "tool_mesh of the run", tools},
       {"rule", "1", "contact rule", rules},
       {"spacing", "m", "spacing of the points",
        each(runs, [](const BoxRun& run) { return run.spacing_mm * 1e-3; })},
       {"plateau", "deg", "rotation of the tool at 30 deg commanded",
        of_each([](T t) { return tool_deg(t, plateau_tick(t)); })},
       {"points", "1", "most points that touch at once", of_each([](T t) { return max(t.contact_count); })},
       {"active", "1", "most active constraints at once",
        of_each([](T t) { return max(t.active_constraints); })},
       {"clusters", "1", "most 10 mm cells that touch at once",
        of_each([](T t) { return max(t.contact_clusters); })},
       {"penetration", "m", "deepest point at the end of a tick",
        of_each([](T t) { return max_of(t.tool_penetration_m); })},
       {"force", "N", "maximum force", of_each(max_force_N)},
       {"exhausted", "1", "ticks that used up their detections",
        of_each([](T t) { return std::ranges::count(t.budget_exhausted, 1); })},
       {"unheld", "1", "ticks in which points touch without holding", of_each([](T t) {
          return ticks_with(t, [&](std::size_t i) { return agrees(t, i) && any_count(t, i); });
        })}}};
}

std::vector<BoxRun> box_runs(FigureContext& context) {
  std::vector<BoxRun> runs;
  std::vector<Experiment> experiments;
  const auto add = [&](const std::string& name, const std::string& tool, const std::string& rule, int mm) {
    runs.push_back({name, tool, rule, mm, {}});
    experiments.push_back(
        Experiment::load("fig6.3", {"renderer.tool_mesh=" + tool, "renderer.contact_rule=" + rule,
                                    "scenario.spacing_m=" + std::to_string(mm) + "e-3"}));
  };
  for (const auto& [name, rule] : kRules)
    for (const int mm : kSpacings_mm) add(name, "husky", rule, mm);
  for (const auto& [name, rule] : kRules) add(name, "block", rule, kSpacings_mm[0]);
  std::vector<Trace> traces = context.run(experiments);
  for (std::size_t r = 0; r < runs.size(); ++r) runs[r].trace = std::move(traces[r]);
  return runs;
}

// Largest gap between device and tool along y, over the ticks without a point that touches; NaN if there are
// none.
double max_gap_untouched_m(const Trace& t) {
  return max_where(
      t.length(), [&](std::size_t i) { return t.contact_count[i] == 0; },
      [&](std::size_t i) { return std::abs(t.hip_position_m[i].y() - t.proxy_position_m[i].y()); });
}

// Returns how far before and behind the walls a corner of the tool may stop, in mm, compared with the outline
// that the second implementation turns in closed form. The mesh replaces the round corners of 8 mm by chords
// of 2.5 mm, which makes it up to 0.1 mm smaller. Its distance field is exact to a tenth of that. Voxels are
// 0.65 mm thick at the angle at which the tool stops, so their surface is within half of that. A point may be
// a sub-step of 0.25 mm deep, and a corner sinks 0.14 mm between points 3 mm apart.
std::pair<double, double> plateau_slack_mm(const std::string& rule) {
  constexpr double kChord = 0.1, kField = 0.01, kVoxel = 0.65 / 2, kSubStep = 0.25, kSinks = 0.14;
  if (rule == "look-ahead") return {kField, kChord + kField};
  return {kVoxel, kChord + kVoxel + kSubStep + kSinks};
}

// Claims that a tool stops where its outline stops in the closed form. place: path of the tool's numbers in
// the second implementation's results.
void add_stop_claim(const Claims& claims, const std::string& what, const BoxRun& run,
                    const std::string& place) {
  const auto [early, late] = plateau_slack_mm(run.rule);
  const double stops_deg = second_number("chapter_6", place + "/stop_angle_deg"),
               deg_per_mm = second_number("chapter_6", place + "/deg_per_mm");
  claims.between(what, tool_deg(run.trace, plateau_tick(run.trace)), stops_deg - early * deg_per_mm,
                 stops_deg + late * deg_per_mm, "deg");
}

void add_rule_claims(Figure& figure, const BoxRun& run) {
  const Trace& t = run.trace;
  const std::string opening = "contact rule " + run.rule + ": ";
  const Claims claims(figure, opening);
  claims.at_most("no contact is counted on the way in and out: ticks with a count above 0",
                 ticks_with(t, [&](std::size_t i) { return moves_along(t, i) && any_count(t, i); }), 0,
                 "ticks", "0");
  claims.at_most(
      "no contact is counted while the nearest point is a voxel or more away: ticks with a count above 0",
      ticks_with(t, [&](std::size_t i) { return t.nearest_distance_m[i] >= kBoxVoxel_m && any_count(t, i); }),
      0, "ticks", "0");
  claims.at_most(
      "a point touches whenever the tool lags by over 1 deg: ticks without one",
      ticks_with(t, [&](std::size_t i) { return lag_rad(t, i) > kBlocked_rad && t.contact_count[i] == 0; }),
      0, "ticks", "0");
  add_stop_claim(
      claims,
      "the tool stops where its outline meets the walls, while the device turns on to 30 deg: its rotation",
      run, "/box");
  claims.at_most("the tool follows the device along y while nothing touches: largest gap",
                 max_gap_untouched_m(t), 1e-9, "m", "0");
  claims.at_most("all numbers are finite: fraction of ticks with one that is not", non_finite_fraction(t), 0,
                 "fraction");
  Claims(figure, opening, &Claim::set_up)
      .at_least("the tool lags by over 1 deg for long enough: ticks in which it does",
                ticks_with(t, [&](std::size_t i) { return lag_rad(t, i) > kBlocked_rad; }), 500, "ticks");
}

// Claims that more points touch where they lie closer, because all points on the faces touch. runs: those of
// one rule, with spacings of 3, 2 and 1 mm.
void add_spacing_claim(Figure& figure, std::span<const BoxRun> runs) {
  std::string counts;
  double min_rise = 1e9;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double count = max(runs[r].trace.contact_count);
    counts += (r ? ", " : "") + std::to_string(static_cast<int>(count));
    if (r > 0) min_rise = min_or_nan(min_rise, count - max(runs[r - 1].trace.contact_count));
  }
  Claims(figure).at_least(
      "contact rule " + runs[0].rule +
          ": more points touch where they lie closer (largest count in a run, 3, 2 and 1 mm apart: " +
          counts + "): smallest rise",
      min_rise, 1, "points", "6 at an unknown spacing");
}

// Claims for tools that were not made for this box. A block as long, wide and high as the husky stops
// elsewhere.
void add_block_claims(Figure& figure, std::span<const BoxRun> runs) {
  for (const BoxRun& run : runs)
    add_stop_claim(
        Claims(figure),
        "contact rule " + run.rule +
            ": a block of the husky's length, width and height stops where its outline meets the walls: "
            "its rotation",
        run, "/box/block");
}

// Claims for a bar of 80 x 10 mm that turns between two walls 40 mm apart. Its corner is at a wall where 40
// sin(a) + 5 cos(a) = 20.
void add_slot_claim(Figure& figure, FigureContext& context) {
  const double stops_deg =
      (std::asin(20 / std::hypot(40.0, 5.0)) - std::atan2(5.0, 40.0)) / kRadiansPerDegree;
  std::vector<Experiment> experiments;
  for (const int mm : kSpacings_mm)
    experiments.push_back(
        Experiment::load("tool-slot", {"scenario.spacing_m=" + std::to_string(mm) + "e-3"}));
  double max_error_deg = 0;
  for (const Trace& trace : context.run(experiments))
    max_error_deg = max_or_nan(max_error_deg, std::abs(tool_deg(trace, trace.length() - 1) - stops_deg));
  Claims(figure).at_most(
      "contact rule look-ahead: a bar in a slot (tool-slot) stops at 22.62 deg, which follows from its "
      "sides alone: largest difference for points 3, 2 and 1 mm apart",
      max_error_deg, 0.02, "deg");
}

// Claims for the fifth side, 6.3.1: the device moves 20 mm deeper than the floor allows the tool. The floor's
// top is at -20 mm, and half of the husky, or the block, is 10 mm high.
void add_floor_claims(Figure& figure, FigureContext& context) {
  constexpr double kDevice_m = -0.03, kTool_m = -0.01, kSubStep_m = 0.5 * kBoxVoxel_m;
  std::vector<Experiment> experiments;
  for (const auto& [name, rule] : kRules)
    experiments.push_back(
        Experiment::load("fig6.3", {"renderer.tool_mesh=block", "renderer.contact_rule=" + rule,
                                    "trajectory.poses.1.1=" + std::to_string(kDevice_m), "duration_s=2"}));
  const std::vector<Trace> traces = context.run(experiments);
  for (std::size_t r = 0; r < kRules.size(); ++r) {
    // The floor may lie in the tool's shell under the printed rule. The upper side of the shell is within
    // half a voxel of the surface.
    const double deep_m = r == 0 ? 1e-5 : 0.5 * kBoxVoxel_m + kSubStep_m;
    Claims(figure).between(
        std::string("contact rule ") + kRules[r].second + ": the floor stops the block: height of its centre",
        traces[r].proxy_position_m.back().y(), kTool_m - deep_m,
        kTool_m + (r == 0 ? 1e-5 : 0.5 * kBoxVoxel_m), "m");
  }
}

void add_panels(Figure& figure, const BoxRun& run, int column) {
  PanelColumn panels{figure, run.name, "time", "time (s)", column, {{0, 8}}};
  panels.add("Contact rule " + run.rule, "displacement along y (m)",
             {{"device_y", CurveStyle::line, "device"}, {"tool_y", CurveStyle::dashed, "tool"}},
             {{-0.065, 0.005}});
  panels.add("", "rotation about y (deg)",
             {{"device_rotation", CurveStyle::line, "device"}, {"tool_rotation", CurveStyle::dashed, "tool"}},
             {{-3, 33}});
  panels.add("", "count",
             {{"points", CurveStyle::steps, "points that touch"},
              {"clusters", CurveStyle::steps, "10 mm cells that touch"},
              {"active", CurveStyle::steps, "active constraints"}},
             {{0, 16}});
}

void add_pictures(Figure& figure, const FigureContext& context, const BoxRun& run) {
  const Experiment experiment = Experiment::load("fig6.3");
  const PointCloud cloud = processed_cloud(experiment, context.kernels(), 0);
  const std::shared_ptr<const VoxelTool> tool = tool_of(experiment);
  figure.tables.push_back(
      cloud_table("box_cloud", "the box", cloud, chosen_points(cloud, [](std::size_t) { return true; })));
  add_tool_tables(figure, "box", tool->mesh, run.trace, {plateau_tick(run.trace)});
  Scene above{{0, 0.40, 0.0}, {0, 0, 0}, {0, 0, -1}, 0.135, 0.8, tool_in_cloud("box", 0, 0.0018)};
  Scene beside = above;
  beside.eye = {0.16, 0.26, 0.30}, beside.up = {0, 1, 0}, beside.target = {0, -0.004, 0};
  beside.width_m = 0.155;
  above.parts[0].colour = beside.parts[0].colour = 0x4F6F8F;
  figure.panels.push_back(scene_panel("At 30 deg commanded, from above", 3, 0, above));
  figure.panels.push_back(scene_panel("The same from the side", 3, 1, beside));
}

// Adds the counts over the spacing of the points, for each contact rule: a table, claims, and two panels. The
// dissertation counts "as many as 6 contact points" (6.3.1) and prints no spacing.
void add_contacts_over_spacing(Figure& figure, const SweepResult& sweep, int row) {
  constexpr double kPrintedContacts = 6, kDefault_m = 0.003;
  constexpr double kKnownAtDefault[] = {12, 8};  // touching points at 3 mm, the same on every processor
  const Numbers& spacings_m = axis_values(sweep, 0);
  Panel points = plot("Points that touch", "spacing of the points (m)", "largest count in a run", {},
                      {.at = {{row, 0}}, .y_range = {{0, 35}}}),
        others = plot("Counts that depend little on the spacing", points.x_label, points.y_label, {},
                      {.at = {{row, 1}}, .y_range = {{0, 8}}});
  for (std::size_t rule = 0; rule < kRules.size(); ++rule) {
    const std::string label = kRules[rule].second, name = "spacings_" + kRules[rule].first;
    const auto most = [&](const char* count) { return measured(sweep, count, runs_at(sweep, {{}, rule})); };
    const Numbers touching = most("max_contact_count");
    figure.tables.push_back(
        {name,
         "contact rule " + label + ": counts over the spacing of the points",
         {{"spacing", "m", "spacing of the points", spacings_m},
          {"points", "1", "most points that touch at once", touching},
          {"active", "1", "most active constraints at once", most("max_active_constraints")},
          {"clusters", "1", "most 10 mm cells that touch at once", most("max_contact_clusters")},
          {"printed", "1", "as many as 6 contact points (6.3.1)",
           Numbers(spacings_m.size(), kPrintedContacts)}}});
    points.curves.push_back({name, "spacing", "points", CurveStyle::line, label});
    others.curves.push_back({name, "spacing", "clusters", CurveStyle::line, label + ", 10 mm cells"});
    others.curves.push_back({name, "spacing", "active", CurveStyle::dashed, label + ", active constraints"});
    const Claims claims(figure, "contact rule " + label + ": ");
    const std::string paper = "6, at a spacing that is not printed";
    const double at_default = max_where(
        touching.size(), [&](std::size_t i) { return std::abs(spacings_m[i] - kDefault_m) < 1e-9; },
        [&](std::size_t i) { return touching[i]; });
    claims.differs("with points 3 mm apart more than 6 touch at once: largest number", at_default,
                   kKnownAtDefault[rule], kKnownAtDefault[rule], "points", paper);
    claims.at_least(
        "at some spacings from 1 to 6 mm, in steps of 0.5 mm, the most points that touch at once are 6: "
        "number of these spacings",
        std::ranges::count(touching, kPrintedContacts), 1, "spacings", paper);
  }
  points.curves.push_back(
      {"spacings_voxels", "spacing", "printed", CurveStyle::dashed, "printed: 6 contact points (6.3.1)"});
  figure.panels.push_back(points);
  figure.panels.push_back(others);
}

}  // namespace

Figure figure_6_3(FigureContext& context) {
  const std::vector<BoxRun> runs = box_runs(context);
  Figure figure{
      "6.3", "A tool in a narrow box of points",
      "A box with a floor and without a top, 110 x 90 mm inside, its points 3 mm apart with normals into the "
      "box. The device takes the tool in, turns it by 30 deg and back, and takes it out. Left: points as "
      "constraints with their distance, ahead of the tool. Right: the tool's voxels as printed. The picture "
      "is of the left run at 30 deg: the tool filled, the device transparent. The last row shows the largest "
      "counts of a run over the spacing of its points; the dashed line is at the 6 contact points of 6.3.1. "
      "The number of points that touch depends on their spacing; the tool is never held by more than 6 "
      "constraints. A cell is a part of the tool's surface, 10 mm across, in which a point touches."};
  const std::size_t step = kSpacings_mm.size(), of_husky = step * kRules.size();
  for (std::size_t r = 0; r < kRules.size(); ++r) {
    const BoxRun& run = runs[r * step];
    figure.tables.push_back(motion_table(run));
    add_panels(figure, run, static_cast<int>(r));
    add_rule_claims(figure, run);
    add_spacing_claim(figure, std::span(runs).subspan(r * step, step));
  }
  add_block_claims(figure, std::span(runs).subspan(of_husky));
  add_slot_claim(figure, context);
  add_floor_claims(figure, context);
  figure.tables.push_back(summary_table(runs));
  add_pictures(figure, context, runs[0]);
  add_contacts_over_spacing(figure, context.sweep(Sweep::load("fig6.3-spacings")), 4);
  return figure;
}

}  // namespace remote_touch
