// Fig 5.5: the region around a single point. Fig 5.6: a step between two regions. Fig 5.8: a beating organ
// behind a region that grows.

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/curve_fits.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

namespace {

constexpr double kFixtureRadius_m = 0.1, kBoundary_m = 0.105;
constexpr double kStiffness_N_per_m = 600;
constexpr double kShell_5_5_m = 1e-5;  // r_2 - r_c: a proxy in contact may rest anywhere in this shell

}  // namespace

// The point is the origin, so distances to it are lengths. Both radii are columns, to be drawn as lines.
Figure figure_5_5(FigureContext& context) {
  const Trace trace = context.run("fig5.5");
  const std::size_t ticks = trace.length();
  const Numbers proxy_m = norms(trace.proxy_position_m), hip_m = norms(trace.hip_position_m),
                gap_m = norms_between(trace.proxy_position_m, trace.hip_position_m),
                force_N = norms(trace.force_N);
  Figure figure{"5.5", "Single point virtual fixture",
                "One point at the origin with r_f = 100 mm. The HIP passes through its region, leaves it and "
                "crosses its rim. The proxy's centre stays r_f + r_c away; the force is k_s times the depth "
                "of the HIP in the region."};
  figure.tables = {{"distances",
                    "distances to the point, and the force",
                    {{"time", "s", "simulated time", trace.time_s},
                     {"proxy", "m", "distance of the proxy's centre to the point", proxy_m},
                     {"hip", "m", "distance of the HIP to the point", hip_m},
                     {"force", "N", "magnitude of the force", force_N},
                     {"radius", "m", "r_f", Numbers(ticks, kFixtureRadius_m)},
                     {"boundary", "m", "r_f + r_c", Numbers(ticks, kBoundary_m)}}}};
  figure.panels = {
      plot("Distance to the point", "time (s)", "distance (m)",
           {{"distances", "time", "boundary", CurveStyle::dashed, "r_f + r_c"},
            {"distances", "time", "radius", CurveStyle::line, "boundary of the region, r_f"},
            {"distances", "time", "hip", CurveStyle::dashed, "HIP"},
            {"distances", "time", "proxy", CurveStyle::line, "proxy"}}),
      plot("Force", "time (s)", "force (N)", {{"distances", "time", "force", CurveStyle::line, ""}})};
  const Claims claims(figure);
  claims.between(
      "the proxy stays out of the region around the point: smallest distance of its centre to the point",
      min_of(proxy_m), kBoundary_m - 1e-6, kBoundary_m + 1e-6, "m", ">= 0.105");
  claims.at_most("no tick ends with the proxy entrenched: ticks that do",
                 std::ranges::count(trace.state, static_cast<std::int32_t>(ContactState::entrenched)), 0,
                 "ticks");
  const auto is_outside = [&](std::size_t i) { return hip_m[i] > kBoundary_m; };
  claims.at_most("the proxy is at the HIP while the HIP is outside the region: largest distance",
                 max_of(where(gap_m, is_outside)), kShell_5_5_m, "m", "0");
  // The depth is the distance from the HIP to the contact point of a proxy that rests where the region is
  // nearest to the HIP.
  const auto is_inside = [&](std::size_t i) { return !(kFixtureRadius_m - hip_m[i] <= 0); };
  const auto force_error_N = [&](std::size_t i) {
    return std::abs(force_N[i] - kStiffness_N_per_m * (kFixtureRadius_m - hip_m[i]));
  };
  claims.at_most("the force is k_s times the depth of the HIP in the region: largest difference",
                 max_where(ticks, is_inside, force_error_N), kStiffness_N_per_m * kShell_5_5_m, "N");
  Claims(figure, "", &Claim::set_up)
      .at_most("the HIP enters the region: its smallest distance to the point", min_of(hip_m), kBoundary_m,
               "m");
  return figure;
}

// Fig 5.6: the proxy climbs onto a fixture of larger radius; and a stiffness that varies across a plane.

namespace {

constexpr double kRegionRadius_m = 0.01;
constexpr double kMin_N = 0.01;  // a force from this on is felt

// Returns positions, force, and force over stretch of the ticks in which the HIP moves towards larger x.
Table crossing(FigureContext& context, const char* experiment, const std::string& name) {
  const Trace t = context.run(experiment);
  std::vector<std::size_t> ticks;
  std::vector<Vec3> contact;
  for (std::size_t i = 0; i < t.length(); ++i) {
    contact.push_back(contact_point(t, i, kContactRadius_m));
    if (i > 0 && t.hip_position_m[i].x() > t.hip_position_m[i - 1].x()) ticks.push_back(i);
  }
  const Numbers force = norms(t.force_N), length = norms_between(t.hip_position_m, t.proxy_position_m);
  return rows_of(
      {name,
       "contact point, HIP and force while the HIP moves along x",
       {{"hip_x", "m", "HIP along the plane", along(0, t.hip_position_m)},
        {"hip_y", "m", "height of the HIP", along(1, t.hip_position_m)},
        {"contact_x", "m", "contact point along the plane", along(0, contact)},
        {"contact_y", "m", "height of the contact point", along(1, contact)},
        {"force", "N", "magnitude of the force", force},
        {"proxy_y", "m", "height of the proxy", along(1, t.proxy_position_m)},
        {"felt", "N/m", "force over the stretch of the virtual coupling",
         each_of(t.length(), [&](std::size_t i) { return force[i] / (length[i] - kContactRadius_m); })}}},
      ticks);
}

// Returns the table without the columns that are only measured.
Table shown(Table crossing) {
  crossing.columns.resize(5);
  return crossing;
}

// Returns the x of the HIP when a column is at least `least` for the first time; NaN if it never is.
double first_x(const Table& crossing, const char* column, double least) {
  const Numbers &x = numbers(crossing, "hip_x"), &values = numbers(crossing, column);
  const Numbers reached = where(x, [&](std::size_t i) { return values[i] >= least; });
  return reached.empty() ? kNoValue : reached.front();
}

// Returns the mean force over the rows with the HIP between from_x and to_x; NaN if there are none.
double mean_force(const Table& crossing, double from_x, double to_x) {
  const Numbers& x = numbers(crossing, "hip_x");
  return mean(
      where(numbers(crossing, "force"), [&](std::size_t i) { return x[i] >= from_x && x[i] <= to_x; }));
}

// Returns two tables: the points of the cloud near the step, and the first point with r_f = 0.01 m.
std::vector<Table> point_tables() {
  const auto place = [](std::size_t i) { return 0.0015 * (static_cast<int>(i) - 20 + 0.5); };
  return {{"points",
           "points of the cloud near the step",
           {{"x", "m", "along the plane", each_of(40, place)}, {"y", "m", "height", Numbers(40)}}},
          {"first_region",
           "the first point with a region",
           {{"x", "m", "along the plane", Numbers{0.00075}}, {"y", "m", "height", Numbers(1)}}}};
}

// The HIP is a solid line here, because dashes over a row of points are hard to see.
Panel path_panel(const std::string& title, const std::string& table) {
  return plot(title, "x (m)", "y (m)",
              {{"points", "x", "y", CurveStyle::dots, "points"},
               {"first_region", "x", "y", CurveStyle::circle, "first region", kRegionRadius_m},
               {table, "hip_x", "hip_y", CurveStyle::line, "HIP"},
               {table, "contact_x", "contact_y", CurveStyle::line, "contact point"}},
              {.x_range = {{-0.03, 0.03}}, .equal_aspect = true});
}

// Force panels have the same range.
Panel force_panel(const std::string& title, const std::string& table, const PanelFrame& frame = {}) {
  Panel panel =
      plot(title, "x of the HIP (m)", "force (N)", {{table, "hip_x", "force", CurveStyle::line, ""}}, frame);
  panel.y_range = {0, 12};
  return panel;
}

// The stiffness that the experiment fixture-stiffness gives to a point.
double assigned_N_per_m(double x) {
  if (x >= 0.02) return 200;
  return 300 + 600 * std::clamp((x + 0.03) / 0.03, 0.0, 1.0);
}

Table stiffness_table(const Table& crossing) {
  const Numbers& place = numbers(crossing, "contact_x");
  return {
      "stiffness",
      "stiffness that is felt, and that of the points under the contact point",
      {{"contact_x", "m", "contact point along the plane", place},
       {"felt", "N/m", "force over the stretch of the virtual coupling", numbers(crossing, "felt")},
       {"assigned", "N/m", "stiffness of a point under the contact point", each(place, assigned_N_per_m)}}};
}

// Returns the largest relative error of the felt stiffness, over contact points that are farther from the
// ends of the ramp and from the step than a ball of r_3 reaches; NaN if there are none.
double max_stiffness_error(const Table& stiffness) {
  const Numbers &place = numbers(stiffness, "contact_x"), &felt = numbers(stiffness, "felt"),
                &assigned = numbers(stiffness, "assigned");
  const auto is_far = [&](std::size_t i) {
    const auto far_from = [&](double kink) { return std::abs(place[i] - kink) > 0.01; };
    return far_from(-0.03) && far_from(0) && far_from(0.02);
  };
  return max_where(place.size(), is_far, [&](std::size_t i) { return std::abs(felt[i] / assigned[i] - 1); });
}

// Both implementations make the same steps in double precision, so only rounding differs. A condition on the
// result may hold one tick later, when the HIP is 1e-5 m farther on.
constexpr double kForceAgrees_N = 1e-4, kPlaceAgrees_m = 1.1e-5;

// Claims that a value agrees with the second implementation. claim: up to its name; what: the measured
// quantity.
void claim_second(const Claims& claims, const std::string& claim, const std::string& what, double measured,
                  const std::string& name) {
  const double expected = second_number("chapter_5", "/crossing/" + name);
  const bool is_force = name.ends_with("_N");
  const double slack = is_force ? kForceAgrees_N : kPlaceAgrees_m;
  claims.between(claim + " the second implementation: " + what, measured, expected - slack, expected + slack,
                 is_force ? "N" : "m");
}

}  // namespace

Figure figure_5_6(FigureContext& context) {
  const Table at_zero = crossing(context, "fig5.6", "at_zero"),
              below = crossing(context, "fig5.6-below", "below"),
              stiffness_run = crossing(context, "fixture-stiffness", "stiffness_run"),
              stiffness = stiffness_table(stiffness_run);

  Figure figure{
      "5.6", "Virtual fixtures with varying radius and stiffness",
      "A flat 100 x 100 grid with r_f = 0 for x < 0 and 10 mm for x >= 0. The HIP moves along x, in "
      "the plane (left) and 5 mm below it (middle): force builds up before the proxy pops up onto "
      "the fixture. Right: a plane whose stiffness rises and then steps down, felt as the weighted "
      "mean (5.8) of the points around the proxy."};
  figure.tables = point_tables();
  for (const Table& table : {shown(at_zero), shown(below), stiffness, shown(stiffness_run)})
    figure.tables.push_back(table);
  const PanelFrame step{.x_range = {{-0.03, 0.03}}};
  figure.panels = {path_panel("HIP at y = 0", "at_zero"),
                   force_panel("Force, HIP at y = 0", "at_zero", step),
                   path_panel("HIP at y = -5 mm", "below"),
                   force_panel("Force, HIP at y = -5 mm", "below", step),
                   plot("Stiffness", "x of the contact point (m)", "stiffness (N/m)",
                        {{"stiffness", "contact_x", "assigned", CurveStyle::dashed, "assigned to points"},
                         {"stiffness", "contact_x", "felt", CurveStyle::line, "felt"}},
                        {.y_range = {{0, 1000}}}),
                   force_panel("Force over this stiffness", "stiffness_run")};
  for (std::size_t i = 0; i < figure.panels.size(); ++i) figure.panels[i].grid_position = {i % 2, i / 2};
  const double most_N = max_of(numbers(at_zero, "force")), most_below_N = max_of(numbers(below, "force"));
  const double on_fixture_m = 0.99 * (kRegionRadius_m + kContactRadius_m);
  const Claims claims(figure), in_plane(figure, "with the HIP in the plane of the points, "),
      deeper(figure, "with the HIP 5 mm below the points, ");
  claim_second(in_plane, "the force begins where it does in", "x of the HIP",
               first_x(at_zero, "force", kMin_N), "force_begins_m");
  claim_second(in_plane, "the largest force is that of", "its magnitude", most_N, "max_force_N");
  claim_second(in_plane, "the force is largest where it is in", "x of the HIP",
               first_x(at_zero, "force", most_N), "max_force_at_m");
  claim_second(in_plane, "the proxy is on the fixture (within 1 % of r_f + r_c) where it is in",
               "x of the HIP", first_x(at_zero, "proxy_y", on_fixture_m), "on_fixture_at_m");
  claim_second(in_plane, "the force on the fixture, k_s r_f, is that of", "its mean",
               mean_force(at_zero, 0.02, 0.03), "force_on_fixture_N");
  claim_second(deeper, "the force before the fixture is that of", "its mean",
               mean_force(below, -0.035, -0.025), "below_force_before_N");
  claim_second(deeper, "the largest force is that of", "its magnitude", most_below_N, "below_max_force_N");
  claim_second(deeper, "the proxy pops up where it does in", "x of the HIP",
               first_x(below, "force", most_below_N), "below_pops_up_at_m");
  claim_second(deeper, "the force on the fixture is that of", "its mean", mean_force(below, 0.02, 0.03),
               "below_force_on_fixture_N");
  claims.at_most(
      "the felt stiffness is that of the points, away from kinks and steps: largest relative difference",
      max_stiffness_error(stiffness), 0.01, "fraction");
  return figure;
}

// Fig 5.8: a beating organ is touched, and then kept at a distance by a fixture that grows.

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
  const std::vector<std::vector<std::string>> settings = {{}, kNoise};
  const std::vector<FixtureRun> runs = run_fixtures(
      context, list_of(settings, [](const auto& changed) { return Experiment::load("fig5.8", changed); }));
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
  figure.tables = {every(5, noise_free), every(5, with_noise), deviation_table(clean, noisy)};
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
