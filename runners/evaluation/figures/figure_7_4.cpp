// Fig 7.4: the operator pushes towards the left valve, then the right one, both with 4 cm forbidden regions.
#include <algorithm>
#include <cmath>

#include "analysis/measures/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"
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

// Returns the number of pushes: how often the force rises above 0.1 N.
int pushes(const Trace& t) {
  int count = 0;
  for (std::size_t i = 1; i < t.length(); ++i)
    if (t.force_N[i].norm() > 0.1 && t.force_N[i - 1].norm() <= 0.1) ++count;
  return count;
}

// Returns the largest force over the ticks in which no leaf is within the look-ahead of a region; NaN if
// there are none.
double max_free_force_N(const Trace& t) {
  return max_where(
      t.length(), [&](std::size_t i) { return std::isinf(t.nearest_distance_m[i]) && t.frame_index[i] >= 0; },
      [&](std::size_t i) { return t.force_N[i].norm(); });
}

double max_torque_Nm(const Trace& t, double from_s, double until_s) {
  double max = 0;
  for (std::size_t i = tick_of(t, from_s); i < tick_of(t, until_s); ++i)
    max = max_or_nan(max, t.torque_Nm[i].norm());
  return max;
}

void add_push_claims(Figure& figure, const ValveTask& task, const char* side, double held_s) {
  const Trace& t = task.trace;
  const std::size_t held = tick_of(t, held_s);
  const std::string valve = side;
  const Claims claims(figure), checks(figure, "", &Claim::set_up);
  claims.between("the region of the " + valve + " valve pushes the tool back: force", t.force_N[held].norm(),
                 5, 8, "N", "rises when pushed");
  claims.at_least("the region of the " + valve + " valve turns the tool back: largest torque",
                  max_torque_Nm(t, held_s - 1, held_s + 1), 0.01, "N m", "rises when pushed");
  checks.between(
      "the device is pushed into the region of the " + valve + " valve: its distance from the tool",
      lag_m(t, held), 0.018, 0.022, "m");
}

void add_claims(Figure& figure, const ValveTask& task) {
  const Trace& t = task.trace;
  const Claims claims(figure);
  claims.at_most("no force acts while nothing is within the look-ahead: largest force", max_free_force_N(t),
                 0, "N", "0");
  claims.between("the tool is pushed against two regions: times that the force rises from zero", pushes(t), 2,
                 2, "times", "2");
  for (const double free_s : {kStart_s, kBetween_s, t.time_s.back()})
    claims.at_most("no force acts in free space: force at " + std::to_string(free_s).substr(0, 4) + " s",
                   t.force_N[tick_of(t, free_s)].norm(), 0, "N", "0");
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

// Returns the ticks of the four moments A to D of the caption.
std::vector<std::size_t> moments_7_4(const Trace& t) {
  return {tick_of(t, kStart_s), tick_of(t, kHeldLeft_s), tick_of(t, kHeldRight_s), t.length() - 1};
}

Panel time_panel(const ValveTask& task, const char* title, const char* column, const char* label, int row) {
  return plot(title, "time (s)", label, {{task.name, "time", column, CurveStyle::line, ""}}, {{{row, 0}}});
}

Table summary_table(const std::vector<ValveTask>& tasks) {
  using Task = const ValveTask&;
  return quantity_table<ValveTask>(
      "runs", "both runs", {tasks[0].name, tasks[1].name}, tasks,
      {{"least distance of the mesh to the left valve", "m",
        [](Task task) { return min_clearance_m(task, Valve::left); }},
       {"least distance of the mesh to the right valve", "m",
        [](Task task) { return min_clearance_m(task, Valve::right); }},
       {"most pairs of leaves that touch", "1",
        [](Task task) {
          return *std::max_element(task.trace.contact_count.begin(), task.trace.contact_count.end());
        }},
       {"collision detections in a tick, mean", "1",
        [](Task task) {
          double sum = 0;
          for (const int n : task.trace.detections) sum += n;
          return sum / double(task.trace.length());
        }},
       {"ticks that used up their detections", "1", [](Task task) {
          return std::count(task.trace.budget_exhausted.begin(), task.trace.budget_exhausted.end(), 1);
        }}});
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
  for (const ValveTask& task : tasks) figure.tables.push_back(task_table(task));
  figure.tables.push_back(summary_table(tasks));
  figure.tables.push_back(moment_table("A: start, B: pushed to the left, C: pushed to the right, D: end",
                                       tasks[0].trace, moments_7_4(tasks[0].trace)));
  figure.panels = {lettered(time_panel(tasks[0], "First task", "force", "force (N)", 0)),
                   lettered(time_panel(tasks[0], "", "torque", "torque (N m)", 1)),
                   time_panel(tasks[1], "Pushed deep beside the middle", "force", "force (N)", 2)};
  add_task_picture_tables(figure, context, tasks[0], moments_7_4(tasks[0].trace));
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

}  // namespace remote_touch
