// The packets that a perceptual dead-band leaves of the commands and forces of a slave that follows a
// contour.
#include <cmath>

#include "analysis/theory/haptic_loops.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/tool_and_slave_measures.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/slave_tasks.h"

namespace remote_touch {

namespace {

constexpr double kContourSlave_hz = 5;
constexpr double kFractions[] = {0.05, 0.1, 0.2};                // Weber fractions of the force
constexpr double kLengths_m[] = {0.0002, 0.0005, 0.001, 0.002};  // dead-bands of the commands

// The fraction of the packets that is left with the largest reductions that publications report. Their
// signals come from human hands and from sensors with noise.
struct Published {
  const char *column, *label;
  double left;
};
constexpr Published kPublished[] = {{"published_85", "85 % fewer, published", 0.15},
                                    {"published_90", "90 % fewer, published", 0.1},
                                    {"published_96", "96 % fewer, published", 0.04}};

struct Banded {
  double band;  // fraction or length
  double held_per_s = 0, predicted_per_s = 0;
  double bound_per_s = 0;  // of held values
  double shift_m = 0;  // rms distance of the slave, with held values, from the slave that gets every sample
};

Experiment run_of(const char* link, const char* setting, double band, bool predicts) {
  const std::string name = link;
  return contour_task({kContourSlave_hz, 0, "slave-force"},
                      {name + "." + setting + "=" + std::to_string(band),
                       name + ".predicts=" + (predicts ? "true" : "false")});
}

// A value that is held is sent again after a path of at least log(1 + k) in units of its magnitude, with the
// Weber fraction k. On a straight path outwards the magnitude grows by the factor 1 + k; every other path is
// longer. A sample with which a contact begins or ends is sent too.
double bound_of_forces_per_s(const Trace& trace, double fraction) {
  double packets = 1;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    const Vec3 &before = trace.slave_force_N[i - 1], &now = trace.slave_force_N[i];
    const double less = std::min(before.norm(), now.norm());
    if (less > 0) packets += std::min(1.0, (now - before).norm() / less / std::log1p(fraction));
    if (less == 0 && before != now) packets += 1;
  }
  return packets / trace.time_s.back();
}

double bound_of_commands_per_s(const Trace& trace, double length_m) {
  double path_m = 0;
  for (std::size_t i = 1; i < trace.length(); ++i)
    path_m += (trace.slave_command_m[i] - trace.slave_command_m[i - 1]).norm();
  return (1 + path_m / length_m) / trace.time_s.back();
}

double shift_m(const Trace& trace, const Trace& whole) {
  return std::sqrt(mean_where(
      trace.length(), [](std::size_t) { return true; },
      [&](std::size_t i) { return (trace.slave_position_m[i] - whole.slave_position_m[i]).squaredNorm(); }));
}

// whole: the run that sends every sample.
std::vector<Banded> banded(FigureContext& context, const Trace& whole, bool is_force) {
  std::vector<Banded> all;
  std::vector<Experiment> runs;
  for (const double band : is_force ? std::vector<double>(std::begin(kFractions), std::end(kFractions))
                                    : std::vector<double>(std::begin(kLengths_m), std::end(kLengths_m))) {
    all.push_back({band});
    for (const bool predicts : {false, true})
      runs.push_back(run_of(is_force ? "force_link" : "command_link", is_force ? "weber_fraction" : "least",
                            band, predicts));
  }
  const auto rate_per_s = is_force ? force_packet_rate_per_s : command_packet_rate_per_s;
  const auto bound_per_s = is_force ? bound_of_forces_per_s : bound_of_commands_per_s;
  const std::vector<Trace> traces = context.run(runs);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Trace& held = traces[2 * i];
    all[i].held_per_s = rate_per_s(held), all[i].predicted_per_s = rate_per_s(traces[2 * i + 1]);
    all[i].bound_per_s = bound_per_s(held, all[i].band);
    all[i].shift_m = shift_m(held, whole);
  }
  return all;
}

Panel packet_panel(Figure& figure, const std::vector<Banded>& list, bool is_force) {
  const std::string name = is_force ? "forces" : "commands";
  Table table = table_over<Banded>(
      name, "packets of " + name + " per second; without a dead-band 1000", list,
      {{"band", is_force ? "1" : "m", is_force ? "Weber fraction" : "least difference that is sent",
        [](const Banded& b) { return b.band; }},
       {"held", "1/s", "packets per second, values are held", [](const Banded& b) { return b.held_per_s; }},
       {"predicted", "1/s", "packets per second, linear prediction",
        [](const Banded& b) { return b.predicted_per_s; }},
       {"bound", "1/s", "bound for values that are held", [](const Banded& b) { return b.bound_per_s; }},
       {"shift", "m", "rms distance from the slave that gets every sample",
        [](const Banded& b) { return b.shift_m; }}});
  Panel panel{is_force ? "Forces" : "Commands", is_force ? "Weber fraction" : "dead-band (m)",
              "packets per second"};
  panel.curves = {{name, "band", "held", CurveStyle::dots, "held"},
                  {name, "band", "predicted", CurveStyle::dots, "linear prediction"},
                  {name, "band", "bound", CurveStyle::dashed, "bound, held"}};
  for (const Published& published : kPublished) {
    add_columns<Banded>(table, list, {{published.column, "1/s", published.label, [&](const Banded&) {
                                         return published.left / kSlaveTick_s;
                                       }}});
    panel.curves.push_back({name, "band", published.column, CurveStyle::dashed, published.label});
  }
  figure.tables.push_back(table);
  return panel;
}

// The linear loop of the task. The forces of the slave are sampled and held, and so are its commands.
double stable_delay_s() {
  PositionForceLoop loop;
  loop.mass_kg = kHandMass_kg, loop.stiffness_N_per_m = kHandStiffness_N_per_m;
  loop.damping_Ns_per_m = kHandDamping_Ns_per_m, loop.slave_mass_kg = kSlaveMass_kg;
  loop.slave_natural_frequency_hz = kContourSlave_hz, loop.feedback_gain = kContourGain;
  loop.environment_stiffness_N_per_m = kContourStiffness_N_per_m;
  loop.environment_damping_Ns_per_m = kContourDamping_Ns_per_m;
  return delay_onset(loop).round_trip_s - held_round_trip(0, kSlaveTick_s, 4);
}

double largest_ratio_to_bound(const std::vector<Banded>& list) {
  return max_where(
      list.size(), [](std::size_t) { return true; },
      [&](std::size_t i) { return list[i].held_per_s / list[i].bound_per_s; });
}

double largest_of_prediction(const std::vector<Banded>& list) {
  return max_where(
      list.size(), [](std::size_t) { return true; },
      [&](std::size_t i) { return list[i].predicted_per_s / list[i].held_per_s; });
}

double largest_force_N(const Trace& trace) {
  return max_where(
      trace.length(), [](std::size_t) { return true; },
      [&](std::size_t i) { return trace.slave_force_N[i].norm(); });
}

}  // namespace

Figure figure_slave_packets(FigureContext& context) {
  Figure figure{
      "slave-packets", "Packets of a slave that follows a contour",
      "A hand presses a slave of 5 Hz into a soft surface with waves of 3 mm, slides along it and back, "
      "and feels half of the force of the slave. Packets per second over the dead-band of the forces "
      "(Weber fraction) and of the commands (length), with values that are held and with linear "
      "prediction (dots); the bound for held values from the path of the signal (dashed); and the largest "
      "reductions that publications report for the signals of human hands (dashed). Without a dead-band "
      "there are 1000 packets per second. Simulated."};
  figure.source = "Hinterseer et al. 2008";
  const Trace whole = context.run(contour_task({kContourSlave_hz, 0, "slave-force"}, {}));
  const std::vector<Banded> forces = banded(context, whole, true), commands = banded(context, whole, false);
  figure.panels = {packet_panel(figure, forces, true), packet_panel(figure, commands, false)};
  place_in_rows(figure, 2);
  Claims(figure, "a slave on a contour: ", &Claim::set_up)
      .at_least("the linear loop without a dead-band is stable: largest stable delay", stable_delay_s(),
                0.001, "s");
  const Claims claims(figure, "a slave on a contour: ");
  claims.at_least("forces with a Weber fraction of 0.1, held, need at least 90 % fewer packets: reduction",
                  1 - forces[1].held_per_s * kSlaveTick_s, 0.9, "fraction", "up to 0.9");
  claims.at_most("held forces need no more packets than the bound from the path of the signal: largest ratio",
                 largest_ratio_to_bound(forces), 1, "1");
  claims.at_most(
      "held commands need no more packets than the bound from the path of the signal: largest ratio",
      largest_ratio_to_bound(commands), 1, "1");
  claims.at_most(
      "linear prediction of commands needs no more packets than held commands at any dead-band: largest "
      "ratio",
      largest_of_prediction(commands), 1, "1");
  claims.at_most(
      "linear prediction of commands with 0.2 mm at least halves the packets: ratio to held commands",
      commands[0].predicted_per_s / commands[0].held_per_s, 0.5, "1");
  // The hand may be pushed by a force that is wrong by this fraction, against its own spring.
  claims.at_most(
      "a Weber fraction of 0.1 moves the slave by no more than the error of the force moves a hand at "
      "rest: rms distance",
      forces[1].shift_m, 0.1 * kContourGain * largest_force_N(whole) / kHandStiffness_N_per_m, "m");
  return figure;
}

}  // namespace remote_touch
