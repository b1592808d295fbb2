// The radius of a forbidden region that keeps a slave of 2 Hz from touching: over the delay of commands and
// frames, the speed of the organ and the noise of the points.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/theory/haptic_loops.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/tool_and_slave_measures.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/slave_tasks.h"

namespace remote_touch {

namespace {

constexpr double kOrganSlave_hz = 2;
constexpr double kNoises_m[] = {0, 0.001, 0.002};
constexpr double kShakes_hz[] = {0.25, 0.5, 1};
constexpr double kLateShake_hz = 0.5;  // frequency of the organ whose frames are late, too

struct NeededRegion {
  double noise_m, shake_hz, delay_s;
  bool has_late_frames = false;  // frames are as late as the commands
  double radius_m = 0;

  double frame_delay_s() const { return has_late_frames ? delay_s : 0; }
  // The organ is seen at once, or a frame interval late. The slave reaches a command at the end of the tick
  // after its arrival.
  double derived_m(double age_s) const {
    return following_error_m(
        {kOrgan_m, shake_hz, kOrganSlave_hz, delay_s + kSlaveTick_s + frame_delay_s() + age_s});
  }
  double least_m() const { return derived_m(0); }
  double latest_m() const { return derived_m(1 / kSlaveFrameRate_hz); }
  // A slave that is lowered overshoots the end of its command by v / (e w) before the organ moves.
  double lowered_m() const {
    return kLowering_m_per_s / (std::numbers::e * 2 * std::numbers::pi * kOrganSlave_hz);
  }
  double speed_mm_per_s() const { return 1000 * 2 * std::numbers::pi * shake_hz * kOrgan_m; }
};

// The slave feels no contact in these runs, so its least clearance may be negative, and a region that is
// larger by one millimetre makes it larger by about one. Each round corrects the radius by the clearance;
// after three the clearance was below 0.02 mm in all runs that were tried. Only what happens up to the first
// touch matters here, and until then a slave that feels contacts moves alike.
std::vector<NeededRegion> needed_regions(FigureContext& context) {
  std::vector<NeededRegion> all;
  for (const double noise_m : kNoises_m)
    for (const double delay_s : kLinkDelays_s) {
      for (const double shake_hz : kShakes_hz) all.push_back({noise_m, shake_hz, delay_s});
      all.push_back({noise_m, kLateShake_hz, delay_s, true});
    }
  for (NeededRegion& n : all) n.radius_m = n.latest_m();
  for (int round = 0; round < 3; ++round) {
    std::vector<Experiment> runs;
    for (const NeededRegion& n : all) {
      const RemoteSide remote{kOrganSlave_hz, n.delay_s, "rendered", n.radius_m};
      runs.push_back(organ_task(
          remote, n.shake_hz, n.noise_m,
          {"slave.contact_stiffness_N_per_m=0", "frame_latency_s=" + std::to_string(n.frame_delay_s())}));
    }
    const std::vector<double> clearances_m = context.measure(runs, min_slave_clearance_m);
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i].radius_m = max_or_nan(0.0, all[i].radius_m - clearances_m[i]);
  }
  return all;
}

// Adds a table of the regions for which belongs(n) is true, over the delay.
template <class Belongs>
void add_table(Figure& figure, const std::string& name, const std::string& title,
               const std::vector<NeededRegion>& all, const Belongs& belongs) {
  std::vector<NeededRegion> list;
  for (const NeededRegion& n : all)
    if (belongs(n)) list.push_back(n);
  figure.tables.push_back(table_over<NeededRegion>(
      name, title, list,
      {{"delay", "s", "delay of the commands", [](const NeededRegion& n) { return n.delay_s; }},
       {"radius", "m", "least radius without a touch", [](const NeededRegion& n) { return n.radius_m; }},
       {"least", "m", "bound without noise, the organ is seen at once",
        [](const NeededRegion& n) { return n.least_m(); }},
       {"latest", "m", "bound without noise, the organ is seen a frame late",
        [](const NeededRegion& n) { return n.latest_m(); }},
       {"lowered", "m", "bound of the slave that is lowered",
        [](const NeededRegion& n) { return n.lowered_m(); }}}));
}

std::string in_mm(double length_m) {
  return std::to_string(std::lround(1000 * length_m));
}

// The radius to choose is that without noise: noise only makes the region that is needed smaller.
Panel late_panel(Figure& figure, const std::vector<NeededRegion>& all) {
  Panel panel{"Frames as late as the commands, 63 mm/s", "delay of the commands (s)", "radius (m)"};
  for (const double noise_m : kNoises_m) {
    const std::string name = "late_frames_noise_" + in_mm(noise_m);
    add_table(figure, name, "frames as late as the commands, noise of " + in_mm(noise_m) + " mm", all,
              [&](const NeededRegion& n) { return n.has_late_frames && n.noise_m == noise_m; });
    if (noise_m == 0)
      panel.curves.push_back(
          {name, "delay", "least", CurveStyle::band, "derived without noise", 0, "latest"});
    panel.curves.push_back({name, "delay", "radius", CurveStyle::dots, "noise of " + in_mm(noise_m) + " mm"});
  }
  return panel;
}

Panel region_panel(Figure& figure, const std::vector<NeededRegion>& all, double noise_m) {
  const std::string mm = in_mm(noise_m);
  Panel panel{noise_m == 0 ? "No noise" : "Noise of " + mm + " mm", "delay of the commands (s)",
              "radius (m)"};
  for (const double shake_hz : kShakes_hz) {
    const std::string speed = std::to_string(std::lround(NeededRegion{0, shake_hz, 0}.speed_mm_per_s()));
    const std::string name = "speed_" + speed + "_noise_" + mm;
    add_table(figure, name, "organ of up to " + speed + " mm/s, noise of " + mm + " mm", all,
              [&](const NeededRegion& n) {
                return !n.has_late_frames && n.noise_m == noise_m && n.shake_hz == shake_hz;
              });
    panel.curves.push_back({name, "delay", "least", CurveStyle::band, speed + " mm/s, derived", 0, "latest"});
    panel.curves.push_back({name, "delay", "radius", CurveStyle::dots, speed + " mm/s"});
    if (shake_hz == kShakes_hz[2])
      panel.curves.push_back({name, "delay", "lowered", CurveStyle::dashed, "bound of the lowered slave"});
  }
  return panel;
}

void add_claims(Figure& figure, const std::vector<NeededRegion>& all) {
  // The first block of the list has no noise, and the same delays and speeds as the other blocks.
  const auto largest = [&](bool has_noise, auto&& value) {
    return max_where(
        all.size(), [&](std::size_t i) { return (all[i].noise_m > 0) == has_noise; },
        [&](std::size_t i) { return value(all[i], all[i % (all.size() / std::size(kNoises_m))]); });
  };
  const Claims claims(figure, "a slave of 2 Hz over an organ that moves: ");
  // A ball between four points lies up to 0.11 mm below where it touches them.
  claims.at_most(
      "without noise the region that is needed is at least A |1 - G(iu) exp(-iu t_d)|: largest amount "
      "below it",
      largest(false, [](const NeededRegion& n, const NeededRegion&) { return n.least_m() - n.radius_m; }),
      0.0002, "m");
  claims.at_most(
      "without noise no larger region is needed than for a frame that is one interval old, or for the "
      "overshoot v / (e w) of a slave that is lowered: largest amount above both",
      largest(false, [](const NeededRegion& n,
                        const NeededRegion&) { return n.radius_m - std::max(n.latest_m(), n.lowered_m()); }),
      0.0005, "m");
  // The ball rests on the highest of many points, so noise moves the command away from the organ.
  claims.at_most(
      "noise does not make a larger region necessary: largest increase as a multiple of the standard "
      "deviation of the noise",
      largest(true, [](const NeededRegion& n,
                       const NeededRegion& without) { return (n.radius_m - without.radius_m) / n.noise_m; }),
      0.5, "1");
  claims.at_most(
      "noise makes the needed region smaller by at most 3 standard deviations: largest decrease as a "
      "multiple of it",
      largest(true, [](const NeededRegion& n,
                       const NeededRegion& without) { return (without.radius_m - n.radius_m) / n.noise_m; }),
      3, "1");
}

}  // namespace

Figure figure_slave_region_radius(FigureContext& context) {
  Figure figure{
      "slave-region-radius", "The region that a slave of 2 Hz needs",
      "A hand holds a slave over an organ, a plane that moves up and down with an amplitude of 20 mm. The "
      "dots show the radius of the forbidden region at which the slave just does not touch, over the delay "
      "of the commands, for three frequencies of the organ; the legend shows its largest speeds. The bands "
      "are the bounds A |1 - G(iu) exp(-iu t_d)| for an organ that is seen at once and one frame interval "
      "late. A slave that is lowered at 0.1 m/s overshoots by v / (e w) before the organ moves (dashed). "
      "The last panel has frames that are as late as the commands. Noise makes the region that is needed "
      "smaller, so the radius to choose is that without noise. Simulated."};
  figure.source = "the theory of a linear slave";
  const std::vector<NeededRegion> all = needed_regions(context);
  for (const double noise_m : kNoises_m) figure.panels.push_back(region_panel(figure, all, noise_m));
  figure.panels.push_back(late_panel(figure, all));
  place_in_rows(figure, 2);
  add_claims(figure, all);
  return figure;
}

}  // namespace remote_touch
