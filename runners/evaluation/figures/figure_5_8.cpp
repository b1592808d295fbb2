// Fig 5.8: a beating organ is touched, and then kept at a distance by a fixture that grows.
#include <cmath>
#include <limits>

#include "analysis/trace/curve_fits.h"
#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/fixture_run.h"

namespace remote_touch {

namespace {

constexpr double kInTouch_s = 1;                                // the approach is over long before
constexpr double kGrows_s = 5, kGrown_s = 10, kSteady_s = 0.1;  // starts of phases; settling of the last one
constexpr double kMax_m = 0.02, kGrowth_m_per_s = kMax_m / (kGrown_s - kGrows_s);
// The depth to which a proxy sinks between four points 0.9 mm apart (the spacing 0.47 m from the camera),
// plus the shell of 0.01 mm in which it rests.
constexpr double kSinks_m = 0.9e-3 * 0.9e-3 / 4 / 5e-3 + 1e-5;
constexpr double kTick_s = 1e-3;
// Error of a mean distance, because the last phase is no whole number of beats: the surface moves by up to
// 6.5 mm in the incomplete beat and is seen half a frame late. Averaged over the 4.9 s of the phase.
constexpr double kPartOfBeat_m = 0.0065 / 30 / 4.9 / 2;
constexpr std::size_t kTableStride_5_8 = 5;  // ticks, in tables

// The sensor of chapter 4's simulated camera.
const std::vector<std::string> kNoise = {"scenario.noise_per_m=0.0012",
                                         "scenario.quantisation_per_m=0.00285"};

double surface_height_m(const FixtureRun& run, std::size_t i, double time_s) {
  return run.scenario->surface_height(run.trace.proxy_position_m[i].x(), run.trace.proxy_position_m[i].z(),
                                      time_s);
}

// Returns the run, tick by tick.
Table path_table(const std::string& name, const std::string& title, const FixtureRun& run) {
  const Trace& t = run.trace;
  const auto each_tick = [&](const auto& value) { return each_of(t.length(), value); };
  const Numbers boundary_m = each_tick([&](std::size_t i) { return run.boundary_m(i); });
  const auto surface_m = [&](std::size_t i) { return surface_height_m(run, i, t.time_s[i]); };
  const auto seen_m = [&](std::size_t i) {
    return run.scenario->signed_distance(t.proxy_position_m[i], run.frame_captured_s(i));
  };
  return {
      name,
      title,
      {{"time", "s", "simulated time", t.time_s},
       {"hip_y", "m", "height of the HIP", along(1, t.hip_position_m)},
       {"proxy_y", "m", "height of the proxy's centre", along(1, t.proxy_position_m)},
       {"surface_y", "m", "height of the true surface under the proxy", each_tick(surface_m)},
       {"distance", "m", "distance of the proxy's centre to the true surface at that time",
        t.signed_distance_m},
       {"radius", "m", "r_f of the frame in use", run.radius_m},
       {"boundary", "m", "r_f + r_c", boundary_m},
       {"deviation", "m", "distance to the surface as it moves, beyond r_f + r_c",
        minus(t.signed_distance_m, boundary_m)},
       {"deviation_in_frame", "m", "distance to the surface as the frame in use shows it, beyond r_f + r_c",
        minus(each_tick(seen_m), boundary_m)},
       {"force", "N", "magnitude of the force", norms(t.force_N)},
       {"hip_distance", "m", "distance between HIP and proxy",
        norms_between(t.hip_position_m, t.proxy_position_m)}}};
}

struct Summary {
  double seen_rms_m, seen_max_m, at_update_rms_m, moving_rms_m, moving_max_m;  // deviations in touch
  double min_beyond_fixture_m, min_slave_beyond_fixture_m;
  double touching_m, held_m, growth_m_per_s;  // mean distances and slope of the phases
  double max_speed_m_per_s;                   // speed of the surface at the proxy
};

// path: the table of the run. A value is NaN if no tick counts; a claim on it fails.
Summary summary(const FixtureRun& run, const Table& path) {
  constexpr double kEnd_s = std::numeric_limits<double>::infinity(), kApart_s = 1e-3;
  const Trace& t = run.trace;
  const Numbers &seen_m = numbers(path, "deviation_in_frame"), &moving_m = numbers(path, "deviation"),
                &distance_m = t.signed_distance_m;
  const auto phase = [&](double from_s, double until_s) {
    return [&t, from_s, until_s](std::size_t i) { return t.time_s[i] >= from_s && t.time_s[i] < until_s; };
  };
  const auto in_touch = phase(kInTouch_s, kEnd_s), grows = phase(kGrows_s, kGrown_s);
  const auto updated = [&](std::size_t i) { return in_touch(i) && t.frame_update(i); };
  const auto speed_m_per_s = [&](std::size_t i) {
    const double rise_m =
        surface_height_m(run, i, t.time_s[i] + kApart_s) - surface_height_m(run, i, t.time_s[i]);
    return std::abs(rise_m) / kApart_s;
  };
  return {rms(where(seen_m, in_touch)),
          max_of(magnitudes(where(seen_m, in_touch))),
          rms(where(moving_m, updated)),
          rms(where(moving_m, in_touch)),
          max_of(magnitudes(where(moving_m, in_touch))),
          min_of(minus(distance_m, run.radius_m)),
          min_of(minus(t.slave_distance_m, run.radius_m)),
          mean(where(distance_m, phase(kInTouch_s, kGrows_s))),
          mean(where(distance_m, phase(kGrown_s + kSteady_s, kEnd_s))),
          fit_polynomial(where(t.time_s, grows), where(distance_m, grows), {0, 1}).coefficients[1],
          max_where(t.length(), in_touch, speed_m_per_s)};
}

Table deviation_table(const Summary& a, const Summary& b) {
  const std::string beyond = " of distance - r_f - r_c, ";
  return quantity_table<Summary>(
      "deviations",
      "how far the proxy is from where r_f and r_c put it, from 1 s on; smallest distances: in all ticks",
      {"noise_free", "with_noise"}, {a, b},
      {{"rms" + beyond + "surface as the newest frame shows it, all ticks", "m", &Summary::seen_rms_m},
       {"largest" + beyond + "the same", "m", &Summary::seen_max_m},
       {"rms" + beyond + "surface as it moves, ticks in which a frame came in", "m",
        &Summary::at_update_rms_m},
       {"rms" + beyond + "surface as it moves, all ticks", "m", &Summary::moving_rms_m},
       {"largest" + beyond + "the same", "m", &Summary::moving_max_m},
       {"smallest distance of the proxy - r_f", "m", &Summary::min_beyond_fixture_m},
       {"smallest distance of the slave's command - r_f", "m", &Summary::min_slave_beyond_fixture_m},
       {"mean distance, r_f = 0", "m", &Summary::touching_m},
       {"slope of the distance while r_f grows", "m/s", &Summary::growth_m_per_s},
       {"mean distance, r_f = 0.02 m", "m", &Summary::held_m},
       {"largest speed of the surface over the proxy", "m/s", &Summary::max_speed_m_per_s}});
}

constexpr const char *kWithNoise = "with the sensor's noise", *kNoiseFree = "noise-free camera";

// Returns a panel over time of curves of both runs, noise first.
Panel of_both_runs(const char* title, const char* y_label, const char* column, const PanelFrame& frame) {
  return plot(title, "time (s)", y_label,
              {{"with_noise", "time", column, CurveStyle::line, kWithNoise},
               {"noise_free", "time", column, CurveStyle::line, kNoiseFree}},
              frame);
}

// The distance to the true surface goes up and down with every frame, so that one run would hide the other.
Panel distance_panel(const std::string& table, const std::string& label, const PanelFrame& frame) {
  return plot("Distance to the true surface, " + label, "time (s)", "distance (m)",
              {{table, "time", "distance", CurveStyle::line, label},
               {table, "time", "boundary", CurveStyle::dashed, "r_f + r_c"}},
              frame);
}

// Returns three rows of two panels.
std::vector<Panel> panels() {
  const std::pair<double, double> whole{0, 15}, one_second{1, 2}, distances_m{0, 0.03};
  Panel deviation = of_both_runs("Distance - r_f - r_c, moving true surface, from 1 to 2 s", "deviation (m)",
                                 "deviation", {{{2, 1}}, one_second, {{-0.002, 0.003}}});
  deviation.curves.push_back({"noise_free", "time", "deviation_in_frame", CurveStyle::dashed,
                              "noise-free, surface of the newest frame"});
  return {of_both_runs("Distance between HIP and proxy, as in the dissertation", "|HIP - proxy| (m)",
                       "hip_distance", {{{0, 0}}, whole}),
          of_both_runs("Force", "force (N)", "force", {{{0, 1}}, whole}),
          distance_panel("noise_free", kNoiseFree, {{{1, 0}}, whole, distances_m}),
          distance_panel("with_noise", kWithNoise, {{{1, 1}}, whole, distances_m}),
          plot("Height, noise-free camera", "time (s)", "y (m)",
               {{"noise_free", "time", "hip_y", CurveStyle::dashed, "HIP"},
                {"noise_free", "time", "surface_y", CurveStyle::dashed, "true surface under the proxy"},
                {"noise_free", "time", "proxy_y", CurveStyle::line, "proxy"}},
               {{{2, 0}}, whole, {{0.045, 0.095}}}),
          deviation};
}

void add_claims(Figure& figure, const Summary& clean, const Summary& noisy, double frame_s) {
  const Claims claims(figure);
  constexpr double kMean_m = kSinks_m + kPartOfBeat_m;
  claims.at_most(
      "without noise the proxy is r_f + r_c from the surface that the newest frame shows: rms difference",
      clean.seen_rms_m, kSinks_m, "m", "0");
  claims.at_most(
      "without noise the proxy is r_f + r_c from the moving surface in the ticks in which a frame "
      "arrives: rms difference",
      clean.at_update_rms_m, kSinks_m + kTick_s * clean.max_speed_m_per_s, "m", "0");
  claims.at_most(
      "between frames the moving surface leaves the proxy by at most its largest speed times the frame "
      "interval: largest distance beyond r_f + r_c",
      clean.moving_max_m, clean.max_speed_m_per_s * frame_s, "m");
  claims.at_least(
      "without noise the moving surface never comes within r_f of the proxy's centre: smallest distance "
      "minus r_f",
      clean.min_beyond_fixture_m, 0, "m", ">= 0");
  claims.between("while r_f = 0 the proxy is r_c from the surface: mean distance", clean.touching_m,
                 0.005 - kMean_m, 0.005 + kMean_m, "m", "r_c = 0.005");
  claims.between(
      "while r_f grows, the distance of the proxy from the surface grows at the same rate: its slope",
      clean.growth_m_per_s, 0.98 * kGrowth_m_per_s, 1.02 * kGrowth_m_per_s, "m/s", "0.004");
  claims.between("while r_f = 0.02 m the proxy is r_f + r_c from the surface: mean distance", clean.held_m,
                 0.025 - kMean_m, 0.025 + kMean_m, "m", "0.025");
  claims.at_least(
      "without noise the slave is never commanded into the fixture: smallest distance to the surface "
      "minus r_f",
      clean.min_slave_beyond_fixture_m, 0, "m", ">= 0");
  claims.at_least(
      "with noise the slave is never commanded into the fixture: smallest distance to the surface minus r_f",
      noisy.min_slave_beyond_fixture_m, 0, "m", ">= 0");
}

}  // namespace

Figure figure_5_8(FigureContext& context) {
  std::vector<Experiment> experiments;
  experiments.push_back(Experiment::load("fig5.8"));
  experiments.push_back(Experiment::load("fig5.8", kNoise));
  const std::vector<FixtureRun> runs = run_fixtures(context, experiments);
  const Table noise_free = path_table("noise_free", "every fifth tick, noise-free camera", runs[0]),
              with_noise = path_table("with_noise", "every fifth tick, with the sensor's noise", runs[1]);
  const Summary clean = summary(runs[0], noise_free), noisy = summary(runs[1], with_noise);
  Figure figure{
      "5.8", "A fixture that grows on a beating organ, simulated depth camera",
      "Simulated: a depth camera (30 Hz) looks down on three ellipsoids that beat 75 times a minute, in "
      "place of the recorded pig's heart, and the HIP rests just inside. r_f is 0 for 5 s, grows to 20 "
      "mm in 5 s and then stays constant. Distances are from the proxy's centre to the true surface: as it "
      "is in that tick, or as it was when the frame in use was captured. The renderer knows only the "
      "second; since then the organ has moved for up to one frame interval. r_f is that of the frame in "
      "use. The last panel shows one second, because the distance goes up and down once in a frame (33 ms). "
      "Curves show every fifth tick; measures use all ticks from 1 s on, and the smallest distances "
      "those before, too."};
  figure.tables = {every(kTableStride_5_8, noise_free), every(kTableStride_5_8, with_noise),
                   deviation_table(clean, noisy)};
  figure.panels = panels();
  add_claims(figure, clean, noisy, 1 / runs[0].scenario->frame_rate_hz());
  for (const auto& [where, run] :
       {std::pair("noise-free: ", &runs[0]), std::pair("with noise: ", &runs[1])}) {
    add_side_claim(figure, where, run->trace);
    add_sound_claims(figure, where, run->trace);
  }
  return figure;
}

}  // namespace remote_touch
