// Fig 6.3: a tool is turned in a narrow box of points until its sides hold it; and how far it turns, over the
// commanded angle, the spacing of the points and the contact rule.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "analysis/trace/measures.h"
#include "runners/evaluation/figures/figure_pictures.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

namespace {

constexpr double kAgree_m = 1e-6, kAgree_rad = 1e-6;
constexpr double kBlocked_rad = kRadiansPerDegree;
constexpr double kBoxVoxel_m = 5e-4;
const std::vector<std::pair<std::string, std::string>> kRules = {{"look_ahead", "look-ahead"},
                                                                 {"voxels", "voxels"}};
const std::vector<int> kSpacings_mm = {3, 2, 1};

std::string spacing_setting(int mm) {
  return "scenario.spacing_m=" + std::to_string(mm) + "e-3";
}

struct BoxRun {
  std::string name, tool, rule;  // name in tables; tool and rule of the experiment
  int spacing_mm;
  Trace trace = {};
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

Table motion_table(const BoxRun& run) {
  const Trace& t = run.trace;
  const auto each_tick = [&](const auto& value) {
    return each_of(t.length(), [&](std::size_t i) { return value(t, i); });
  };
  const auto from_start_m = [&](const std::vector<Vec3>& p) {
    return each(p, [&](const Vec3& at) { return at.y() - t.hip_position_m[0].y(); });
  };
  return every(
      5, {run.name,
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
       {"points", "1", "most points that touch at once", of_each([](T t) { return most(t.contact_count); })},
       {"active", "1", "most active constraints at once",
        of_each([](T t) { return most(t.active_constraints); })},
       {"clusters", "1", "most 10 mm cells that touch at once",
        of_each([](T t) { return most(t.contact_clusters); })},
       {"penetration", "m", "deepest point at the end of a tick",
        of_each([](T t) { return max_of(t.tool_penetration_m); })},
       {"force", "N", "maximum force", of_each(max_force_N)},
       {"exhausted", "1", "ticks that used up their detections",
        of_each([](T t) { return std::ranges::count(t.budget_exhausted, 1); })},
       {"unheld", "1", "ticks in which points touch without holding", of_each([](T t) {
          return count_where(t.length(), [&](std::size_t i) { return agrees(t, i) && any_count(t, i); });
        })}}};
}

std::vector<BoxRun> box_runs(FigureContext& context) {
  std::vector<BoxRun> runs;
  for (const auto& [name, rule] : kRules)
    for (const int mm : kSpacings_mm) runs.push_back({name, "husky", rule, mm});
  for (const auto& [name, rule] : kRules) runs.push_back({name, "block", rule, kSpacings_mm[0]});
  std::vector<Trace> traces = context.run(list_of(runs, [](const BoxRun& run) {
    return Experiment::load("fig6.3", {"renderer.tool_mesh=" + run.tool, "renderer.contact_rule=" + run.rule,
                                       spacing_setting(run.spacing_mm)});
  }));
  for (std::size_t r = 0; r < runs.size(); ++r) runs[r].trace = std::move(traces[r]);
  return runs;
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
                 count_where(t.length(), [&](std::size_t i) { return moves_along(t, i) && any_count(t, i); }),
                 0, "ticks", "0");
  claims.at_most(
      "no contact is counted while the nearest point is a voxel or more away: ticks with a count above 0",
      count_where(t.length(),
                  [&](std::size_t i) { return t.nearest_distance_m[i] >= kBoxVoxel_m && any_count(t, i); }),
      0, "ticks", "0");
  claims.at_most(
      "a point touches whenever the tool lags by over 1 deg: ticks without one",
      count_where(t.length(),
                  [&](std::size_t i) { return lag_rad(t, i) > kBlocked_rad && t.contact_count[i] == 0; }),
      0, "ticks", "0");
  add_stop_claim(
      claims,
      "the tool stops where its outline meets the walls, while the device turns on to 30 deg: its rotation",
      run, "/box");
  const auto is_untouched = [&](std::size_t i) { return t.contact_count[i] == 0; };
  claims.at_most("the tool follows the device along y while nothing touches: largest gap",
                 max_of(where(magnitudes(minus(along(1, t.hip_position_m), along(1, t.proxy_position_m))),
                              is_untouched)),
                 1e-9, "m", "0");
  claim_finite(claims, t);
  Claims(figure, opening, &Claim::set_up)
      .at_least("the tool lags by over 1 deg for long enough: ticks in which it does",
                count_where(t.length(), [&](std::size_t i) { return lag_rad(t, i) > kBlocked_rad; }), 500,
                "ticks");
}

// Claims that more points touch where they lie closer, because all points on the faces touch. runs: those of
// one rule, with spacings of 3, 2 and 1 mm.
void add_spacing_claim(Figure& figure, std::span<const BoxRun> runs) {
  const Numbers count = each(runs, [](const BoxRun& run) { return most(run.trace.contact_count); });
  const auto text = [&](std::size_t r) { return std::to_string(static_cast<int>(count[r])); };
  const std::string counts = text(0) + ", " + text(1) + ", " + text(2);
  Claims(figure).at_least(
      "contact rule " + runs[0].rule +
          ": more points touch where they lie closer (largest count in a run, 3, 2 and 1 mm apart: " +
          counts + "): smallest rise",
      min_or_nan(count[1] - count[0], count[2] - count[1]), 1, "points", "6 at an unknown spacing");
}

// Claims for a bar of 80 x 10 mm that turns between two walls 40 mm apart. Its corner is at a wall where 40
// sin(a) + 5 cos(a) = 20.
void add_slot_claim(Figure& figure, FigureContext& context) {
  const double stops_deg =
      (std::asin(20 / std::hypot(40.0, 5.0)) - std::atan2(5.0, 40.0)) / kRadiansPerDegree;
  const auto error_deg = [&](const Trace& t) { return std::abs(tool_deg(t, t.length() - 1) - stops_deg); };
  const std::vector<Trace> traces = context.run(
      list_of(kSpacings_mm, [](int mm) { return Experiment::load("tool-slot", {spacing_setting(mm)}); }));
  Claims(figure).at_most(
      "contact rule look-ahead: a bar in a slot (tool-slot) stops at 22.62 deg, which follows from its "
      "sides alone: largest difference for points 3, 2 and 1 mm apart",
      max_of(each(traces, error_deg)), 0.02, "deg");
}

// Claims for the fifth side, 6.3.1: the device moves 20 mm deeper than the floor allows the tool. The floor's
// top is at -20 mm, and half of the husky, or the block, is 10 mm high.
void add_floor_claims(Figure& figure, FigureContext& context) {
  constexpr double kDevice_m = -0.03, kTool_m = -0.01, kSubStep_m = 0.5 * kBoxVoxel_m;
  const std::vector<Trace> traces = context.run(list_of(kRules, [](const auto& rule) {
    return Experiment::load("fig6.3", {"renderer.tool_mesh=block", "renderer.contact_rule=" + rule.second,
                                       "trajectory.poses.1.1=" + std::to_string(kDevice_m), "duration_s=2"});
  }));
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

// Adds the motion of device and tool, which both contact rules share, and the counts of each rule.
void add_panels(Figure& figure, std::span<const BoxRun* const> of_rules) {
  const std::pair<double, double> shown{0, 8};
  Panel along = plot("Displacement along y", "time (s)", "displacement (m)", {},
                     {.at = {{0, 0}}, .x_range = shown, .y_range = {{-0.065, 0.005}}}),
        about = plot("Rotation about y", "time (s)", "rotation (deg)", {},
                     {.at = {{0, 1}}, .x_range = shown, .y_range = {{-3, 33}}});
  for (const BoxRun* run : of_rules) {
    if (run == of_rules.front()) {
      along.curves.push_back({run->name, "time", "device_y", CurveStyle::line, "device"});
      about.curves.push_back({run->name, "time", "device_rotation", CurveStyle::line, "device"});
    }
    along.curves.push_back({run->name, "time", "tool_y", CurveStyle::dashed, "tool, " + run->rule});
    about.curves.push_back({run->name, "time", "tool_rotation", CurveStyle::dashed, "tool, " + run->rule});
  }
  figure.panels.push_back(along);
  figure.panels.push_back(about);
  for (std::size_t r = 0; r < of_rules.size(); ++r) {
    const std::string& name = of_rules[r]->name;
    figure.panels.push_back(plot("Contact rule " + of_rules[r]->rule, "time (s)", "count",
                                 {{name, "time", "points", CurveStyle::steps, "points that touch"},
                                  {name, "time", "clusters", CurveStyle::steps, "10 mm cells that touch"},
                                  {name, "time", "active", CurveStyle::steps, "active constraints"}},
                                 {.at = {{1, static_cast<int>(r)}}, .x_range = shown, .y_range = {{0, 16}}}));
  }
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
  figure.panels.push_back(scene_panel("At 30 deg commanded, from above", 2, 0, above));
  figure.panels.push_back(scene_panel("The same from the side", 2, 1, beside));
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
    const auto most = [&](const char* count) { return measured(sweep, count, {{}, rule}); };
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
    const auto is_default = [&](std::size_t i) { return std::abs(spacings_m[i] - kDefault_m) < 1e-9; };
    claims.differs("with points 3 mm apart more than 6 touch at once: largest number",
                   max_of(where(touching, is_default)), kKnownAtDefault[rule], kKnownAtDefault[rule],
                   "points", paper);
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
      "box. The device takes the tool in, turns it by 30 deg and back, and takes it out. Contact rule "
      "look-ahead: points are constraints with their distance, ahead of the tool. Contact rule voxels: the "
      "tool's voxels as printed. The pictures are of look-ahead at 30 deg: the tool filled, the device "
      "transparent. The last row shows the largest counts of a run over the spacing of its points; the dashed line is at the 6 contact points of 6.3.1. "
      "The number of points that touch depends on their spacing; the tool is never held by more than 6 "
      "constraints. A cell is a part of the tool's surface, 10 mm across, in which a point touches."};
  const std::size_t step = kSpacings_mm.size(), of_husky = step * kRules.size();
  for (std::size_t r = 0; r < kRules.size(); ++r) {
    const BoxRun& run = runs[r * step];
    figure.tables.push_back(motion_table(run));
    add_rule_claims(figure, run);
    add_spacing_claim(figure, std::span(runs).subspan(r * step, step));
  }
  add_panels(figure, std::array{&runs[0], &runs[step]});
  // A block as long, wide and high as the husky was not made for this box, and stops elsewhere.
  for (const BoxRun& run : std::span(runs).subspan(of_husky))
    add_stop_claim(
        Claims(figure),
        "contact rule " + run.rule +
            ": a block of the husky's length, width and height stops where its outline meets the walls: "
            "its rotation",
        run, "/box/block");
  add_slot_claim(figure, context);
  add_floor_claims(figure, context);
  figure.tables.push_back(summary_table(runs));
  add_pictures(figure, context, runs[0]);
  add_contacts_over_spacing(figure, context.sweep(Sweep::load("fig6.3-spacings")), 3);
  return figure;
}

// Fig 6.3 for other angles.

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
    const Numbers& commanded = (*this)["commanded"];
    return where((*this)["turned"], [&](std::size_t i) { return commanded[i] >= kBlockedDeg; });
  }
};

// reference: the table that this one is compared with; null: itself.
Turning turning(const SweepResult& sweep, std::size_t rule, std::size_t spacing, const Table* reference) {
  const auto of = [&](const char* measure) { return measured(sweep, measure, {{}, spacing, rule}); };
  const std::string mm = std::to_string(std::lround(1e3 * axis_values(sweep, 1)[spacing]));
  const auto& [name, rule_name] = kRules[rule];
  const Numbers& commanded = axis_values(sweep, 0);
  // The device stays at the commanded angle for as long as the tool needs; the lag is largest there.
  const Numbers lag_rad = of("max_tool_lag_angle");
  Table table{name + "_" + mm + "mm",
              "contact rule " + rule_name + ", points " + mm + " mm apart",
              {{"commanded", "deg", "angle to which the device is turned", commanded},
               {"turned", "deg", "angle to which the tool turns at most",
                each_of(lag_rad.size(),
                        [&](std::size_t i) { return commanded[i] - lag_rad[i] / kRadiansPerDegree; })},
               {"contacts", "1", "maximum number of points that touch", of("max_contact_count")},
               {"torque", "N m", "maximum torque", of("max_torque")},
               {"penetration", "m", "maximum depth of a point in the tool at the end of a tick",
                of("max_tool_penetration")}}};
  const auto less = [&](const char* column) {
    return minus(numbers(table, column), numbers(reference ? *reference : table, column));
  };
  table.add("turned_difference", "deg", "angle of the tool less that of look-ahead, 1 mm", less("turned"));
  table.add("torque_difference", "N m", "torque less that of look-ahead, 1 mm", less("torque"));
  return {rule_name, mm + " mm", table};
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
    const Numbers& commanded = run["commanded"];
    return max_of(where(minus(commanded, run["turned"]), [&](auto i) { return commanded[i] <= kFreeDeg; }));
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

}  // namespace remote_touch
