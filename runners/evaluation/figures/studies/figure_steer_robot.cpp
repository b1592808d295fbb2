// A slow slave behind a delay over an organ that moves: which radius of a forbidden region keeps it from
// touching, and how hard it touches without a region. Chapter 8 asks this and does not measure it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/theory/haptic_loops.h"
#include "analysis/trace/force_fidelity.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/tool_and_slave_measures.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

// Settings of the experiment steer-robot.
constexpr double kAmplitude_m = 0.02, kOrganShake_hz = 0.5, kOrganFrameRate_hz = 30, kTick_s = 0.001;

// --- the radius that is needed ---

struct Link {
  double frequency_hz, delay_s;  // natural frequency of the slave, and delay of its commands
};

// The slave reaches a command at the end of the tick after its arrival.
double violation_m(const Link& link, double age_s) {
  return following_error_m({kAmplitude_m, kOrganShake_hz, link.frequency_hz, link.delay_s + kTick_s + age_s});
}

// Bounds of the radius without noise: the organ is seen at once, or a frame interval late.
double least_radius_m(const Link& link) {
  return violation_m(link, 0);
}
double latest_radius_m(const Link& link) {
  return violation_m(link, 1 / kOrganFrameRate_hz);
}

struct Needed {
  Link link;
  std::vector<double> clearance_m = {};  // least clearance of the slave, for each radius
  double radius_m = 0;                   // radius at which the clearance becomes 0; NaN: larger than all
};

const std::vector<double>& radii_m() {
  static const std::vector<double> list = {0, 0.0025, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.02, 0.025};
  return list;
}

Experiment experiment_of(const Link& link, double radius_m) {
  return Experiment::load("steer-robot", {"slave.natural_frequency_hz=" + std::to_string(link.frequency_hz),
                                          "command_link.delay_s=" + std::to_string(link.delay_s),
                                          "fixtures.0.radius_m=" + std::to_string(radius_m)});
}

// Returns the first radius at which the clearance is 0, interpolated.
double radius_without_touch_m(const std::vector<double>& clearance_m) {
  if (clearance_m[0] > 0) return 0;
  for (std::size_t i = 1; i < clearance_m.size(); ++i) {
    const double before = clearance_m[i - 1], now = clearance_m[i];
    if (now > 0) return radii_m()[i - 1] + (radii_m()[i] - radii_m()[i - 1]) * before / (before - now);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<Needed> needed_radii(FigureContext& context) {
  std::vector<Needed> list;
  std::vector<Experiment> runs;
  for (const double frequency_hz : {2.0, 10.0})
    for (const double delay_s : {0.0, 0.05, 0.1, 0.2}) {
      list.push_back({{frequency_hz, delay_s}});
      for (const double radius_m : radii_m()) runs.push_back(experiment_of(list.back().link, radius_m));
    }
  const std::vector<double> clearances = context.measure(runs, min_slave_clearance_m);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto begin = clearances.begin() + static_cast<std::ptrdiff_t>(i * radii_m().size());
    list[i].clearance_m.assign(begin, begin + static_cast<std::ptrdiff_t>(radii_m().size()));
    list[i].radius_m = radius_without_touch_m(list[i].clearance_m);
  }
  return list;
}

// --- forces on the slave ---

struct Architecture {
  const char *name, *title;
  std::vector<std::string> settings;
};

const std::vector<Architecture>& architectures() {
  static const std::vector<Architecture> list = {
      {"rendered_20_mm", "rendered, region of 20 mm", {"fixtures.0.radius_m=0.02"}},
      {"rendered", "rendered, no region", {"fixtures.0.radius_m=0"}},
      {"none", "no feedback", {"feedback.force=none"}},
      {"slave_force", "force of the slave", {"feedback.force=slave-force"}},
      {"passive", "force of the slave, passivity control", {"feedback.force=passive-slave-force"}}};
  return list;
}

struct Touch {
  double delay_s = 0;  // in each direction
  double peak_force_N = 0, energy_J = 0;
  double channel_energy_J = 0;  // lowest energy of the channel
};

std::vector<std::vector<Touch>> touches(FigureContext& context) {
  const std::vector<double> delays_s = {0, 0.025, 0.05, 0.1, 0.2};
  std::vector<Experiment> runs;
  for (const Architecture& architecture : architectures())
    for (const double delay_s : delays_s) {
      std::vector<std::string> settings = architecture.settings;
      for (const char* link : {"command_link", "force_link"})
        settings.push_back(std::string(link) + ".delay_s=" + std::to_string(delay_s));
      runs.push_back(Experiment::load("steer-robot", settings));
    }
  const std::vector<Touch> all = context.measure(runs, [](const Trace& trace) {
    return Touch{0, max_slave_force_N(trace), max_energy_injected_J(trace), min_channel_energy_J(trace)};
  });
  std::vector<std::vector<Touch>> list;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i % delays_s.size() == 0) list.emplace_back();
    list.back().push_back(all[i]), list.back().back().delay_s = delays_s[i % delays_s.size()];
  }
  return list;
}

// --- tables, panels and claims ---

std::vector<Needed> of_frequency(const std::vector<Needed>& all, double frequency_hz) {
  std::vector<Needed> some;
  for (const Needed& needed : all)
    if (needed.link.frequency_hz == frequency_hz) some.push_back(needed);
  return some;
}

Panel radius_panel(Figure& figure, const std::vector<Needed>& all) {
  Panel panel{"Radius of the region that keeps the slave from touching", "delay of the commands (s)",
              "radius (m)"};
  for (const double frequency_hz : {2.0, 10.0}) {
    const std::string hz = std::to_string(std::lround(frequency_hz)), name = "needed_" + hz + "_hz";
    figure.tables.push_back(table_over<Needed>(
        name, "a slave of " + hz + " Hz", of_frequency(all, frequency_hz),
        {{"delay", "s", "delay of the commands", [](const Needed& n) { return n.link.delay_s; }},
         {"radius", "m", "least radius without a touch", [](const Needed& n) { return n.radius_m; }},
         {"least", "m", "bound without noise, the organ is seen at once",
          [](const Needed& n) { return least_radius_m(n.link); }},
         {"latest", "m", "bound without noise, the organ is seen a frame late",
          [](const Needed& n) { return latest_radius_m(n.link); }}}));
    panel.curves.push_back({name, "delay", "least", CurveStyle::band, hz + " Hz, derived", 0, "latest"});
    panel.curves.push_back({name, "delay", "radius", CurveStyle::dots, hz + " Hz"});
  }
  return panel;
}

Panel force_panel(Figure& figure, const std::vector<std::vector<Touch>>& all) {
  Panel panel{"Force on the slave, 2 Hz", "delay in each direction (s)", "largest force (N)"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Architecture& architecture = architectures()[i];
    figure.tables.push_back(table_over<Touch>(
        architecture.name, architecture.title, all[i],
        {{"delay", "s", "delay in each direction", [](const Touch& t) { return t.delay_s; }},
         {"force", "N", "largest force of the scene on the slave",
          [](const Touch& t) { return t.peak_force_N; }},
         {"energy", "J", "maximum energy given to the hand", [](const Touch& t) { return t.energy_J; }}}));
    panel.curves.push_back({architecture.name, "delay", "force", CurveStyle::line, architecture.title});
  }
  return panel;
}

void add_radius_claims(Figure& figure, const std::vector<Needed>& all) {
  std::vector<double> below_m, above_m;
  for (const Needed& needed : all) {
    below_m.push_back(least_radius_m(needed.link) - needed.radius_m);
    above_m.push_back(needed.radius_m - latest_radius_m(needed.link));
  }
  const Claims claims(figure, "a slave over an organ that moves: ");
  // The slave's ball has the radius r_c, and noise moves the region by less than its standard deviation.
  claims.at_most("the radius that is needed is at least the derived one: largest amount below it",
                 max_of(below_m), 0.001, "m");
  claims.at_most(
      "the radius that is needed is not much larger than derived for a frame that is one interval "
      "old: largest amount above it",
      max_of(above_m), 0.002, "m");
}

void add_force_claims(Figure& figure, const std::vector<std::vector<Touch>>& all) {
  const auto largest = [&](std::size_t i, double from_s, double to_s, double Touch::*of) {
    return max_where(
        all[i].size(),
        [&](std::size_t k) { return all[i][k].delay_s >= from_s && all[i][k].delay_s <= to_s; },
        [&](std::size_t k) { return all[i][k].*of; });
  };
  const Claims claims(figure, "2 Hz: ");
  claims.at_most(
      "a region of 20 mm keeps the slave from touching up to 0.1 s in each direction: largest force",
      largest(0, 0, 0.1, &Touch::peak_force_N), 0, "N");
  claims.at_least("without a region the rendered force does not keep the slave from touching: force at 0.1 s",
                  all[1][3].peak_force_N, 1, "N");
  claims.at_least(
      "the force of the slave after 0.1 s in each direction makes the loop unstable: energy given "
      "to the hand",
      all[3][3].energy_J, 1, "J");
  std::vector<double> lowest_J;
  for (const Touch& touch : all[4]) lowest_J.push_back(touch.channel_energy_J);
  // The moving organ may give the hand energy, but the channel makes none.
  claims.at_least(
      "with passivity control the channel gives no more energy than it received, except by wrong predictions: "
      "lowest energy",
      min_of(lowest_J), -0.005, "J");
  // A stiff contact without delay is where a controller that acts once per tick is weakest.
  claims.at_least(
      "without a delay the loop has a limit cycle in spite of passivity control: energy given to the hand",
      all[4][0].energy_J, 1, "J");
}

}  // namespace

Figure figure_steer_robot(FigureContext& context) {
  Figure figure{
      "steer-robot", "A slave behind a delay over an organ that moves",
      "A hand holds a slave robot over a plane that moves up and down with an amplitude of 20 mm at 0.5 "
      "Hz; the points have 1 mm of noise, and frames arrive without a delay. Upper panel: the radius of the forbidden region at which the "
      "slave just does not touch the plane (dots), and the bounds derived from delay, bandwidth and age of "
      "the frames (bands). Lower panel: the largest force on the slave, for each force that the hand may "
      "feel. Simulated."};
  figure.source = "this project";
  const std::vector<Needed> needed = needed_radii(context);
  const std::vector<std::vector<Touch>> forces = touches(context);
  figure.panels = {radius_panel(figure, needed), force_panel(figure, forces)};
  add_radius_claims(figure, needed);
  add_force_claims(figure, forces);
  return figure;
}

}  // namespace remote_touch
