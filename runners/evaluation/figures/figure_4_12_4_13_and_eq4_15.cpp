// Fig 4.12: a noisy cloud is lifted with acceleration. Fig 4.13: maps of such lifts. Equation (4.15): the
// force on the hand while a cloud rises.

#include <algorithm>
#include <cmath>

#include "analysis/trace/curve_fits.h"
#include "analysis/trace/force_measures.h"
#include "runners/evaluation/figures/pop_through_map.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

namespace {

// Height of proxy and plane at the last tick of each frame.
Table heights_per_update(const Trace& trace) {
  TableRows rows;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (i + 1 < trace.length() && !trace.frame_update(i + 1)) continue;
    const double proxy_y = trace.proxy_position_m[i].y();
    rows.push_back(
        {static_cast<double>(trace.frame_index[i]), proxy_y, proxy_y - trace.signed_distance_m[i]});
  }
  return table_of("updates", "height before each update of the cloud",
                  {{"frame", "1", "number of the frame"},
                   {"proxy_y", "m", "height of the proxy's centre"},
                   {"plane_y", "m", "height of the true plane in the newest frame"}},
                  rows);
}

// Returns the share of lifts that did not pop through, over seeds 1 .. count.
double survival(FigureContext& context, int count, std::vector<std::string> settings) {
  std::vector<Experiment> lifts;
  settings.emplace_back();
  for (int seed = 1; seed <= count; ++seed) {
    settings.back() = seed_setting(seed);
    lifts.push_back(Experiment::load("fig4.12", settings));
  }
  return survived_share(context, lifts);
}

// A share of lifts that another implementation computed too, and how far two such shares may differ by
// chance.
struct SharedLifts {
  double survived = 0;  // share in the other implementation
  double variance = 0;  // variance of one lift about its node's probability
  double nodes = 0, lifts_a_node = 0;

  // Returns the standard error of the difference to a share over as many nodes, with our_lifts_a_node lifts
  // at each. One lift with a variance of 1 is added, so that the error is not 0 if no lift differed from the
  // other lifts of its node.
  double standard_error(double our_lifts_a_node) const {
    const double lifts = nodes * lifts_a_node, at_least = (variance * lifts + 1) / (lifts + 1);
    return std::sqrt(at_least / nodes * (1 / lifts_a_node + 1 / our_lifts_a_node));
  }
};

// Differences in standard errors that chance exceeds once in a thousand: for one comparison, and for the
// largest of n. Normal distribution, two-sided.
constexpr double kByChance = 3.3, kByChanceOf6 = 3.8, kByChanceOf25 = 4.1;

// Claims that a share differs from the other implementation's by no more than chance allows.
void claim_agrees(const Claims& claims, const std::string& claim, double measured, const SharedLifts& other,
                  double our_lifts_a_node, const std::string& paper = "-") {
  const double slack = kByChance * other.standard_error(our_lifts_a_node);
  claims.between(claim, measured, std::max(0.0, other.survived - slack),
                 std::min(1.0, other.survived + slack), "fraction", paper);
}

// Returns a share of lifts in the second implementation, which made one lift at each node. place:
// "/map/whole", or "/map/coarse" (every third noise and second acceleration).
SharedLifts second_fraction(const std::string& place) {
  const auto number = [&](const char* what) { return second_number("chapter_4", place + "/" + what); };
  return {number("survived"), number("variance"), number("nodes"), 1};
}

// Fig 4.13: 5396 lifts, noise against acceleration; and a coarser map with replicates: probabilities and
// where they cross one half, with confidence.

// Adds the survival of the same regions in the second implementation, and the difference from ours in
// standard errors.
Table with_second_implementation(Table regions) {
  const auto column = [](const char* name) { return second_column("chapter_4", "/map/regions", name); };
  const std::vector<double> second = column("survived"), variance = column("variance"),
                            nodes = column("nodes"), &survived = numbers(regions, "survived");
  const Numbers apart = each_of(second.size(), [&](std::size_t i) {
    return (survived.at(i) - second[i]) / SharedLifts{second[i], variance[i], nodes[i], 1}.standard_error(1);
  });
  regions.add("second_implementation", "1", "the same by the second implementation", second);
  regions.add("difference_in_standard_errors", "1", "difference in units of its standard error", apart);
  return regions;
}

// Returns, for each noise strength, the acceleration at which half of the lifts pop through, with its
// interval (curve_fits.h); the end of the map if that is beyond it; NaN where the curve rises and falls.
Table contour(const std::string& name, const SweepResult& result) {
  const std::vector<double>& popped = result.measure("popped_through");
  TableRows rows;
  for (std::size_t noise = 0; noise < result.axes.at(0).length(); ++noise) {
    std::vector<RunsAtValue> values;
    for (std::size_t i = 0; i < result.axes.at(1).length(); ++i) {
      const std::size_t cell = result.cell_at({noise, i});
      values.push_back({axis_value(result, 1, cell) / kContactRadius_m, event_counts(result, popped, cell)});
    }
    const Limit limit = estimated_limit(values, {});
    const double end = limit.place == LimitPlace::below_the_first  ? values.front().x
                       : limit.place == LimitPlace::above_the_last ? values.back().x
                                                                   : kNoValue;
    const Estimate& e = limit.estimate;
    rows.push_back({axis_value(result, 0, result.cell_at({noise, 0})) / kContactRadius_m,
                    limit.place == LimitPlace::inside ? e.value : end, e.low, e.high});
  }
  Table table = table_of(name, "acceleration at which half of the lifts survive",
                         {kNoiseColumn,
                          {"acceleration", "r_c/s^2", "half of the lifts survive"},
                          {"low", "r_c/s^2", "lower end of its 95 % interval; NaN: open"},
                          {"high", "r_c/s^2", "upper end of its 95 % interval; NaN: open"}},
                         rows);
  add_bound(table, "printed_bound", "(4.25) as printed", printed_bound);
  return table;
}

// Returns the contour in the second implementation, and its distance from ours in standard errors; NaN at a
// noise strength that our map lacks, as a thinned one does.
Table second_table(const Table& contour) {
  const auto column = [](const char* name) { return second_column("chapter_4", "/map/contour/rows", name); };
  const std::vector<double> noise = column("noise"), second = column("acceleration"),
                            error = column("standard_error"), our_error = column("standard_error_of_20"),
                            &ours = numbers(contour, "noise");
  TableRows rows;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const auto same = [&](double strength) { return std::abs(strength - noise[i]) < 1e-9; };
    const auto at = static_cast<std::size_t>(std::find_if(ours.begin(), ours.end(), same) - ours.begin());
    const double acceleration = at < ours.size() ? numbers(contour, "acceleration")[at] : kNoValue;
    rows.push_back(
        {noise[i], second[i], acceleration, (acceleration - second[i]) / std::hypot(error[i], our_error[i])});
  }
  return table_of(
      "contour_second", "the contour by the second implementation, six noise strengths",
      {kNoiseColumn,
       {"second_implementation", "r_c/s^2", "half of the lifts survive in the second implementation"},
       {"acceleration", "r_c/s^2", "half of the lifts survive here"},
       {"difference_in_standard_errors", "1", "difference in units of its standard error"}},
      rows);
}

Panel probability_panel(const std::string& title, const std::string& map, const std::string& contour) {
  return map_panel(title, {{map, "noise", "acceleration", CurveStyle::map, "", 0, "survived"},
                           {contour, "noise", "acceleration", CurveStyle::line, "half survive"},
                           {contour, "noise", "low", CurveStyle::dashed, "ends of its 95 % interval"},
                           {contour, "noise", "high", CurveStyle::dashed, "ends of its 95 % interval"},
                           {"bound", "noise", "printed", CurveStyle::line, "bound (4.25) as printed"}});
}

}  // namespace

Figure figure_4_12(FigureContext& context) {
  constexpr int kSeeds = 300;
  const Trace trace = context.run(Experiment::load("fig4.12"));
  Figure figure{
      "4.12", "Lifted point cloud",
      "A 200 x 200 cloud with noise sigma = 0.6 r_c rises at 20 r_c/s and then accelerates with 600 "
      "r_c/s^2 for ten updates. Height of the proxy and of the true plane just before each update."};
  figure.tables = {heights_per_update(trace)};
  figure.panels = {plot("Height before each update", "frame", "y (m)",
                        {{"updates", "frame", "plane_y", CurveStyle::dashed, "true plane"},
                         {"updates", "frame", "proxy_y", CurveStyle::dots, "proxy"}})};
  const std::vector<std::string> without = {"renderer.velocity_estimate=false"};
  const auto second = [](const std::string& what) {
    return second_number("chapter_4", "/lifts/noisy/" + what);
  };
  const SharedLifts other{second("survived"), second("survived") * (1 - second("survived")), 1,
                          second("lifts")};
  // The last update decides if there is no velocity estimate: it moves the plane by (v_0 + 10 a / f_c) / f_c.
  // The proxy pops through if that is more than r_1 less the depth by which it sinks in the middle of four
  // points, up to 0.113 mm. So the limit is from 0.139 to 0.149 m/s^2.
  const Claims claims(figure);
  claim_agrees(
      claims,
      "lifts with a = 3 m/s^2 and noise of 3 mm pop through as often as in the second implementation: "
      "fraction of 300 that do not",
      survival(context, kSeeds, {}), other, kSeeds, "1 of 1");
  claims.at_least(
      "without noise, no lift with a = 4.3 m/s^2 pops through: fraction of 16 grid phases that do not",
      survived_over_phases(context, 4, 4.3), 1, "fraction", "a < 4.491 (4.14)");
  claims.at_most(
      "without noise, every lift with a = 4.6 m/s^2 pops through: fraction of 16 grid phases that do not",
      survived_over_phases(context, 4, 4.6), 0, "fraction", "a < 4.491 (4.14)");
  claims.at_least(
      "without noise and velocity estimate, no lift with a = 0.138 m/s^2 pops through: fraction of 16 "
      "grid phases that do not",
      survived_over_phases(context, 4, 0.138, without), 1, "fraction");
  claims.at_most(
      "without noise and velocity estimate, every lift with a = 0.15 m/s^2 pops through: fraction of 16 "
      "grid phases that do not",
      survived_over_phases(context, 4, 0.15, without), 0, "fraction");
  claims.differs(
      "without acceleration, some lifts with noise of 2 r_c pop through: fraction of 300 that do",
      1 - survival(context, kSeeds, {"scenario.acceleration_m_per_s2=0", "scenario.noise_sigma_m=0.01"}),
      1.0 / kSeeds, 0.06, "fraction", "never up to 2 r_c (4.4.2)");
  return figure;
}

Figure figure_4_13(FigureContext& context) {
  const Table map = map_table("map", context.sweep(context.map("fig4.13")));
  const Table without = map_table(
      "map_without_estimate", context.sweep(context.map("fig4.13", {"renderer.velocity_estimate=false"})));
  const Table regions = with_second_implementation(region_table("regions", map));
  Figure figure{
      "4.13", "Pop-through map",
      "5396 lifts of a 200 x 200 cloud, noise against acceleration, 1000 proxy steps per frame. A filled "
      "square is a lift that did not pop through. Right: the same noise without the velocity estimate."};
  figure.tables = {map,     survivors("survived", map),
                   without, survivors("survived_without_estimate", without),
                   regions, bound_table()};
  figure.panels = {survivor_panel("With the velocity estimate", "survived"),
                   survivor_panel("Without the velocity estimate", "survived_without_estimate")};
  place_in_rows(figure, 2);
  const Claims map_claims(figure, "", &Claim::of_map);
  claim_agrees(map_claims,
               "lifts of the whole map (5396, 1000 steps per frame) pop through as often as in the second "
               "implementation: fraction that do not",
               share_of_known(numbers(map, "survived")), second_fraction("/map/whole"), 1);
  map_claims.at_most(
      "lifts in each of 25 regions of the map pop through as often as in the second implementation: "
      "largest difference, in standard errors",
      max_apart(regions), kByChanceOf25, "1");
  map_claims.between(
      "without the velocity estimate most lifts of the whole map pop through: fraction that do not",
      share_of_known(numbers(without, "survived")), 0.03, 0.09, "fraction");
  return figure;
}

Figure figure_4_13_replicated(FigureContext& context) {
  const SweepResult result = context.sweep(context.map("fig4.13-replicated"));
  const Table map = map_table("map", result);
  const SweepResult without_estimate =
      context.sweep(context.map("fig4.13-replicated", {"renderer.velocity_estimate=false"}));
  const Table without = map_table("map_without_estimate", without_estimate);
  const Table half = contour("contour", result), second = second_table(half);
  Figure figure{
      "4.13-replicated", "Probability of pop-through",
      "Every third noise and second acceleration of Fig 4.13, 20 lifts each, 1000 proxy steps per frame: "
      "share of lifts that did not pop through, and where it crosses one half, with 95 % intervals."};
  figure.tables = {map,    without,      half, contour("contour_without_estimate", without_estimate),
                   second, bound_table()};
  figure.panels = {
      probability_panel("With the velocity estimate", "map", "contour"),
      probability_panel("Without the velocity estimate", "map_without_estimate", "contour_without_estimate")};
  place_in_rows(figure, 2);
  constexpr double kLiftsANode = 20;
  const Claims map_claims(figure, "", &Claim::of_map);
  claim_agrees(map_claims,
               "lifts of the map (20 at each node) pop through as often as in the second implementation: "
               "fraction that do not",
               share_of_known(numbers(map, "survived")), second_fraction("/map/coarse"), kLiftsANode);
  map_claims.between(
      "without the velocity estimate most lifts of the map (20 at each node) pop through: fraction that "
      "do not",
      share_of_known(numbers(without, "survived")), 0.03, 0.09, "fraction");
  map_claims.at_most(
      "half of the lifts pop through at the same acceleration as in the second implementation: largest "
      "difference at six noise strengths, in standard errors",
      max_apart(second), kByChanceOf6, "1");
  return figure;
}

// Equation (4.15): the force between the updates of a cloud that moves at a constant velocity, for the three
// readings of its sign.

namespace {

Experiment steady_rise(const std::string& sign) {
  return Experiment::from_json(R"({
    "title": "a noise-free plane rises at 0.1 m/s under a HIP that keeps its depth",
    "scenario": {"name": "moving-lift", "noise_sigma_m": 0, "rise_s": 2, "acceleration_s": 0},
    "renderer": {"name": "proxy"},
    "trajectory": {"name": "press", "press_at_s": 0.5, "depth_m": 0.03, "surface": "moving"},
    "duration_s": 1.9})",
                               "eq4.15", {"renderer.velocity_force=" + sign});
}

// (4.13) sets a negative estimate to 0, "since there is no risk for pop through", so (4.15) has no term here.
Experiment steady_fall() {
  return Experiment::from_json(R"({
    "title": "a noise-free plane recedes at 0.1 m/s from a HIP that keeps its depth",
    "scenario": {"name": "moving-lift", "noise_sigma_m": 0, "wait_s": 0.2, "start_depth_m": 0,
                 "start_velocity_m_per_s": -0.1, "rise_s": 2, "acceleration_s": 0},
    "renderer": {"name": "proxy"},
    "trajectory": {"name": "press", "start_m": [0, 0.02, 0], "press_at_s": 0.1, "depth_m": 0.03,
                   "surface": "moving"},
    "duration_s": 1.9})",
                               "eq4.15");
}

// Returns the part of the trace from 1 s on, when the velocity estimate has settled.
Trace settled(const Trace& trace) {
  Trace part;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.time_s[i] < 1.0) continue;
    RenderOutput out;
    out.proxy_W = trace.proxy_position_m[i], out.force_N = trace.force_N[i],
    out.frame_index = trace.frame_index[i];
    part.append(trace.time_s[i], {trace.hip_position_m[i]}, out,
                {trace.signed_distance_m[i], trace.slave_distance_m[i], 0});
  }
  return part;
}

}  // namespace

Figure figure_eq4_15(FigureContext& context) {
  Figure figure{"eq4.15", "Force between updates",
                "A noise-free plane rises at 0.1 m/s under a HIP that keeps its depth, so the true force "
                "is constant. The velocity term of (4.15) as printed (plus), left out (none), and with "
                "the sign that removes the jump (minus)."};
  // Three frames.
  figure.panels = {plot("A plane that rises at 0.1 m/s", "time (s)", "force (N)", {},
                        {.x_range = {{1.0, 1.1}}, .y_range = {{13, 19}}})};
  std::vector<double> jump;
  const std::pair<const char*, const char*> readings[] = {
      {"plus", "plus (as printed)"}, {"none", "no term"}, {"minus", "minus (used)"}};
  for (const auto& [sign, label] : readings) {
    const Trace trace = settled(context.run(steady_rise(sign)));
    jump.push_back(max_force_jump_N(trace));
    figure.tables.push_back({sign,
                             std::string("force with the term ") + sign,
                             {{"time", "s", "simulated time", trace.time_s},
                              {"force", "N", "magnitude of the force", norms(trace.force_N)}}});
    figure.panels[0].curves.push_back({sign, "time", "force", CurveStyle::line, label});
  }
  // The plane jumps by v / f_c, and in the same tick the HIP follows it by v / f_h. The printed sign doubles
  // the jump.
  constexpr double kJump_N = 600 * 0.1 * (1.0 / 30 - 1.0 / 1000), kRounding_N = 1e-6;
  const Claims claims(figure);
  claims.at_most(
      "with the minus sign the force does not jump at the frames of a surface that rises at 0.1 m/s: jump",
      jump[2], kRounding_N, "N", "smooth");
  claims.differs(
      "with the printed plus sign the force jumps at the frames of a surface that rises at 0.1 m/s: jump",
      jump[0], 2 * kJump_N - kRounding_N, 2 * kJump_N + kRounding_N, "N", "smooth");
  claims.between(
      "without the velocity term the force jumps at the frames of a surface that rises at 0.1 m/s: jump",
      jump[1], kJump_N - kRounding_N, kJump_N + kRounding_N, "N");
  claims.differs(
      "with the minus sign the force jumps at the frames of a surface that recedes, because v_hat is "
      "never below 0 (4.13): jump",
      max_force_jump_N(settled(context.run(steady_fall()))), kJump_N - kRounding_N, kJump_N + kRounding_N,
      "N", "smooth");
  return figure;
}

}  // namespace remote_touch
