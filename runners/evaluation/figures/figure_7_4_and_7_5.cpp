// Fig 7.4: the operator pushes towards the left valve, then the right one, both with 4 cm forbidden regions.

#include <algorithm>
#include <cmath>

#include "analysis/trace/interval_estimates.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/figure_pictures.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/evaluation/figures/valve_task.h"

namespace remote_touch {

namespace {

constexpr double kValveRegion_m = 0.04;
constexpr double kHeldLeft_s = 2.75, kHeldRight_s = 6.25;  // middles of the two pushes
constexpr double kBetween_s = 4.5;                         // halfway between the pushes: no force
constexpr double kStart_s = 0.25;

// A push beside the left valve's middle, 6 cm deeper than the first.
const char* const kOffCentre =
    "trajectory.poses=[[-0.105,0.075,0.28,0,90,0,0],[-0.105,0.075,0.28,0,90,0,0.5],"
    "[-0.105,0.075,0.10,0,90,0,2],[-0.105,0.075,0.10,0,90,0,1]]";

void add_push_claims(Figure& figure, const ValveTask& task, const char* side, double held_s) {
  const Trace& t = task.trace;
  const std::size_t held = tick_of(t, held_s);
  const std::string valve = side;
  const Claims claims(figure), checks(figure, "", &Claim::set_up);
  claims.between("the region of the " + valve + " valve pushes the tool back: force", t.force_N[held].norm(),
                 5, 8, "N", "rises when pushed");
  const std::size_t before = tick_of(t, held_s - 1), after = tick_of(t, held_s + 1);
  const auto is_near = [&](std::size_t i) { return i >= before && i < after; };
  claims.at_least("the region of the " + valve + " valve turns the tool back: largest torque",
                  max_of(where(norms(t.torque_Nm), is_near)), 0.01, "N m", "rises when pushed");
  checks.between(
      "the device is pushed into the region of the " + valve + " valve: its distance from the tool",
      lag_m(t, held), 0.018, 0.022, "m");
}

void add_claims(Figure& figure, const ValveTask& task) {
  const Trace& t = task.trace;
  const Claims claims(figure);
  const Numbers force_N = norms(t.force_N);
  const auto is_free = [&](std::size_t i) {
    return std::isinf(t.nearest_distance_m[i]) && t.frame_index[i] >= 0;
  };
  const auto rises = [&](std::size_t i) { return i > 0 && force_N[i] > 0.1 && force_N[i - 1] <= 0.1; };
  claims.at_most("no force acts while nothing is within the look-ahead: largest force",
                 max_of(where(force_N, is_free)), 0, "N", "0");
  claims.between("the tool is pushed against two regions: times that the force rises from zero",
                 count_where(t.length(), rises), 2, 2, "times", "2");
  for (const double free_s : {kStart_s, kBetween_s, t.time_s.back()})
    claims.at_most("no force acts in free space: force at " + std::to_string(free_s).substr(0, 4) + " s",
                   force_N[tick_of(t, free_s)], 0, "N", "0");
  add_push_claims(figure, task, "left", kHeldLeft_s);
  add_push_claims(figure, task, "right", kHeldRight_s);
  for (const Valve valve : {Valve::left, Valve::right})
    claims.at_least(std::string("the tool stays at least 39 mm away from the true ") +
                        (valve == Valve::left ? "left" : "right") +
                        " valve, whose region has 40 mm: smallest distance of its mesh",
                    min_clearance_m(task, valve), kValveRegion_m - 1e-3, "m");
  add_task_claims(figure, task);
}

// Adds the claims about a deep push beside the middle, in which the tool slips round the valve. The
// dissertation does not claim this; the behaviour is only reported.
void add_slip(Figure& figure, const ValveTask& slip) {
  const Trace& t = slip.trace;
  const Claims claims(figure, slip.label + ": ");
  const std::size_t last = t.length() - 1;
  const Vec3 aside = t.proxy_position_m[last] - t.intended_position_m[last];
  claims.at_least("the tool is pushed up and past the valve: height", aside.y(), 0.01, "m");
  claims.at_least(
      "the tool stays at least 39 mm away from the true valve, whose region has 40 mm: smallest distance of "
      "its mesh",
      min_clearance_m(slip, Valve::left), kValveRegion_m - 1e-3, "m");
  add_task_claims(figure, slip);
}

Table summary_table(const std::vector<ValveTask>& tasks) {
  using Task = const ValveTask&;
  return quantity_table<ValveTask>(
      "runs", "both runs", {tasks[0].name, tasks[1].name}, tasks,
      {{"least distance of the mesh to the left valve", "m",
        [](Task task) { return min_clearance_m(task, Valve::left); }},
       {"least distance of the mesh to the right valve", "m",
        [](Task task) { return min_clearance_m(task, Valve::right); }},
       {"most pairs of leaves that touch", "1", [](Task task) { return most(task.trace.contact_count); }},
       {"collision detections in a tick, mean", "1",
        [](Task task) { return mean(doubles(task.trace.detections)); }},
       {"ticks that used up their detections", "1",
        [](Task task) { return std::ranges::count(task.trace.budget_exhausted, 1); }}});
}

}  // namespace

Figure figure_7_4(FigureContext& context) {
  const std::vector<ValveTask> tasks = run_tasks(
      context, {{"task", "first task", "fig7.4"},
                {"slip", "pushed deep beside the middle", "fig7.4", {kOffCentre, "duration_s=3.5"}}});
  Figure figure{
      "7.4", "Forbidden regions around two valves",
      "A simulated camera sees two handwheels in a tank of turbid water; the points of both hues get "
      "regions of 40 mm. A simulated operator (a mass drawn to its path by a spring) moves a valve "
      "key of 112 spheres: A) starts, B) pushes towards the left valve, C) towards the right one, D) "
      "leaves. The letters in the traces and the pictures are the same four moments. The pictures show tool "
      "(filled) and device (transparent); the last one is a push deep beside the left valve's middle, where "
      "the tool slips round. Everything is simulated."};
  const Trace& t = tasks[0].trace;
  const std::vector<std::size_t> moments = {tick_of(t, kStart_s), tick_of(t, kHeldLeft_s),
                                            tick_of(t, kHeldRight_s), t.length() - 1};
  for (const ValveTask& task : tasks) figure.tables.push_back(task_table(task));
  figure.tables.push_back(summary_table(tasks));
  figure.tables.push_back(
      moment_table("A: start, B: pushed to the left, C: pushed to the right, D: end", t, moments));
  PanelColumn panels{figure, tasks[0].name, "time", "time (s)"};
  add_letters(panels.add("First task", "force (N)", {{"force"}}));
  add_letters(panels.add("", "torque (N m)", {{"torque"}}));
  panels.table = tasks[1].name;
  panels.add("Pushed deep beside the middle", "force (N)", {{"force"}});
  add_task_picture_tables(figure, context, tasks[0], moments);
  add_task_picture_tables(figure, context, tasks[1], {tasks[1].trace.length() - 1});
  figure.panels.push_back(task_picture(tasks[0], "A) at the start", 0, 0, 1));
  figure.panels.push_back(task_picture(tasks[0], "B) pushed to the left", 1, 0, 2));
  figure.panels.push_back(task_picture(tasks[0], "C) pushed to the right", 2, 1, 1));
  figure.panels.push_back(task_picture(tasks[0], "D) at the end", 3, 1, 2));
  figure.panels.push_back(task_picture(tasks[1], "Slipped round, at the end", 0, 2, 1));
  add_claims(figure, tasks[0]);
  add_slip(figure, tasks[1]);
  return figure;
}

// Fig 7.5: the left valve is forbidden; guidance, activated by a button at 3 s, leads to the right one.

namespace {

constexpr double kPressed_s = 3;
constexpr double kClamp_N = 4;       // guidance.max_force_N of the experiment
constexpr double kLittle_Nm = 2e-3;  // torque caused by the noise of the target
constexpr double kPushed_s = 2.8, kArrived_s = 5.9;

// Returns the first tick in which guidance pulls; the length of the trace if it never does.
std::size_t first_pull(const Trace& t) {
  const auto first = std::find(t.guidance_active.begin(), t.guidance_active.end(), 1);
  return static_cast<std::size_t>(first - t.guidance_active.begin());
}

// Returns the mean of value(i) over the last tenth of a second.
template <class Value>
double at_end(const Trace& t, Value&& value) {
  const std::size_t from = tick_of(t, kArrived_s);
  return mean_where(
      t.length(), [&](std::size_t i) { return i >= from; }, value);
}

// Returns the mean magnitude of a component of the torque about the handle at the end.
double residual_Nm(const Trace& t, int axis) {
  return at_end(t, [&](std::size_t i) { return std::abs(about_handle(t, i, t.torque_Nm[i])[axis]); });
}

void add_common_claims(Figure& figure, const ValveTask& task) {
  const Trace& t = task.trace;
  const std::string opening = task.label + ": ";
  const Claims claims(figure, opening), checks(figure, opening, &Claim::set_up);
  const std::size_t first = first_pull(t);
  if (first == t.length()) {
    claims.at_least("guidance pulls the hand", 0, 1, "1");
    return;
  }
  claims.at_least("before guidance the region pushes the tool back from the left valve: force",
                  t.force_N[tick_of(t, kPushed_s)].norm(), 2, "N", "rises");
  claims.at_most("guidance ends at its goal: force at the end",
                 at_end(t, [&](std::size_t i) { return t.force_N[i].norm(); }), 0.2, "N", "decays");
  claims.at_most("guidance ends at its goal: torque about the handle's y and z at the end",
                 max_or_nan(residual_Nm(t, 1), residual_Nm(t, 2)), kLittle_Nm, "N m");
  claims.at_least(
      "the tool stays out of the region round the true left valve: smallest distance of its mesh to the "
      "valve",
      min_clearance_m(task, Valve::left), kValveRegion_m - 1e-3, "m");
  add_task_claims(figure, task);
  checks.between("guidance begins to pull when the button is pressed: time", t.time_s[first], kPressed_s,
                 kPressed_s + 1e-9, "s", "about 3");
  checks.between("the first pull of guidance is cut at 4 N: force in that tick",
                 t.guidance_force_N[first].norm(), kClamp_N - 1e-9, kClamp_N + 1e-9, "N", "a step");
}

void add_roll_claims(Figure& figure, const ValveTask& five, const ValveTask& six) {
  const Claims claims(figure);
  claims.at_least(five.label + ": a torque about the roll axis remains: torque at the end",
                  residual_Nm(five.trace, 0), 10 * kLittle_Nm, "N m", "never reaches zero");
  claims.at_most(six.label + ": no torque about the roll axis remains: torque at the end",
                 residual_Nm(six.trace, 0), kLittle_Nm, "N m");
  claims.between(five.label + ": the task misses one step: number of missed steps",
                 five.trace.sequence_missed.back(), 1, 1, "steps");
  claims.at_most(six.label + ": the task misses no step: number of missed steps",
                 six.trace.sequence_missed.back(), 0, "steps");
}

// The run in column 0 has the letters of the pictures.
void add_panels(Figure& figure, const ValveTask& task, int column) {
  PanelColumn panels{figure, task.name, "time", "time (s)", column};
  panels.add(task.label, "force (N)", {{"force"}}, {{0, 8}});
  panels.add("", "torque (N m)", {{"torque"}}, {{0, 0.2}});
  if (column == 0)
    for (Panel& panel : figure.panels) add_letters(panel);
  panels.add("", "torque about the handle's axes (N m)",
             {{"torque_x", CurveStyle::line, "roll (x)"},
              {"torque_y", CurveStyle::line, "y"},
              {"torque_z", CurveStyle::line, "z"},
              {"exerted_x", CurveStyle::dashed, "exerted about roll"}},
             {{-0.2, 0.2}});
}

Table target_table(const ValveTask& task) {
  const Trace& t = task.trace;
  std::vector<std::size_t> ticks;
  for (std::size_t i = first_pull(t); i < t.length(); ++i)
    if (t.frame_update(i)) ticks.push_back(i);
  Table table = position_table("goals", "where guidance leads to, by each frame", t.guidance_goal_m);
  table.columns.insert(table.columns.begin(), {"time", "s", "simulated time", t.time_s});
  return rows_of(std::move(table), ticks);
}

// Fig 7.5 for other stiffnesses of guidance, with six motors and with five: where the hand is led.

// Returns the results at the end of the task for one device, a row for each stiffness of guidance.
Table guided_table(const SweepResult& sweep, std::size_t motors, const char* name, const std::string& label) {
  const auto of = [&](const char* measure) { return measured(sweep, measure, {{}, motors}); };
  const auto degrees = [](double rad) { return rad / kRadiansPerDegree; };
  const auto mm = [](double m) { return 1e3 * m; };
  return {
      name,
      "end of the task, " + label,
      {{"stiffness", "N/m", "stiffness of guidance", axis_values(sweep, 0)},
       {"error", "mm", "distance of the tool from the goal at the end", each(of("guidance_error"), mm)},
       {"angle", "deg", "angle between tool and goal at the end", each(of("guidance_error_angle"), degrees)},
       {"clearance", "mm", "minimum gap between the tool and a region", each(of("min_clearance"), mm)}}};
}

Panel guided_panel(const std::string& title, const std::string& column, const std::string& y_label) {
  return plot(title, "stiffness of guidance (N/m)", y_label,
              {{"six_motors", "stiffness", column, CurveStyle::line, "six motors"},
               {"five_motors", "stiffness", column, CurveStyle::dashed, "no motor about x"}});
}

}  // namespace

Figure figure_7_5(FigureContext& context) {
  const std::vector<ValveTask> tasks = run_tasks(
      context,
      {{"five", "Five motors", "fig7.5"}, {"six", "Six motors", "fig7.5", {"device.torque_x=true"}}});
  Figure figure{
      "7.5", "Guidance to one valve, a forbidden region around the other",
      "The simulated operator pushes towards the left valve, presses the button at 3 s and relaxes "
      "within 0.3 s. The spring to the goal in front of the right valve, the mean of the yellow points, "
      "jumps to its clamp and pulls the hand there. Left: a device without a motor about its roll axis, "
      "as in the paper: the torque about it is commanded but not exerted, so the angle about it remains. "
      "Right: the same with all six motors. Both pictures are of the run with five motors: A) the tool is "
      "pushed towards the left valve, B) it is at the goal, except for its angle about the roll axis. The "
      "letters in the traces are the same two moments. Everything is simulated."};
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    figure.tables.push_back(task_table(tasks[i]));
    figure.tables.push_back(sequence_table(tasks[i]));
    add_panels(figure, tasks[i], static_cast<int>(i));
    add_common_claims(figure, tasks[i]);
  }
  figure.tables.push_back(target_table(tasks[0]));
  add_roll_claims(figure, tasks[0], tasks[1]);
  const Trace& t = tasks[0].trace;
  const std::vector<std::size_t> moments = {tick_of(t, kPushed_s), t.length() - 1};
  figure.tables.push_back(
      moment_table("A: pushed to the left, B: at the goal, except for the roll", t, moments));
  add_task_picture_tables(figure, context, tasks[0], moments);
  figure.panels.push_back(task_picture(tasks[0], "A) five motors, pushed to the left", 0, 3, 0));
  figure.panels.push_back(task_picture(tasks[0], "B) five motors, at the goal except for the roll", 1, 3, 1));
  return figure;
}

Figure figure_7_5_guidance(FigureContext& context) {
  const SweepResult sweep = context.sweep(Sweep::load("fig7.5-guidance"));  // torque_x: true, false
  const Table six = guided_table(sweep, 0, "six_motors", "six motors"),
              five = guided_table(sweep, 1, "five_motors", "no motor about x");
  const Numbers& five_deg = numbers(five, "angle");
  const auto both = [&](const char* column, const auto& extreme) {
    return extreme(Numbers{extreme(numbers(six, column)), extreme(numbers(five, column))});
  };
  Figure figure{
      "7.5-guidance", "Where guidance leads the hand",
      "The task of Fig 7.5 with guidance of 50 to 300 N/m, frames at 10 Hz, a device with six motors and "
      "one without torque about x; simulated. The operator has relaxed at 3.3 s. The position is reached in "
      "both cases. Without the motor an error of the angle remains at every stiffness of guidance."};
  figure.tables = {six, five};
  figure.panels = {guided_panel("Distance from the goal", "error", "distance (mm)"),
                   guided_panel("Angle to the goal", "angle", "angle (deg)")};
  const Claims claims(figure);
  claims.at_most("the hand arrives at the goal in all runs: largest distance at the end",
                 both("error", max_of), 2, "mm");
  claims.at_most("six motors: the tool turns to the goal: largest angle to it at the end",
                 max_of(numbers(six, "angle")), 0.1, "deg");
  claims.at_least("five motors: the tool stays turned away from the goal: smallest angle to it at the end",
                  min_of(five_deg), 20, "deg");
  claims.at_most(
      "five motors: the final angle to the goal hardly depends on the stiffness of guidance: largest "
      "difference",
      max_of(five_deg) - min_of(five_deg), 1, "deg");
  claims.at_least("the tool stays out of the forbidden region: smallest gap of all ticks",
                  both("clearance", min_of), -0.1, "mm");
  return figure;
}

}  // namespace remote_touch
