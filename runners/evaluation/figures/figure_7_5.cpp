// Fig 7.5: the left valve is forbidden; guidance, activated by a button at 3 s, leads to the right one.
#include <algorithm>
#include <cmath>

#include "analysis/statistics/extremes.h"
#include "runners/evaluation/figures/fixture_run.h"
#include "runners/evaluation/figures/tools/tool_picture.h"
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
  const auto claim = [&](Claim made) { figure.claims.push_back(std::move(made)); };
  const std::string name = figure.name, opening = task.label + ": ";
  const std::size_t first = first_pull(t);
  if (first == t.length()) {
    claim(claim_not_run(name, opening + "guidance", "it never pulled"));
    return;
  }
  claim(claim_at_least(name, opening + "force of the region before, pushed to the left", "rises",
                       t.force_N[tick_of(t, kPushed_s)].norm(), 2, "N"));
  claim(claim_at_most(name, opening + "force at the end", "decays", residual_N(t), 0.2, "N"));
  claim(claim_at_most(name, opening + "torque about the handle's y and z at the end", "-",
                      max_or_nan(residual_Nm(t).y(), residual_Nm(t).z()), kLittle_Nm, "N m"));
  claim(claim_at_least(name, opening + "least distance of the tool's mesh to the true left valve", "-",
                       min_clearance_m(task, Valve::left), kRegion_m - 1e-3, "m"));
  add_task_claims(figure, task);
  claim(set_up(claim_between(name, opening + "when guidance begins to pull", "about 3", t.time_s[first],
                             kPressed_s, kPressed_s + 1e-9, "s")));
  claim(set_up(claim_between(name, opening + "its force in that tick, cut at 4 N", "a step",
                             t.guidance_force_N[first].norm(), kClamp_N - 1e-9, kClamp_N + 1e-9, "N")));
}

void add_roll_claims(Figure& figure, const ValveTask& five, const ValveTask& six) {
  const auto claim = [&](Claim made) { figure.claims.push_back(std::move(made)); };
  claim(claim_at_least(figure.name, five.label + ": torque about the roll axis at the end",
                       "never reaches zero", residual_Nm(five.trace).x(), 10 * kLittle_Nm, "N m"));
  claim(claim_at_most(figure.name, six.label + ": torque about the roll axis at the end", "-",
                      residual_Nm(six.trace).x(), kLittle_Nm, "N m"));
  claim(claim_between(figure.name, five.label + ": steps of the task that are missed", "-",
                      five.trace.sequence_missed.back(), 1, 1, "steps"));
  claim(claim_at_most(figure.name, six.label + ": steps of the task that are missed", "-",
                      six.trace.sequence_missed.back(), 0, "steps"));
}

Panel time_panel(const char* title, const char* label, int row, int column) {
  return {title, "time (s)", label, false, {}, {}, {}, std::pair(double(row), double(column))};
}

void add_panels(Figure& figure, const ValveTask& task, int column) {
  Panel force = time_panel(task.label.c_str(), "force (N)", 0, column);
  Panel torque = time_panel("", "torque (N m)", 1, column);
  Panel axes = time_panel("", "torque about the handle's axes (N m)", 2, column);
  force.curves = {{task.name, "time", "force", CurveStyle::line, ""}};
  torque.curves = {{task.name, "time", "torque", CurveStyle::line, ""}};
  axes.curves = {{task.name, "time", "torque_x", CurveStyle::line, "roll (x)"},
                 {task.name, "time", "torque_y", CurveStyle::line, "y"},
                 {task.name, "time", "torque_z", CurveStyle::line, "z"},
                 {task.name, "time", "exerted_x", CurveStyle::dashed, "exerted about roll"}};
  force.y_range = std::pair(0.0, 8.0);
  torque.y_range = std::pair(0.0, 0.2), axes.y_range = std::pair(-0.2, 0.2);
  for (const Panel& panel : {force, torque, axes}) figure.panels.push_back(panel);
}

Table target_table(const ValveTask& task) {
  const Trace& t = task.trace;
  std::vector<std::vector<double>> rows;
  for (std::size_t i = first_pull(t); i < t.length(); ++i)
    if (t.frame_update(i))
      rows.push_back(
          {t.time_s[i], t.guidance_goal_m[i].x(), t.guidance_goal_m[i].y(), t.guidance_goal_m[i].z()});
  return table_of("goals", "where guidance leads to, by each frame",
                  {{"time", "s", "simulated time"}, {"x", "m", "x"}, {"y", "m", "y"}, {"z", "m", "z"}}, rows);
}

}  // namespace

Figure figure_7_5(const FigureContext& context) {
  const std::vector<ValveTask> tasks = run_tasks(
      context,
      {{"five", "Five motors", "fig7.5"}, {"six", "Six motors", "fig7.5", {"device.torque_x=true"}}});
  Figure figure{
      "7.5", "Guidance to one valve, a forbidden region around the other",
      "The simulated operator pushes towards the left valve, presses the button at 3 s and relaxes "
      "within 0.3 s. The spring to the goal in front of the right valve, the mean of the yellow points, "
      "jumps to its clamp and pulls the hand there. Left: a device without a motor about its roll axis, "
      "as in the paper: the torque about it is commanded but not exerted, so the angle about it remains. "
      "Right: the same with all six motors. Everything is simulated."};
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    figure.tables.push_back(task_table(tasks[i]));
    figure.tables.push_back(sequence_table(tasks[i]));
    add_panels(figure, tasks[i], static_cast<int>(i));
    add_common_claims(figure, tasks[i]);
  }
  figure.tables.push_back(target_table(tasks[0]));
  add_roll_claims(figure, tasks[0], tasks[1]);
  const Trace& t = tasks[0].trace;
  add_task_picture_tables(figure, context, tasks[0], {tick_of(t, kPushed_s), t.length() - 1});
  figure.panels.push_back(task_picture(tasks[0], "B) pushed to the left", 0, 3, 0));
  figure.panels.push_back(task_picture(tasks[0], "D) at the goal, but for the roll", 1, 3, 1));
  return figure;
}

}  // namespace remote_touch
