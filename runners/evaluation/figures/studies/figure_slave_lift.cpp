// Fig 4.12 with a slave: the surface rises, the command follows it from frame to frame, and the surface
// pushes the slave, whose command is late.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/tool_and_slave_measures.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/slave_tasks.h"

namespace remote_touch {

namespace {

constexpr double kFrame_s = 1 / kSlaveFrameRate_hz;

constexpr double kLiftEnd_s = 0.2;  // the end of the run, in which the plane accelerates

struct SlaveLift {
  RemoteSide remote;
  double force_N = 0, derived_N = 0;  // mean over the window
  double peak_N = 0;                  // of the whole run
  double error_m = 0;                 // of the command that is sent
};

// Returns the height of the true plane, from the proxy over it; after the run: at its end.
double plane_m(const Trace& trace, double time_s) {
  const double ticks = std::clamp(time_s / kSlaveTick_s, 0.0, static_cast<double>(trace.length() - 1));
  const auto i = std::min(static_cast<std::size_t>(ticks), trace.length() - 2);
  const auto height_m = [&](std::size_t k) {
    return trace.proxy_position_m[k].y() - trace.signed_distance_m[k];
  };
  return std::lerp(height_m(i), height_m(i + 1), ticks - static_cast<double>(i));
}

// Returns the mean force f on a slave that stays on the plane y while its command shows the plane as it was
// t_d before, y_d; t_d is the delay and half a frame interval. The momentum in the window gives
// m y'' = f + m w^2 (y_d - x) + 2 m w (y_d' - y'). The contact is a spring as well, so x = y - f / K.
double derived_force_N(const Trace& trace, const RemoteSide& remote) {
  const double w = 2 * std::numbers::pi * remote.frequency_hz, end_s = trace.time_s.back();
  const double begin_s = end_s - kLiftEnd_s, late_s = remote.delay_s + kFrame_s / 2;
  const auto rise = [&](double from_s) {
    return plane_m(trace, from_s + kLiftEnd_s) - plane_m(trace, from_s);
  };
  double ahead_m = 0;
  int count = 0;
  for (double t = begin_s; t < end_s; t += kSlaveTick_s, ++count)
    ahead_m += plane_m(trace, t) - plane_m(trace, t - late_s);
  const double acceleration = kLift_m_per_s2 + w * w * ahead_m / count +
                              2 * w * (rise(begin_s) - rise(begin_s - late_s)) / kLiftEnd_s;
  return kSlaveMass_kg * acceleration / (1 + kSlaveMass_kg * w * w / kSlaveStiffness_N_per_m);
}

double mean_force_N(const Trace& trace) {
  return mean_where(
      trace.length(), [&](std::size_t i) { return trace.time_s[i] > trace.time_s.back() - kLiftEnd_s; },
      [&](std::size_t i) { return trace.slave_force_N[i].y(); });
}

// Returns the largest distance of the command, just before each update, from where it rests on the plane of
// the newest frame.
double command_error_m(const Trace& trace) {
  return max_where(
      trace.length() - 1,
      [&](std::size_t i) { return trace.time_s[i] > kLiftFrom_s && trace.frame_update(i + 1); },
      [&](std::size_t i) {
        const double seen_m = plane_m(trace, trace.frame_index[i] * kFrame_s);
        return std::abs(trace.slave_command_m[i].y() - seen_m - stopped_height_m(0));
      });
}

std::vector<SlaveLift> lifts(FigureContext& context) {
  std::vector<SlaveLift> all;
  std::vector<Experiment> runs;
  for (const double frequency_hz : kSlaveFrequencies_hz)
    for (const double delay_s : kLinkDelays_s) {
      all.push_back({{frequency_hz, delay_s}});
      runs.push_back(lift_task(all.back().remote));
    }
  const std::vector<Trace> traces = context.run(runs);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].force_N = mean_force_N(traces[i]);
    all[i].derived_N = derived_force_N(traces[i], all[i].remote);
    all[i].peak_N = max_slave_force_N(traces[i]);
    all[i].error_m = command_error_m(traces[i]);
  }
  return all;
}

Panel course_panel(Figure& figure, FigureContext& context) {
  const Trace trace = context.run(lift_task({2, 0.1}));
  TableRows rows;
  for (std::size_t i = 400; i < trace.length(); ++i)
    rows.push_back({trace.time_s[i], plane_m(trace, trace.time_s[i]),
                    trace.slave_command_m[i].y() - kSlaveRadius_m,
                    trace.slave_position_m[i].y() - kSlaveRadius_m, trace.slave_force_N[i].y()});
  figure.tables.push_back(table_of("course", "a slave of 2 Hz, 0.1 s late",
                                   {{"time", "s", "time"},
                                    {"plane", "m", "height of the true plane"},
                                    {"command", "m", "height of the lower end of the commanded ball"},
                                    {"slave", "m", "height of the lower end of the slave's ball"},
                                    {"force", "N", "force of the plane on the slave"}},
                                   rows));
  return plot("2 Hz, 0.1 s: lower end of the ball", "time (s)", "y (m)",
              {{"course", "time", "plane", CurveStyle::dashed, "true plane"},
               {"course", "time", "command", CurveStyle::line, "command"},
               {"course", "time", "slave", CurveStyle::line, "slave"}});
}

Panel force_panel(Figure& figure, const std::vector<SlaveLift>& all) {
  Panel panel{"Mean force of the last 0.2 s", "delay of the commands (s)", "force (N)"};
  for (const double frequency_hz : kSlaveFrequencies_hz) {
    std::vector<SlaveLift> list;
    for (const SlaveLift& lift : all)
      if (lift.remote.frequency_hz == frequency_hz) list.push_back(lift);
    const std::string hz = std::to_string(std::lround(frequency_hz)), name = "force_" + hz + "_hz";
    figure.tables.push_back(table_over<SlaveLift>(
        name, "a slave of " + hz + " Hz", list,
        {{"delay", "s", "delay of the commands", [](const SlaveLift& l) { return l.remote.delay_s; }},
         {"force", "N", "mean force on the slave in the last 0.2 s",
          [](const SlaveLift& l) { return l.force_N; }},
         {"derived", "N", "derived mean force", [](const SlaveLift& l) { return l.derived_N; }},
         {"peak", "N", "largest force on the slave", [](const SlaveLift& l) { return l.peak_N; }}}));
    panel.curves.push_back({name, "delay", "derived", CurveStyle::line, hz + " Hz, derived"});
    panel.curves.push_back({name, "delay", "force", CurveStyle::dots, hz + " Hz"});
  }
  return panel;
}

void add_claims(Figure& figure, const std::vector<SlaveLift>& all) {
  std::vector<double> errors_m, differences, growths;
  for (std::size_t i = 0; i < all.size(); ++i) {
    errors_m.push_back(all[i].error_m);
    differences.push_back(std::abs(all[i].force_N / all[i].derived_N - 1));
    if (all[i].remote.delay_s == 0.1) growths.push_back(all[i].force_N / all[i - 2].force_N);
  }
  const Claims claims(figure, "a surface that rises under a slave: ");
  claims.at_most(
      "the command rests on the plane of the newest frame before each update: largest distance from it",
      max_of(errors_m), 0.0002, "m");
  claims.at_most(
      "the mean force is that on a slave that stays on the plane while its command is late by the delay "
      "and half a frame interval: largest relative difference",
      max_of(differences), 0.15, "fraction");
  claims.at_least(
      "a delay of 0.1 s at least doubles the mean force at every natural frequency: smallest ratio",
      min_of(growths), 2, "1");
}

}  // namespace

Figure figure_slave_lift(FigureContext& context) {
  Figure figure{
      "slave-lift", "A surface that rises under a slave",
      "Fig 4.12 with a slave and without noise: a plane rises at 0.1 m/s under a hand at rest and "
      "accelerates with 3 m/s^2 from 1 s on. The commanded position follows the plane from frame to "
      "frame. The upper panel shows plane, command and slave in one run. The lower panel shows the mean "
      "force of the plane on the slave, measured (dots) and derived from momentum (lines). Simulated."};
  figure.source = "the theory of a linear slave";
  const std::vector<SlaveLift> all = lifts(context);
  figure.panels = {course_panel(figure, context), force_panel(figure, all)};
  add_claims(figure, all);
  return figure;
}

}  // namespace remote_touch
