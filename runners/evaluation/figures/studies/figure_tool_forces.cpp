// Force and torque of the methods for tools against model scenes in which they are known exactly, in
// magnitude and direction: the protocol of Weller et al. 2010. Simulated; not in the dissertation.
#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "analysis/theory/surface_contacts.h"
#include "analysis/trace/interval_estimates.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

const std::string kForcesFigure = "tool-forces";
constexpr double kBlockHalf_m = 0.02, kBlockHalfHeight_m = 0.005;  // half extents of slab-10
constexpr double kBallRadius_m = 0.01;                             // radius of ball
constexpr double kAbove_m = 0.002, kDeep_m = 0.006;                // start above the touch, end below it
constexpr double kLeastError = 1e-5, kLeastAngle_deg = 1e-4;       // smaller deviations are drawn at these

struct ToolMethod {
  const char *column, *label, *renderer;
};
constexpr ToolMethod kToolMethods[] = {
    {"look_ahead", "look-ahead", R"("name": "tool")"},
    {"continuous", "continuous", R"("name": "tool", "contact_rule": "continuous")"},
    {"voxels", "as printed", R"("name": "tool", "contact_rule": "voxels")"},
    {"god_object", "god-object", R"("name": "tool-god-object")"},
    {"penalty", "penalty", R"("name": "tool-penalty")"},
    {"voxmap", "voxmap", R"("name": "tool-penalty", "force_law": "voxmap")"}};

constexpr ToolMethod kOfCoupling{"look_ahead", "look-ahead, M of the coupling",
                                 R"("name": "tool", "motion_metric": "coupling")"};

// A press, and the exact wrench for a pose of the device.
struct ModelPress {
  double setting;  // value of the axis of its table
  std::string tool, scenario, poses;
  std::function<Wrench(const DeviceState&)> wrench;
};

std::string row(const Vec3& p_m, const Vec3& turn_deg, double duration_s) {
  std::ostringstream text;
  text << '[' << p_m.x() << ", " << p_m.y() << ", " << p_m.z() << ", " << turn_deg.x() << ", " << turn_deg.y()
       << ", " << turn_deg.z() << ", " << duration_s << ']';
  return text.str();
}

std::string press_along(const Vec3& touching_m, const Vec3& normal, double about_z_deg) {
  const Vec3 turn_deg(0, 0, about_z_deg);
  return row(touching_m + kAbove_m * normal, turn_deg, 0) + ", " +
         row(touching_m - kDeep_m * normal, turn_deg, 0.4);
}

std::string shape(const std::string& settings) {
  return R"("name": "moving-shape", "columns": 70, "rows": 50, "phase_x": 0.37, "phase_z": 0.21, "normals": true, )" +
         settings;
}

Experiment experiment_of(const ModelPress& press, const ToolMethod& method) {
  const std::string json = R"({"title": "tool-forces", "scenario": {)" + press.scenario +
                           R"(}, "renderer": {)" + method.renderer + R"(, "tool_mesh": ")" + press.tool +
                           R"("}, "trajectory": {"name": "poses", "poses": [)" + press.poses + "]}}";
  return Experiment::from_json(json, kForcesFigure);
}

double about_z_rad(const DeviceState& device) {
  return rotation_vector(device.orientation_W).z();
}

// A block with the tilt of the plane, pressed along its normal. The exact force is k d, the exact torque 0.
ModelPress on_plane(double tilt_deg) {
  const auto [sine, cosine] = sin_cos(tilt_deg * kRadiansPerDegree);
  const Vec3 normal(-sine, cosine, 0);
  return {tilt_deg, "slab-10", shape(R"("tilt_deg": )" + std::to_string(tilt_deg)),
          press_along(kBlockHalfHeight_m * normal, normal, tilt_deg), [normal](const DeviceState& device) {
            const double depth_m = kBlockHalfHeight_m - normal.dot(device.position_W);
            return Wrench{EvenSpring{}.stiffness_N_per_m * std::max(0.0, depth_m) * normal, Vec3::Zero()};
          }};
}

// A block on a level plane, tilted by the hand.
ModelPress turned_block(double turn_deg) {
  const auto [sine, cosine] = sin_cos(turn_deg * kRadiansPerDegree);
  return {turn_deg, "slab-10", shape(R"("tilt_deg": 0)"),
          press_along({0, kBlockHalf_m * sine + kBlockHalfHeight_m * cosine, 0}, Vec3::UnitY(), turn_deg),
          [](const DeviceState& device) {
            const RestingWrench at = block_on_line(kBlockHalf_m, kBlockHalfHeight_m, EvenSpring{},
                                                   device.position_W.y(), about_z_rad(device));
            return Wrench{{0, at.force_N.y(), 0}, {0, 0, at.torque_Nm}};
          }};
}

// A ball pressed into a valley, 2 mm beside its middle.
ModelPress in_groove(double slope_deg) {
  const double touching_m = kBallRadius_m / sin_cos(slope_deg * kRadiansPerDegree).second;
  return {slope_deg, "ball", shape(R"("shape": "valley", "slope_deg": )" + std::to_string(slope_deg)),
          press_along({0.002, touching_m, 0}, Vec3::UnitY(), 0), [slope_deg](const DeviceState& device) {
            const Vec3& p = device.position_W;
            const RestingWrench at =
                ball_in_groove(kBallRadius_m, slope_deg * kRadiansPerDegree, {}, {p.x(), p.y()});
            return Wrench{{at.force_N.x(), at.force_N.y(), 0}, Vec3::Zero()};
          }};
}

// A bar turned between two walls. The exact force is 0, and the exact torque is that of its two corners.
ModelPress in_slot() {
  return {0, "bar", R"("name": "slot", "spacing_m": 0.002)",
          row(Vec3::Zero(), Vec3::Zero(), 0) + ", " + row(Vec3::Zero(), {0, 32, 0}, 0.5),
          [](const DeviceState& device) {
            const double angle_rad = rotation_vector(device.orientation_W).y();
            return Wrench{Vec3::Zero(), {0, bar_in_slot(0.04, 0.005, 0.02, {}, angle_rad).torque_Nm, 0}};
          }};
}

// Deviation of one vector over the ticks of a press in which the exact vector is not small. magnitude: mean
// deviation of its magnitude, as a fraction of the mean exact magnitude. missing: fraction of ticks without
// any vector. direction_deg: mean angle between both vectors over the other ticks. NaN without such ticks.
struct Deviation {
  double magnitude = 0, missing = 0, direction_deg = 0;
};
using Vectors = std::vector<Vec3>;
Deviation deviation(const Vectors& rendered, const Vectors& exact, double small) {
  double sum = 0, apart = 0, angle_rad = 0;
  int ticks = 0, missing = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double size = exact[i].norm(), got = rendered[i].norm();
    if (!(size > small)) continue;
    ++ticks;
    sum += size, apart += std::abs(got - size);
    if (got > 0)
      angle_rad += std::atan2(exact[i].cross(rendered[i]).norm(), exact[i].dot(rendered[i]));
    else
      ++missing;
  }
  return {apart / sum, static_cast<double>(missing) / ticks,
          angle_rad / (ticks - missing) / kRadiansPerDegree};
}

// Results of one run.
struct PressResult {
  Deviation force, torque;
  double torque_error_Nm = 0;  // mean of |torque - exact torque|
  std::vector<double> angle_deg, torque_Nm, exact_torque_Nm;
};
PressResult result_of(const ModelPress& press, const Trace& trace) {
  constexpr double kSmallForce_N = 0.5, kSmallTorque_Nm = 0.005;
  Vectors force, torque;
  PressResult result;
  double error_Nm = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const DeviceState device{trace.hip_position_m[i], trace.hip_orientation[i]};
    const Wrench exact = press.wrench(device);
    force.push_back(exact.force_N), torque.push_back(exact.torque_Nm);
    error_Nm += (trace.torque_Nm[i] - exact.torque_Nm).norm();
    result.angle_deg.push_back(rotation_vector(device.orientation_W).y() / kRadiansPerDegree);
    result.torque_Nm.push_back(-trace.torque_Nm[i].y());
    result.exact_torque_Nm.push_back(-exact.torque_Nm.y());
  }
  result.force = deviation(trace.force_N, force, kSmallForce_N);
  result.torque = deviation(trace.torque_Nm, torque, kSmallTorque_Nm);
  result.torque_error_Nm = error_Nm / static_cast<double>(trace.length());
  return result;
}

// results[method][press]
using PressResults = std::vector<std::vector<PressResult>>;
PressResults results_of(FigureContext& context, const std::vector<ModelPress>& presses,
                        std::span<const ToolMethod> methods = kToolMethods) {
  std::vector<Experiment> runs;
  for (const ToolMethod& method : methods)
    for (const ModelPress& press : presses) runs.push_back(experiment_of(press, method));
  const std::vector<Trace> traces = context.run(runs);
  PressResults results(methods.size());
  for (std::size_t m = 0; m < results.size(); ++m)
    for (std::size_t p = 0; p < presses.size(); ++p)
      results[m].push_back(result_of(presses[p], traces[m * presses.size() + p]));
  return results;
}

Table deviation_table(const std::string& name, const std::string& title, const std::string& setting,
                      const std::string& what, const std::vector<ModelPress>& presses,
                      const PressResults& results) {
  Table table = table_over<ModelPress>(name, title, presses, {{setting, "deg", what, &ModelPress::setting}});
  for (std::size_t m = 0; m < results.size(); ++m) {
    const std::string column = kToolMethods[m].column;
    TableRows rows;
    for (const PressResult& r : results[m])
      rows.push_back({r.force.magnitude, r.force.missing, r.force.direction_deg, r.torque.magnitude,
                      r.torque.direction_deg, r.torque_error_Nm});
    add_rows(table,
             {{column + "_force", "1", "mean deviation of |force|, fraction"},
              {column + "_force_missing", "1", "fraction of ticks without a force"},
              {column + "_force_direction", "deg", "mean angle to the exact force, where there is one"},
              {column + "_torque", "1", "mean deviation of |torque|, fraction; NaN where none is exact"},
              {column + "_torque_direction", "deg", "mean angle to the exact torque, where there is one"},
              {column + "_torque_error", "N m", "mean of |torque - exact torque|"}},
             rows);
  }
  return table;
}

// Adds a panel of a quantity (a suffix of the columns) with a logarithmic axis, and its table. Values that
// are smaller than a limit are rounding: they are drawn at the limit.
void add_deviation_panel(Figure& figure, const Table& table, const std::string& title,
                         const std::string& quantity, const std::string& x_label,
                         std::pair<double, double> at) {
  const bool is_angle = quantity.ends_with("direction");
  const double least = is_angle ? kLeastAngle_deg : kLeastError;
  const std::string y_label = is_angle ? "angle to the exact force (deg)" : "relative error of " + quantity;
  Table drawn{table.name + "_" + quantity + "_drawn", title + ", as drawn", {table.columns[0]}};
  std::vector<Curve> curves;
  for (const ToolMethod& method : kToolMethods) {
    std::vector<double> values = numbers(table, std::string(method.column) + "_" + quantity);
    for (double& value : values) value = std::max(value, least);
    drawn.add(method.column, is_angle ? "deg" : "1", "value, or the least value that is drawn", values);
    curves.push_back({drawn.name, drawn.columns[0].name, method.column, CurveStyle::line, method.label});
  }
  figure.tables.push_back(drawn);
  figure.panels.push_back(plot(title, x_label, y_label, std::move(curves), {.at = at}));
}

Table slot_table(const PressResults& results) {
  const std::vector<double>& exact = results.front().front().exact_torque_Nm;
  Table table{"slot", "A bar turned between two walls: torque", {}};
  table.add("angle", "deg", "angle of the device", results.front().front().angle_deg);
  table.add("exact", "N m", "closed form", exact);
  for (std::size_t m = 0; m < results.size(); ++m) {
    const std::string column = kToolMethods[m].column;
    const std::vector<double>& torque = results[m].front().torque_Nm;
    std::vector<double> error;
    for (std::size_t i = 0; i < torque.size(); ++i) error.push_back(torque[i] - exact[i]);
    table.add(column, "N m", std::string("torque, ") + kToolMethods[m].label, torque);
    table.add(column + "_error", "N m", "torque - exact torque", error);
  }
  return table;
}

// The walls stop the bar at 22.6 deg.
Panel slot_panel(const Table& table, std::pair<double, double> at) {
  std::vector<Curve> curves;
  for (const ToolMethod& method : kToolMethods)
    curves.push_back(
        {table.name, "angle", std::string(method.column) + "_error", CurveStyle::line, method.label});
  return plot("Bar turned between two walls: torque", "angle of the device (deg)",
              "torque - exact torque (N m)", std::move(curves), {.at = at, .x_range = {{20, 32}}});
}

// A claim about the largest value in a column.
struct ColumnClaim {
  const char *claim, *column;
  double limit;
  const char* unit;
  bool at_least = false;  // a lower limit
};
void add_column_claims(const Claims& claims, const Table& table, const std::vector<ColumnClaim>& list) {
  for (const auto& [claim, column, limit, unit, at_least] : list) {
    const double measured = max_of(numbers(table, column));
    at_least ? claims.at_least(claim, measured, limit, unit) : claims.at_most(claim, measured, limit, unit);
  }
}

// The continuous rule and the god-object keep a gap of 0.05 mm, which is 1.7 % of the mean depth of a press.
constexpr double kGapFraction = 0.02;

void add_plane_claims(const Claims& claims, const Table& planes) {
  const double sinks = EvenSpring{}.stiffness_N_per_m / (EvenSpring{}.stiffness_N_per_m + 10 * 2400);
  add_column_claims(
      claims, planes,
      {{"on a tilted plane, look-ahead gives the exact force: largest relative deviation", "look_ahead_force",
        1e-3, "1"},
       {"on a tilted plane, look-ahead gives the exact direction of the force: largest angle to it",
        "look_ahead_force_direction", 0.01, "deg"},
       {"on a tilted plane, the continuous rule gives nearly the exact force: largest relative deviation",
        "continuous_force", kGapFraction, "1"},
       {"on a tilted plane, the god-object gives nearly the exact force: largest relative deviation",
        "god_object_force", kGapFraction, "1"},
       {"on a tilted plane, the god-object gives the exact direction of the force: largest angle to it",
        "god_object_force_direction", 0.01, "deg"},
       {"on a tilted plane, the printed rule gives the exact force: largest relative deviation",
        "voxels_force", 0.01, "1"}});
  claims.between(
      "on a level plane, the force of the penalty method is too small by k / (k + 10 k_p): relative "
      "deviation",
      numbers(planes, "penalty_force").front(), 0.9 * sinks, 1.1 * sinks, "1");
  add_column_claims(claims, planes,
                    {{"on a tilted plane, the steps of voxmap turn the force: largest angle to the exact one",
                      "voxmap_force_direction", 5, "deg", true}});
}

// The torque at a corner must be that of the force. The constrained motion (6.4) ends when the contacts hold
// the remaining displacement, multiplied by M. The coupling exerts on the hand k times that displacement, and
// k r^2 times the angle. Both agree if M is that of the coupling.
void add_block_claims(const Claims& claims, const Table& blocks, const Table& of_coupling) {
  add_column_claims(
      claims, blocks,
      {{"with a tilted block, the god-object with M of the coupling gives nearly the exact force: "
        "largest relative deviation",
        "god_object_force", kGapFraction, "1"},
       {"with a tilted block, the god-object with M of the coupling gives nearly the exact torque: "
        "largest relative deviation",
        "god_object_torque", kGapFraction, "1"},
       {"with a tilted block, look-ahead with M of the tool gives a wrong torque: largest relative deviation",
        "look_ahead_torque", 1, "1", true},
       {"with a tilted block, the printed rule with M of the tool gives a wrong torque: largest "
        "relative deviation",
        "voxels_torque", 1, "1", true}});
  add_column_claims(
      claims, of_coupling,
      {{"with a tilted block, look-ahead with M of the coupling gives the exact force: largest relative "
        "deviation",
        "look_ahead_force", 0.01, "1"},
       {"with a tilted block, look-ahead with M of the coupling gives the exact torque: largest "
        "relative deviation",
        "look_ahead_torque", 0.01, "1"}});
}

void add_groove_and_slot_claims(const Claims& claims, const Table& grooves, const Table& slot) {
  add_column_claims(
      claims, grooves,
      {{"in a valley, look-ahead gives nearly the exact force: largest relative deviation",
        "look_ahead_force", kGapFraction, "1"},
       {"in a valley, the god-object gives nearly the exact force: largest relative deviation",
        "god_object_force", 2 * kGapFraction, "1"},
       {"in a valley, look-ahead gives the exact direction of the force: largest angle to it",
        "look_ahead_force_direction", 0.5, "deg"},
       {"in a valley, look-ahead gives a force in every tick: largest fraction of ticks without one",
        "look_ahead_force_missing", 0, "1"},
       {"in a valley, the god-object gives a force in nearly every tick: largest fraction of ticks "
        "without one",
        "god_object_force_missing", 0.02, "1"},
       {"in a valley, the god-object gives nearly the exact direction of the force: largest angle to it",
        "god_object_force_direction", 2, "deg"},
       {"in a valley, voxmap turns the force: largest angle to the exact one", "voxmap_force_direction", 5,
        "deg", true}});
  const auto in_slot = [&](const std::string& method, const std::string& column, double limit_Nm) {
    claims.at_most(method + " gives the exact torque of a bar in a slot at 32 degrees: error",
                   std::abs(numbers(slot, column).back() - numbers(slot, "exact").back()), limit_Nm, "N m");
  };
  in_slot("look-ahead", "look_ahead", 1e-3);
  in_slot("the continuous rule", "continuous", 1e-3);
  in_slot("the god-object", "god_object", 1e-3);
  in_slot("the printed rule", "voxels", 0.01);
}

std::vector<Table> tables_of(FigureContext& context) {
  std::vector<ModelPress> planes, blocks, grooves;
  for (const double tilt_deg : {0.0, 5.0, 10.0, 20.0, 30.0, 40.0}) planes.push_back(on_plane(tilt_deg));
  for (const double turn_deg : {2.0, 4.0, 7.0, 10.0, 15.0, 20.0}) blocks.push_back(turned_block(turn_deg));
  for (const double slope_deg : {15.0, 30.0, 45.0}) grooves.push_back(in_groove(slope_deg));
  const std::string turn = "turn of the block, by the hand";
  return {deviation_table("planes", "A block on a tilted plane", "tilt", "tilt of plane and block", planes,
                          results_of(context, planes)),
          deviation_table("blocks", "A tilted block on a level plane", "turn", turn, blocks,
                          results_of(context, blocks)),
          deviation_table("grooves", "A ball in a valley", "slope", "slope of both sides", grooves,
                          results_of(context, grooves)),
          slot_table(results_of(context, {in_slot()})),
          deviation_table("of_coupling", "A tilted block, M of the coupling", "turn", turn, blocks,
                          results_of(context, blocks, {&kOfCoupling, 1}))};
}

}  // namespace

Figure figure_tool_forces(FigureContext& context) {
  Figure figure{
      kForcesFigure, "Force and torque of a tool against model scenes",
      "Presses of 6 mm in 0.4 s in which force and torque are known in closed form: a block of 40 x 10 mm "
      "on a plane that is tilted as the block is, and on a level plane where the hand tilts the block; a "
      "ball of 10 mm in a valley; a bar between two walls. Mean deviation from the closed form of magnitude "
      "and direction over the ticks with a force of 0.5 N or more; points 1.5 mm apart (slot: 2 mm), no "
      "noise; simulated. The axes of errors and angles are logarithmic. Smaller errors than 0.00001 are "
      "drawn at 0.00001, smaller angles than 0.0001 deg at 0.0001 deg. Protocol: Weller et al. 2010."};
  const std::vector<Table> tables = tables_of(context);
  figure.tables = tables;
  const std::string plane = "Block on a tilted plane: ", block = "Tilted block on a level plane: ";
  add_deviation_panel(figure, tables[0], plane + "force", "force", "tilt (deg)", {0, 0});
  add_deviation_panel(figure, tables[0], plane + "direction", "force_direction", "tilt (deg)", {0, 1});
  for (const std::string quantity : {"force", "torque"}) {
    add_deviation_panel(figure, tables[1], block + quantity, quantity, "tilt by the hand (deg)",
                        {1, quantity == "force" ? 0 : 1});
    figure.panels.back().curves.push_back(
        {"of_coupling", "turn", "look_ahead_" + quantity, CurveStyle::dashed, kOfCoupling.label});
  }
  add_deviation_panel(figure, tables[2], "Ball in a valley: direction", "force_direction", "slope (deg)",
                      {2, 0});
  figure.panels.push_back(slot_panel(tables[3], {2, 1}));
  const Claims claims(figure);
  add_plane_claims(claims, tables[0]);
  add_block_claims(claims, tables[1], tables[4]);
  add_groove_and_slot_claims(claims, tables[2], tables[3]);
  return figure;
}

}  // namespace remote_touch
