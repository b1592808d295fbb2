// The largest stable stiffness of renderers on a device with a damper, over the damper and the delay.
#include <algorithm>
#include <cmath>

#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/wall_limit.h"

namespace remote_touch {

namespace {

constexpr const char* kRenderers[] = {"proxy",   "tracked-sheet", "god-object",
                                      "surfels", "mls-surface",   "penalty"};

struct Wall {
  std::size_t renderer;  // index in kRenderers
  double damping_Ns_per_m;
  int delay_ticks;
  WallLimit limit;
};

Wall wall(std::size_t renderer, double damping_Ns_per_m, int delay_ticks) {
  const auto experiment = [=](double stiffness_N_per_m) {
    return Experiment::load(
        "virtual-wall", {std::string(R"(renderer={"name": ")") + kRenderers[renderer] + "\"}",
                         "renderer.stiffness_N_per_m=" + std::to_string(stiffness_N_per_m),
                         // A quarter: the hand stays in contact and does not sink through a penalty force.
                         "operator.stiffness_N_per_m=" + std::to_string(stiffness_N_per_m / 4),
                         "device.damping_Ns_per_m=" + std::to_string(damping_Ns_per_m),
                         "device.delay_ticks=" + std::to_string(delay_ticks)});
  };
  return {renderer, damping_Ns_per_m, delay_ticks,
          WallLimit(experiment, {.mass_kg = 0.3,
                                 .damping_Ns_per_m = damping_Ns_per_m,
                                 .spring_share = 0.25,
                                 .delay_ticks = delay_ticks})};
}

std::vector<Wall> walls(FigureContext& context) {
  std::vector<Wall> list;
  for (std::size_t renderer = 0; renderer < std::size(kRenderers); ++renderer)
    for (const int delay_ticks : {0, 5})
      for (const double damping : {0.2, 0.5, 1.0}) list.push_back(wall(renderer, damping, delay_ticks));
  std::vector<WallLimit*> limits;
  for (Wall& each : list) limits.push_back(&each.limit);
  bisect(context, limits);
  return list;
}

std::vector<Wall> walls_of(const std::vector<Wall>& all, std::size_t renderer, int delay_ticks) {
  std::vector<Wall> some;
  for (const Wall& one : all)
    if (one.renderer == renderer && one.delay_ticks == delay_ticks) some.push_back(one);
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
         {"stiffness", "N/m", "largest stable stiffness", [](const Wall& w) { return w.limit.middle(); }},
         {"expected", "N/m", "limit of a linear wall, law", [](const Wall& w) { return w.limit.expected(); }},
         {"exact", "N/m", "limit of a linear wall, eigenvalues",
          [](const Wall& w) { return w.limit.exact(); }}}));
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
      "The dots show the stiffness of the renderer up to which no oscillation grows, found by bisection; "
      "the line is the limit of a linear wall. The points have no noise and rest. Simulated."};
  figure.source = "the theory of sampled walls";
  const std::vector<Wall> all = walls(context);
  figure.panels = {panel(figure, all, 0), panel(figure, all, 5)};
  for (std::size_t renderer = 0; renderer < std::size(kRenderers); ++renderer)
    for (const int delay_ticks : {0, 5}) {
      std::vector<double> ratios;
      for (const Wall& one : walls_of(all, renderer, delay_ticks))
        ratios.push_back(std::abs(one.limit.ratio() - 1));
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
