// Fig 7.5: the left valve is forbidden; guidance, activated by a button at 3 s, leads to the right one.
#include <algorithm>

#include "analysis/measures/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"
#include "runners/evaluation/figures/valve_task.h"

namespace remote_touch {

namespace {

constexpr double kRegion_m = 0.04;
constexpr double kPressed_s = 3;
constexpr double kClamp_N = 4;       // guidance.max_force_N of the experiment
constexpr double kLittle_Nm = 2e-3;  // torque caused by the noise of the target
constexpr double kPushed_s = 2.8, kArrived_s = 5.9;

// Returns the first tick in which guidance pulls; the length of the trace if it never does.
std::size_t first_pull(const Trace& t) {
  const auto first = std::find(t.guidance_active.begin(), t.guidance_active.end(), 1);
  return static_cast<std::size_t>(first - t.guidance_active.begin());
}

// Returns the mean magnitude of each torque component about the handle, over the last tenth of a second.
Vec3 residual_Nm(const Trace& t) {
  Vec3 sum = Vec3::Zero();
  const std::size_t from = tick_of(t, kArrived_s);
  for (std::size_t i = from; i < t.length(); ++i) sum += about_handle(t, i, t.torque_Nm[i]).cwiseAbs();
  return sum / double(t.length() - from);
}

double residual_N(const Trace& t) {
  double sum = 0;
  const std::size_t from = tick_of(t, kArrived_s);
  for (std::size_t i = from; i < t.length(); ++i) sum += t.force_N[i].norm();
  return sum / double(t.length() - from);
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
  claims.at_most("guidance ends at its goal: force at the end", residual_N(t), 0.2, "N", "decays");
  claims.at_most("guidance ends at its goal: torque about the handle's y and z at the end",
                 max_or_nan(residual_Nm(t).y(), residual_Nm(t).z()), kLittle_Nm, "N m");
  claims.at_least(
      "the tool stays out of the region round the true left valve: smallest distance of its mesh to the "
      "valve",
      min_clearance_m(task, Valve::left), kRegion_m - 1e-3, "m");
  add_task_claims(figure, task);
  checks.between("guidance begins to pull when the button is pressed: time", t.time_s[first], kPressed_s,
                 kPressed_s + 1e-9, "s", "about 3");
  checks.between("the first pull of guidance is cut at 4 N: force in that tick",
                 t.guidance_force_N[first].norm(), kClamp_N - 1e-9, kClamp_N + 1e-9, "N", "a step");
}

void add_roll_claims(Figure& figure, const ValveTask& five, const ValveTask& six) {
  const Claims claims(figure);
  claims.at_least(five.label + ": a torque about the roll axis remains: torque at the end",
                  residual_Nm(five.trace).x(), 10 * kLittle_Nm, "N m", "never reaches zero");
  claims.at_most(six.label + ": no torque about the roll axis remains: torque at the end",
                 residual_Nm(six.trace).x(), kLittle_Nm, "N m");
  claims.between(five.label + ": the task misses one step: number of missed steps",
                 five.trace.sequence_missed.back(), 1, 1, "steps");
  claims.at_most(six.label + ": the task misses no step: number of missed steps",
                 six.trace.sequence_missed.back(), 0, "steps");
}

// The run in column 0 has the letters of the pictures.
void add_panels(Figure& figure, const ValveTask& task, int column) {
  int row = 0;
  const auto add = [&](const std::string& title, const char* y_label, std::pair<double, double> y_range,
                       const std::vector<Curve>& curves) {
    Panel panel = plot(title, "time (s)", y_label, curves, {.at = {{row, column}}, .y_range = y_range});
    figure.panels.push_back(column == 0 && row < 2 ? lettered(panel) : panel);
    ++row;
  };
  add(task.label, "force (N)", {0, 8}, {{task.name, "time", "force", CurveStyle::line, ""}});
  add("", "torque (N m)", {0, 0.2}, {{task.name, "time", "torque", CurveStyle::line, ""}});
  add("", "torque about the handle's axes (N m)", {-0.2, 0.2},
      {{task.name, "time", "torque_x", CurveStyle::line, "roll (x)"},
       {task.name, "time", "torque_y", CurveStyle::line, "y"},
       {task.name, "time", "torque_z", CurveStyle::line, "z"},
       {task.name, "time", "exerted_x", CurveStyle::dashed, "exerted about roll"}});
}

Table target_table(const ValveTask& task) {
  const Trace& t = task.trace;
  TableRows rows;
  for (std::size_t i = first_pull(t); i < t.length(); ++i)
    if (t.frame_update(i))
      rows.push_back(
          {t.time_s[i], t.guidance_goal_m[i].x(), t.guidance_goal_m[i].y(), t.guidance_goal_m[i].z()});
  return table_of("goals", "where guidance leads to, by each frame",
                  {{"time", "s", "simulated time"}, {"x", "m", "x"}, {"y", "m", "y"}, {"z", "m", "z"}}, rows);
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

}  // namespace remote_touch
