// The question of chapter 4 for tools: up to which speed does a surface carry a plate that is pressed onto
// it, and how do thickness, tilt, rotation and noise change that? Simulated; not in the dissertation.
#include <algorithm>

#include "analysis/trace/interval_estimates.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/carried_limits.h"
#include "runners/experiment/mesh_files/loaded_tool.h"

namespace remote_touch {

namespace {

constexpr double kLiftFrames_hz = 30, kThinPlate_m = 0.005, kPlateLength_m = 0.04;

// Returns the largest distance by which one frame may move a surface against a plate. Printed rule: 6.2.4,
// with the shell on either side. Look-ahead: the whole plate, if the side of the last contact is known.
// Continuous rule: the larger of the plate's thickness and the distance by which a held tool is moved out.
double max_jump_m(Carrier rule, double thickness_m) {
  switch (rule) {
    case Carrier::voxels:
      return thickness_m - 2 * ToolSettings{}.voxel_m;
    case Carrier::look_ahead:
      return thickness_m;
    default:
      return std::max(thickness_m, ToolParameters{}.frame_reach_m);
  }
}

// A sweep over a setting, and the limit that is derived for it. Each rule has its own columns.
struct LiftSweep {
  std::string sweep, table, title;
  Column setting;  // without values: those of the sweep's first axis
  std::string units;
  LimitLabels labels;
  PanelFrame frame;
  DerivedLimit bound;
};

LiftSweep rising_surface() {
  return {"tool-lifts",
          "lifts",
          "Speed up to which a plate is carried",
          {"thickness", "m", "thickness of the plate", std::vector<double>{0.005, 0.01, 0.02}},
          "m/s",
          {"thickness h (m)", "speed (m/s)"},
          {.at = {{0, 0}}, .y_range = {{0, 0.7}}},
          [](Carrier rule, double h) { return kLiftFrames_hz * max_jump_m(rule, h); }};
}

// The plate lies flat on a tilted surface, which approaches along its normal by v cos(tilt) / f_c.
LiftSweep tilted_surface() {
  return {"tool-tilts",
          "tilts",
          "Speed of a tilted surface, plate of 5 mm",
          {"tilt", "deg", "tilt of the surface", std::vector<double>{}},
          "m/s",
          {"tilt (deg)", "speed (m/s)"},
          {.at = {{0, 1}}, .y_range = {{0, 1.4}}},
          [](Carrier rule, double deg) {
            return kLiftFrames_hz * max_jump_m(rule, kThinPlate_m) / sin_cos(deg * kRadiansPerDegree).second;
          }};
}

// The surface turns by A sin(2 pi f t): by about 2 pi f A / f_c in the first frame. The end of the plate that
// is nearer to the axis moves least, and the plate is lost if the surface passes through that end too.
LiftSweep turning_surface() {
  return {"tool-turns",
          "turns",
          "Surface that turns at 1 Hz, plate of 5 mm",
          {"lever", "m", "from the axis to the middle of the plate", std::vector<double>{}},
          "deg",
          {"distance from the axis (m)", "amplitude (deg)"},
          {.at = {{1, 0}}, .y_range = {{0, 100}}},
          [](Carrier rule, double lever_m) {
            const double near_m = lever_m - 0.5 * kPlateLength_m;
            const double turn_rad = sin_cos(360 * kRadiansPerDegree / kLiftFrames_hz).first;
            return max_jump_m(rule, kThinPlate_m) / near_m / turn_rad / kRadiansPerDegree;
          }};
}

LiftSweep noisy_surface() {
  return {"tool-noise",
          "noise",
          "With a velocity estimate, plate of 10 mm",
          {"noise", "m", "standard deviation of the noise on x, y and z", std::vector<double>{}},
          "m/s^2",
          {"noise (m)", "acceleration (m/s^2)"},
          {.at = {{1, 1}}, .y_range = {{0, 20}}},
          [](Carrier rule, double) { return kLiftFrames_hz * kLiftFrames_hz * max_jump_m(rule, 0.01); }};
}

Table limit_table(const LiftSweep& lift, const CarrySweep& sweep) {
  Table table{lift.table, lift.title, {lift.setting}};
  auto& settings = std::get<std::vector<double>>(table.columns[0].values);
  if (settings.empty()) settings = sweep.values(0);
  const std::vector<double> at = settings;  // the table's columns move when one is added
  for (const CarrierName& carrier : kCarriers) {
    TableRows rows;
    for (std::size_t i = 0; i < sweep.settings(); ++i) {
      const CarrySweep::Limit limit = sweep.limit(i, carrier.rule);
      rows.push_back({limit.carried, limit.lost, lift.bound(carrier.rule, at[i])});
    }
    const std::string column = carrier.column;
    add_rows(table,
             {{column + "_carried", lift.units, "all runs are carried up to this"},
              {column + "_first_lost", lift.units, "the next value: a run is lost"},
              {column + "_bound", lift.units, "derived limit"}},
             rows);
  }
  return table;
}

// Claims that no run is lost below the bound of `rule`, and that none is carried above the bound of `upper`.
void claim_bounded(const Claims& claims, const Table& table, Carrier rule, Carrier upper,
                   const std::string& claim) {
  const char* paper = rule == Carrier::voxels && table.name == "lifts" ? "v < f_c (h - 2w), 6.2.4" : "-";
  claims.at_most(claim + ": number of settings in which this is false",
                 count_rows_apart(table, column_of(rule) + "_carried", column_of(rule) + "_first_lost",
                                  column_of(rule) + "_bound", column_of(upper) + "_bound"),
                 0, "1", paper);
}

void add_claims(const Claims& claims, const Table& lifts, const Table& tilts, const Table& turns,
                const Table& noise) {
  using enum Carrier;
  const std::vector<double>&printed = numbers(noise, "voxels_carried"),
        &ours = numbers(noise, "continuous_carried");
  claim_bounded(claims, lifts, voxels, voxels,
                "the printed rule carries a plate up to the speed f_c (h - 2w) of the surface");
  claim_bounded(claims, lifts, look_ahead, look_ahead,
                "look-ahead carries a plate up to the speed f_c h of the surface");
  claim_bounded(
      claims, lifts, continuous, continuous,
      "the continuous rule carries a plate, however thin it is, up to the speed f_c frame_reach_m of "
      "the surface");
  claim_bounded(
      claims, tilts, voxels, continuous,
      "on a tilted surface, the printed rule carries a plate at least up to the speed f_c (h - 2w) / "
      "cos(tilt)");
  claim_bounded(claims, tilts, look_ahead, look_ahead,
                "on a tilted surface, look-ahead carries a plate up to the speed f_c h / cos(tilt)");
  claim_bounded(
      claims, tilts, continuous, continuous,
      "on a tilted surface, the continuous rule carries a plate up to the speed f_c frame_reach_m / "
      "cos(tilt)");
  claim_bounded(
      claims, turns, voxels, look_ahead,
      "on a surface that turns, the printed rule carries a plate until its nearer end moves by h - 2w "
      "to h in a frame");
  claim_bounded(claims, turns, look_ahead, look_ahead,
                "on a surface that turns, look-ahead carries a plate until its nearer end passes through");
  claim_bounded(claims, turns, continuous, continuous,
                "on a surface that turns, the continuous rule carries a plate at every speed that was tried");
  claims.at_least(
      "noise up to 4 mm does not lower the acceleration at which the printed rule carries a plate: "
      "smallest change",
      min_of(printed) - printed.front(), 0, "m/s^2");
  claims.at_least(
      "with noise up to 2 mm, the continuous rule carries a plate: acceleration that it carries at "
      "every noise",
      min_of(std::span(ours).first(ours.size() - 1)), 14, "m/s^2");
}

}  // namespace

Figure figure_tool_lifts(FigureContext& context) {
  Figure figure{
      "tool-lifts", "Where a plate loses the surface that it is pressed onto",
      "A surface of points rises, rises tilted, turns or accelerates under a plate of 40 x 40 mm, by the "
      "three contact rules; frames at 30 Hz; simulated. Dots: up to here every run is carried. Bars: up to "
      "the next value that was tried, at which a run is lost; arrows: no run is lost up to the end of the "
      "sweep, 45 deg or 14 m/s^2. The three rules are drawn side by side for each setting. Dashed: derived "
      "without noise, one frame moves the surface through the plate (printed rule: through what is not "
      "shell; continuous rule: by more than frame_reach_m, 20 mm). On the surface that turns, the derived "
      "angles of the continuous rule are above the panel, at 137 deg and more."};
  std::vector<Table> tables;
  for (const LiftSweep& lift : {rising_surface(), tilted_surface(), turning_surface(), noisy_surface()}) {
    tables.push_back(limit_table(lift, CarrySweep(context.sweep(Sweep::load(lift.sweep)))));
    figure.tables.push_back(tables.back());
    add_limit_panel(figure, tables.back(), lift.bound, lift.labels, lift.frame);
  }
  add_claims(Claims(figure), tables[0], tables[1], tables[2], tables[3]);
  return figure;
}

}  // namespace remote_touch
