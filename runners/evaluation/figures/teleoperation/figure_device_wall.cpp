// The largest stable stiffness of renderers on a device with a damper, over the damper and the delay.
#include <algorithm>
#include <cmath>

#include "analysis/statistics/extremes.h"
#include "runners/evaluation/figures/teleoperation/teleoperation_figures.h"
#include "runners/evaluation/figures/tools/figure_form.h"

namespace remote_touch {

namespace {

constexpr double kTick_s = 0.001;

// The hand is in contact, on a path at rest, from 1.6 s on. An oscillation that grows is larger in the second
// window.
constexpr double kWindow_s[] = {2.0, 2.8, 3.6};
// Smaller oscillations are the last steps of a proxy, 0.02 mm and less, and not an instability.
constexpr double kLeastSwing_m = 5e-5;

double swing_m(const Trace& trace, double from_s, double to_s) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.time_s[i] < from_s || trace.time_s[i] >= to_s) continue;
    low = std::min(low, trace.hip_position_m[i].y()), high = std::max(high, trace.hip_position_m[i].y());
  }
  return high - low;
}

bool opens(const Trace& trace, double from_s) {
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (trace.time_s[i] >= from_s && trace.force_N[i].isZero(0)) return true;
  return false;
}

// An oscillation that grows until the hand leaves the surface no longer grows, so a contact that opens counts
// too.
bool is_unstable(const Trace& trace) {
  const double first = swing_m(trace, kWindow_s[0], kWindow_s[1]);
  const double second = swing_m(trace, kWindow_s[1], kWindow_s[2]);
  return (second > kLeastSwing_m && second > first) || opens(trace, kWindow_s[1]);
}

struct Wall {
  std::size_t renderer;  // index in kRenderers
  double damping_Ns_per_m;
  int delay_ticks;
  double stable_N_per_m = 0.4 * expected_N_per_m(), unstable_N_per_m = 2.5 * expected_N_per_m();  // bisection

  // The limit of a linear wall without damping of its own: K T / 2 + K d = b, with the delay d.
  double expected_N_per_m() const { return damping_Ns_per_m / (kTick_s / 2 + delay_ticks * kTick_s); }
  double middle_N_per_m() const { return std::sqrt(stable_N_per_m * unstable_N_per_m); }
  double ratio() const { return middle_N_per_m() / expected_N_per_m(); }
};

constexpr const char* kRenderers[] = {"proxy",   "tracked-sheet", "god-object",
                                      "surfels", "mls-surface",   "penalty"};

Experiment experiment_of(const Wall& wall) {
  return Experiment::load("virtual-wall",
                          {std::string(R"(renderer={"name": ")") + kRenderers[wall.renderer] + "\"}",
                           "renderer.stiffness_N_per_m=" + std::to_string(wall.middle_N_per_m()),
                           // A quarter: the hand stays in contact and does not sink through a penalty force.
                           "operator.stiffness_N_per_m=" + std::to_string(wall.middle_N_per_m() / 4),
                           "device.damping_Ns_per_m=" + std::to_string(wall.damping_Ns_per_m),
                           "device.delay_ticks=" + std::to_string(wall.delay_ticks)});
}

std::vector<Wall> walls(FigureContext& context) {
  std::vector<Wall> list;
  for (std::size_t renderer = 0; renderer < std::size(kRenderers); ++renderer)
    for (const int delay_ticks : {0, 5})
      for (const double damping : {0.2, 0.5, 1.0}) list.push_back({renderer, damping, delay_ticks});
  for (int halving = 0; halving < 7; ++halving) {
    std::vector<Experiment> runs;
    for (const Wall& wall : list) runs.push_back(experiment_of(wall));
    const auto unstable = context.measure(runs, is_unstable);
    for (std::size_t i = 0; i < list.size(); ++i)
      (unstable[i] ? list[i].unstable_N_per_m : list[i].stable_N_per_m) = list[i].middle_N_per_m();
  }
  return list;
}

std::vector<Wall> walls_of(const std::vector<Wall>& all, std::size_t renderer, int delay_ticks) {
  std::vector<Wall> some;
  for (const Wall& wall : all)
    if (wall.renderer == renderer && wall.delay_ticks == delay_ticks) some.push_back(wall);
  return some;
}

std::string table_name(std::size_t renderer, int delay_ticks) {
  std::string name = kRenderers[renderer];
  std::replace(name.begin(), name.end(), '-', '_');
  return name + "_delay_" + std::to_string(delay_ticks);
}

Panel panel(Figure& figure, const std::vector<Wall>& all, int delay_ticks) {
  Panel made{delay_ticks == 0 ? "Without delay beyond the hold" : "Delay of 5 ms",
             "damping of the device (N s/m)", "largest stable stiffness (N/m)"};
  for (std::size_t renderer = 0; renderer < std::size(kRenderers); ++renderer) {
    const std::string name = table_name(renderer, delay_ticks);
    const std::vector<Wall> list = walls_of(all, renderer, delay_ticks);
    figure.tables.push_back(table_over<Wall>(
        name, std::string("limits of ") + kRenderers[renderer], list,
        {{"damping", "N s/m", "damping of the device", [](const Wall& w) { return w.damping_Ns_per_m; }},
         {"stiffness", "N/m", "largest stable stiffness", [](const Wall& w) { return w.middle_N_per_m(); }},
         {"expected", "N/m", "limit of a linear wall", [](const Wall& w) { return w.expected_N_per_m(); }}}));
    if (renderer == 0)
      made.curves.push_back({name, "damping", "expected", CurveStyle::line, "b / (T / 2 + delay)"});
    made.curves.push_back({name, "damping", "stiffness", CurveStyle::dots, kRenderers[renderer]});
  }
  return made;
}

}  // namespace

Figure figure_device_wall(FigureContext& context) {
  Figure figure{
      "device-wall", "The largest stable stiffness of a rendered plane",
      "A light hand without damping rests on a plane that a device renders; the device has a damper. "
      "Drawn is the stiffness of the renderer up to which no oscillation grows (dots), by bisection, "
      "and the limit of a linear wall (line). Points without noise at rest. Simulated."};
  figure.source = "the theory of sampled walls";
  const std::vector<Wall> all = walls(context);
  figure.panels = {panel(figure, all, 0), panel(figure, all, 5)};
  for (std::size_t renderer = 0; renderer < std::size(kRenderers); ++renderer)
    for (const int delay_ticks : {0, 5}) {
      std::vector<double> ratios;
      for (const Wall& wall : walls_of(all, renderer, delay_ticks))
        ratios.push_back(std::abs(wall.ratio() - 1));
      const Claims claims(figure, std::string(kRenderers[renderer]) +
                                      (delay_ticks == 0 ? ", without delay: " : ", delay of 5 ms: "));
      // A penalty force pushes from the nearest point, which lies beside the hand. Its stiffness along the
      // normal is therefore smaller than the setting, and its limit larger.
      const double limit = kRenderers[renderer] == std::string("penalty") ? 0.2 : 0.05;
      claims.at_most("the largest stable stiffness is b / (T / 2 + delay): largest relative difference",
                     max_of(ratios), limit, "fraction");
    }
  return figure;
}

}  // namespace remote_touch
