// Examines whether (4.23), (4.24) and the 16 r_c/s of the predecessor [1] can come from one machine: a sweep
// over the number of proxy steps that a machine makes in a frame.
#include <algorithm>
#include <cmath>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "runners/evaluation/figures/parts/pop_through_map.h"

namespace remote_touch {

namespace {

constexpr double kFrames_hz = 30, kPrinted_rc_per_s = 16;
constexpr int kFastSteps = 1000;  // steps in a frame at the dissertation's own 30 kHz

// --- h and e_n over lifts without acceleration ---

struct NoiseMeans {
  double thickness_m = 0, at_end = 0, in_time = 0;  // h; e_n before an update, and over all steps
};

// Returns the means from the sixth update after the rise on, while the proxy is above the plane.
NoiseMeans noise_means(const Trace& t) {
  double frames = 0, ticks = 0;
  NoiseMeans sum;
  for (std::size_t i = 1; i + 1 < t.length(); ++i) {
    if (t.frame_index[i] < kRiseFrames + 5 || !(t.signed_distance_m[i] > 0)) continue;
    sum.in_time += 1 - t.normal[i].y(), ++ticks;
    if (!t.frame_update(i + 1)) continue;
    sum.thickness_m += t.signed_distance_m[i] - kLift.r1_m, sum.at_end += 1 - t.normal[i].y(), ++frames;
  }
  return {sum.thickness_m / frames, sum.at_end / frames, sum.in_time / ticks};
}

// One machine, with a row for each noise strength: the means over its lifts.
struct Machine {
  int steps = 0;  // number of steps in a frame
  std::vector<double> noise_m, thickness_m, at_end, in_time;
};

std::vector<Machine> machines(FigureContext& context, const Sweep& sweep, double steps_per_tick) {
  const SweepResult plan = sweep.plan();
  const std::vector<NoiseMeans> lifts = context.measure(sweep, noise_means);
  std::vector<Machine> list;
  for (std::size_t cell = 0; cell < plan.cell_count(); ++cell) {
    const double rate_hz = axis_value(plan, 0, cell);
    if (plan.axis_indices(cell)[1] == 0)
      list.emplace_back().steps = static_cast<int>(std::lround(steps_per_tick * rate_hz / kFrames_hz));
    NoiseMeans sum;
    double count = 0;
    for (int r = 0; r < plan.replicates; ++r) {
      const NoiseMeans& one = lifts[plan.run(cell, r)];
      if (std::isnan(one.thickness_m)) continue;  // popped through before the first update that counts
      sum.thickness_m += one.thickness_m, sum.at_end += one.at_end, sum.in_time += one.in_time, ++count;
    }
    Machine& to = list.back();
    to.noise_m.push_back(axis_value(plan, 1, cell));
    to.thickness_m.push_back(sum.thickness_m / count);
    to.at_end.push_back(sum.at_end / count), to.in_time.push_back(sum.in_time / count);
  }
  return list;
}

std::vector<Machine> all_machines(FigureContext& context) {
  std::vector<Machine> list = machines(context, Sweep::load("proxy-rates"), 1);
  const std::vector<std::string> fast = {"axes.0.values=[10000]", "renderer.steps_per_tick=3"};
  const std::vector<Machine> last = machines(context, Sweep::load("proxy-rates", fast), 3);
  list.insert(list.end(), last.begin(), last.end());
  return list;
}

// The lowest noise at which the fits are compared. Below it the printed digits allow almost no deviation, and
// (4.23) is up to 0.2 mm above every machine.
constexpr double kFromNoise_m = kContactRadius_m - 1e-9;
constexpr int kStrengths = 6;  // noise strengths of the sweep from kFromNoise_m on

// Returns the number of noise strengths from r_c on at which the means lie in what the printed digits allow.
int strengths_in_band(const PrintedFit& printed, const std::vector<double>& noise_m,
                      const std::vector<double>& values) {
  int inside = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    inside += noise_m[i] > kFromNoise_m &&
                      std::abs(values[i] - printed.at(noise_m[i])) <= printed.digits_band(noise_m[i])
                  ? 1
                  : 0;
  return inside;
}

// Returns the smaller of the two counts, for h and for e_n.
int strengths_as_printed(const Machine& m, const std::vector<double>& normal_error) {
  return std::min(strengths_in_band(printed_thickness(), m.noise_m, m.thickness_m),
                  strengths_in_band(printed_normal_error(), m.noise_m, normal_error));
}

double rms_from(const PrintedFit& printed, const std::vector<double>& noise_m,
                const std::vector<double>& values) {
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) squares += std::pow(values[i] - printed.at(noise_m[i]), 2);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

// --- the predecessor ---

// A noise-free plane that rises at a constant velocity for four seconds.
Experiment rise(int steps, double step_m, double velocity_m_per_s) {
  const bool fast = steps == kFastSteps;
  return Experiment::load(
      "fig4.12", {"scenario.noise_sigma_m=0", "scenario.acceleration_m_per_s2=0",
                  "scenario.start_velocity_m_per_s=" + std::to_string(velocity_m_per_s),
                  "scenario.start_depth_m=" + std::to_string(velocity_m_per_s / 2), "scenario.rise_s=4",
                  "scenario.acceleration_s=0", "duration_s=4", "renderer.velocity_estimate=false",
                  "renderer.step_rule=fixed", "renderer.fixed_step_m=" + std::to_string(step_m * 1e9) + "e-9",
                  fast ? "renderer.steps_per_tick=3" : "renderer.steps_per_tick=1",
                  std::string("haptic_rate_hz=").append(std::to_string(fast ? 10000 : steps * kFrames_hz))});
}

struct Predecessor {
  int steps;
  double step_m;
  double holds = 0, pops = 40;  // velocities, r_c/s: the largest tried without pop-through, the smallest with
};

// Finds the velocities by bisection.
std::vector<Predecessor> predecessors(FigureContext& context, const std::vector<int>& steps) {
  std::vector<Predecessor> list;
  for (const int count : steps) {
    for (const double step_m : {2e-5, 3.5e-5, 5e-5, 8e-5, 1e-4}) list.push_back({count, step_m});
    // The step whose sum over a frame is what 16 r_c/s need, and no more.
    list.push_back({count, kPrinted_rc_per_s * kContactRadius_m / kFrames_hz / count});
  }
  for (int halving = 0; halving < 8; ++halving) {
    std::vector<Experiment> runs;
    for (const Predecessor& p : list)
      runs.push_back(rise(p.steps, p.step_m, 0.5 * (p.holds + p.pops) * kContactRadius_m));
    const std::vector<double> popped = known_pop_throughs(context, runs);
    for (std::size_t i = 0; i < list.size(); ++i)
      (popped[i] > 0.5 ? list[i].pops : list[i].holds) = 0.5 * (list[i].holds + list[i].pops);
  }
  return list;
}

// Returns the velocity that is expected. The proxy cannot climb faster than by all its steps of a frame, and
// it is lost if an update moves the surface by more than r_1.
double expected_rc_per_s(const Predecessor& p) {
  return std::min(p.steps * p.step_m, kLift.r1_m) * kFrames_hz / kContactRadius_m;
}

double critical_rc_per_s(const Predecessor& p) {
  return 0.5 * (p.holds + p.pops);
}

Table predecessor_table(const std::vector<Predecessor>& list) {
  return table_over<Predecessor>(
      "predecessor", "velocity above which the predecessor pops through, without noise", list,
      {{"steps", "1", "proxy steps in a frame", &Predecessor::steps},
       {"step", "m", "length of a step", &Predecessor::step_m},
       {"critical", "r_c/s", "velocity above which it pops through", critical_rc_per_s},
       {"expected", "r_c/s", "steps times their length in a frame, at most r_1, times f_c",
        expected_rc_per_s}});
}

// The line on which measured and predicted velocities are equal.
Table equal_velocities() {
  TableRows rows;
  for (int velocity = 0; velocity <= 30; ++velocity) rows.push_back({1.0 * velocity, 1.0 * velocity});
  return table_of("equal", "velocities that are equal",
                  {{"predicted", "r_c/s", "predicted velocity"}, {"measured", "r_c/s", "measured velocity"}},
                  rows);
}

// --- the figure ---

std::string table_name(const Machine& machine) {
  return "steps_" + std::to_string(machine.steps);
}

Table machine_table(const Machine& m) {
  TableRows rows;
  for (std::size_t i = 0; i < m.noise_m.size(); ++i)
    rows.push_back({m.noise_m[i] / kContactRadius_m, m.thickness_m[i], m.at_end[i], m.in_time[i],
                    printed_thickness().at(m.noise_m[i]), printed_normal_error().at(m.noise_m[i])});
  return table_of(table_name(m), std::to_string(m.steps) + " proxy steps in a frame",
                  {kNoiseColumn,
                   {"thickness", "m", "h before an update, mean"},
                   {"at_end", "1", "e_n before an update, mean"},
                   {"in_time", "1", "e_n, mean over all steps of a frame"},
                   {"printed_thickness", "m", "(4.23)"},
                   {"printed_normal_error", "1", "(4.24)"}},
                  rows);
}

Table printed_table() {
  TableRows rows;
  for (int percent = 0; percent <= 200; percent += 2) {
    const double noise_m = 0.01 * percent * kContactRadius_m;
    rows.push_back({0.01 * percent, printed_thickness().at(noise_m), printed_normal_error().at(noise_m)});
  }
  return table_of("printed", "printed fits",
                  {kNoiseColumn, {"thickness", "m", "h (4.23)"}, {"normal_error", "1", "e_n (4.24)"}}, rows);
}

Table summary_table(const std::vector<Machine>& list) {
  const PrintedFit &h = printed_thickness(), &e = printed_normal_error();
  TableRows rows;
  for (const Machine& m : list) {
    const auto in_band = [&](const PrintedFit& fit, const std::vector<double>& values) {
      return static_cast<double>(strengths_in_band(fit, m.noise_m, values));
    };
    rows.push_back({static_cast<double>(m.steps), rms_from(h, m.noise_m, m.thickness_m),
                    in_band(h, m.thickness_m), rms_from(e, m.noise_m, m.at_end), in_band(e, m.at_end),
                    rms_from(e, m.noise_m, m.in_time), in_band(e, m.in_time), m.at_end.back(),
                    m.in_time.back()});
  }
  return table_of(
      "machines", "how near each machine comes to (4.23) and (4.24), noise to 2 r_c",
      {{"steps", "1", "proxy steps in a frame"},
       {"h_rms", "m", "h against (4.23), rms"},
       {"h_in_band", "1", "noise strengths, of 6 from r_c on, with h in what the digits of (4.23) allow"},
       {"at_end_rms", "1", "e_n before an update against (4.24), rms"},
       {"at_end_in_band", "1", "noise strengths with that in what the digits of (4.24) allow"},
       {"in_time_rms", "1", "e_n over all steps against (4.24), rms"},
       {"in_time_in_band", "1", "noise strengths with that in what the digits of (4.24) allow"},
       {"at_end_2_rc", "1", "e_n before an update at 2 r_c"},
       {"in_time_2_rc", "1", "e_n over all steps at 2 r_c"}},
      rows);
}

// Adds the claims about the predecessor [1]: its velocity limit follows from the sum of its steps in a
// frame.
void add_predecessor_claims(const Claims& claims, const std::vector<Predecessor>& list) {
  double max_apart = 0, least = 1e9, most = 0;
  const Predecessor* fast = nullptr;
  for (const Predecessor& p : list) {
    max_apart = max_or_nan(max_apart, std::abs(critical_rc_per_s(p) - expected_rc_per_s(p)));
    if (p.steps == kFastSteps && p.step_m > 0.9e-4) fast = &p;
    if (std::abs(expected_rc_per_s(p) - kPrinted_rc_per_s) > 1e-9) continue;
    least = min_or_nan(least, critical_rc_per_s(p)), most = max_or_nan(most, critical_rc_per_s(p));
  }
  // Tolerances: a fixed step of 0.1 mm may leave the proxy that much too low, it sinks 0.11 mm between four
  // points, and the bisection ends 0.16 r_c/s wide. A lag of r_1 in 3.5 s adds 0.3 r_c/s.
  constexpr double kApart = (1e-4 + 1.1e-4) * kFrames_hz / kContactRadius_m + 0.16, kSlow = 0.16 + 0.3;
  claims.at_most(
      "the predecessor [1] pops through above the velocity steps x length x f_c (at most r_1 f_c): "
      "largest difference",
      max_apart, kApart, "r_c/s");
  claims.between(
      "with 2.67 mm of steps in a frame the predecessor [1] pops through above 16 r_c/s: smallest "
      "velocity over the machines",
      least, kPrinted_rc_per_s - kSlow, kPrinted_rc_per_s + kSlow, "r_c/s", "16");
  claims.between(
      "with 2.67 mm of steps in a frame the predecessor [1] pops through above 16 r_c/s: largest "
      "velocity over the machines",
      most, kPrinted_rc_per_s - kSlow, kPrinted_rc_per_s + kSlow, "r_c/s", "16");
  claims.differs(
      "with steps of 0.1 mm at 30 kHz the predecessor [1] pops through above a higher velocity than "
      "printed: velocity",
      critical_rc_per_s(*fast), 28, 30, "r_c/s", "16");
}

void add_machine_claims(const Claims& claims, const std::vector<Machine>& list) {
  std::vector<double> between, slow, fast, at_end;  // numbers of strengths, one for each machine
  for (const Machine& m : list) {
    const int both = strengths_as_printed(m, m.in_time);
    if (m.steps >= 60 && m.steps <= 80) between.push_back(both);
    if (m.steps < 60) slow.push_back(both);
    if (m.steps == kFastSteps) fast.push_back(both);
    at_end.push_back(strengths_as_printed(m, m.at_end));
  }
  claims.at_least(
      "machines with 60, 70 and 80 steps per frame give h and e_n, averaged over time, in the digits of "
      "(4.23) and (4.24) at all 6 noise strengths from r_c to 2 r_c: smallest number of strengths",
      min_of(between), kStrengths, "strengths", "6");
  claims.differs(
      "machines with 33, 40 and 50 steps per frame do not give h and e_n, averaged over time, in the "
      "digits of (4.23) and (4.24) at all 6 noise strengths from r_c to 2 r_c: largest number of strengths",
      max_of(slow), 0, kStrengths - 1, "strengths", "6");
  claims.differs(
      "a machine with 1000 steps per frame (30 kHz, 4.3.4) does not give h and e_n, averaged over time, "
      "in the digits of (4.23) and (4.24) at all 6 noise strengths from r_c to 2 r_c: number of strengths",
      max_of(fast), 0, kStrengths - 1, "strengths", "6");
  claims.differs(
      "no machine gives h over time and e_n before an update in the digits of (4.23) and (4.24) at all "
      "6 noise strengths from r_c to 2 r_c: largest number of strengths",
      max_of(at_end), 0, kStrengths - 1, "strengths", "6");
}

// Returns a panel over noise with a curve for each of three machines, and the printed fit.
Panel noise_panel(const std::vector<Machine>& list, const std::string& title, const std::string& label,
                  const std::string& column, const std::string& printed) {
  Panel panel = plot(title, "noise (r_c)", label, {});
  for (const Machine* machine : {&list.front(), &list[list.size() - 2], &list.back()})
    panel.curves.push_back(
        {table_name(*machine), "noise", column, CurveStyle::line, std::to_string(machine->steps) + " steps"});
  panel.curves.push_back({"printed", "noise", printed, CurveStyle::dashed, "printed"});
  return panel;
}

void add_panels(Figure& figure, const std::vector<Machine>& list) {
  figure.panels = {
      noise_panel(list, "Thickness of the cloud (4.23)", "h (m)", "thickness", "thickness"),
      noise_panel(list, "Error of the normal before an update (4.24)", "e_n", "at_end", "normal_error"),
      noise_panel(list, "Error of the normal, mean over time (4.24)", "e_n", "in_time", "normal_error"),
      plot("Velocity that the predecessor holds", "predicted (r_c/s)", "measured (r_c/s)",
           {{"equal", "predicted", "measured", CurveStyle::dashed, "equal"},
            {"predecessor", "expected", "critical", CurveStyle::dots, "measured"}})};
  for (const std::size_t normal_error : {1, 2}) figure.panels[normal_error].y_range = {-0.01, 0.28};
  place_in_rows(figure, 2);
}

}  // namespace

Figure figure_proxy_rates(FigureContext& context) {
  const std::vector<Machine> list = all_machines(context);
  std::vector<int> steps;
  for (const Machine& machine : list) steps.push_back(machine.steps);
  const std::vector<Predecessor> before = predecessors(context, steps);
  Figure figure{
      "proxy-rates", "One machine for (4.23), (4.24) and 16 r_c/s?",
      "Can (4.23), (4.24) and the 16 r_c/s above which the predecessor (reference [1] of the dissertation) "
      "popped through come from one machine? Yes, from one that makes 60 to 80 proxy steps in a frame (1.8 "
      "to 2.4 kHz), if e_n is averaged over all steps of a frame, and if the fixed steps of the predecessor "
      "add up to 2.67 mm in a frame: 0.044 to 0.033 mm each. Then h and e_n lie in what the printed digits "
      "allow for all noise from r_c to 2 r_c. With 33 to 50 steps h is too large above 1.6 r_c; with 1000 "
      "steps, the 30 kHz that the dissertation names, e_n is about half as large as printed. e_n just "
      "before an update, which decides pop-through, is smaller than over time: no machine has it and h as "
      "printed. Below r_c no machine gives the printed h to its digits: it is up to 0.2 mm less. The "
      "velocity of the predecessor says nothing about the machine: without noise the predicted velocity is "
      "the steps of a frame times their length times f_c, and at most r_1 f_c = 30 r_c/s. Lifts without "
      "acceleration, 20 for each noise and machine; simulated."};
  for (const Machine& machine : list) figure.tables.push_back(machine_table(machine));
  for (Table& table :
       std::vector{summary_table(list), predecessor_table(before), printed_table(), equal_velocities()})
    figure.tables.push_back(std::move(table));
  add_panels(figure, list);
  const Claims claims(figure);
  add_machine_claims(claims, list);
  add_predecessor_claims(claims, before);
  return figure;
}

}  // namespace remote_touch
