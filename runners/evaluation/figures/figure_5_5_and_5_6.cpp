// Fig 5.5: the region around a single point.

#include <algorithm>
#include <cmath>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
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
            {"distances", "time", "radius", CurveStyle::dashed, "boundary of the region, r_f"},
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
constexpr double kMin_N = 0.01;  // a force above this is felt

// Returns positions, force, and force over stretch of the ticks in which the HIP moves towards larger x.
Table crossing(FigureContext& context, const char* experiment, const std::string& name) {
  const Trace t = context.run(experiment);
  std::vector<std::size_t> ticks;
  for (std::size_t i = 1; i < t.length(); ++i)
    if (t.hip_position_m[i].x() > t.hip_position_m[i - 1].x()) ticks.push_back(i);
  std::vector<Vec3> contact;
  for (std::size_t i = 0; i < t.length(); ++i) contact.push_back(contact_point(t, i, kContactRadius_m));
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

// Returns the x of the HIP when the condition on the row holds for the first time; NaN if it never holds.
template <class Condition>
double first_x(const Table& crossing, Condition&& holds) {
  const Numbers& x = numbers(crossing, "hip_x");
  for (std::size_t i = 0; i < x.size(); ++i)
    if (holds(i)) return x[i];
  return kNoValue;
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
Panel force_panel(const std::string& table, const PanelFrame& frame = {}) {
  Panel panel = plot("Force", "x of the HIP (m)", "force (N)",
                     {{table, "hip_x", "force", CurveStyle::line, ""}}, frame);
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

// Claims that a value agrees with the second implementation.
void claim_second(const Claims& claims, const std::string& claim, double measured, const std::string& name) {
  const double expected = second_number("chapter_5", "/crossing/" + name);
  const bool is_force = name.ends_with("_N");
  const double slack = is_force ? kForceAgrees_N : kPlaceAgrees_m;
  claims.between(claim, measured, expected - slack, expected + slack, is_force ? "N" : "m");
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
                   force_panel("at_zero", step),
                   path_panel("HIP at y = -5 mm", "below"),
                   force_panel("below", step),
                   plot("Stiffness", "x of the contact point (m)", "stiffness (N/m)",
                        {{"stiffness", "contact_x", "assigned", CurveStyle::dashed, "assigned to points"},
                         {"stiffness", "contact_x", "felt", CurveStyle::line, "felt"}},
                        {.y_range = {{0, 1000}}}),
                   force_panel("stiffness_run")};
  for (std::size_t i = 0; i < figure.panels.size(); ++i) figure.panels[i].grid_position = {i % 2, i / 2};
  const Numbers &force = numbers(at_zero, "force"), &proxy_y = numbers(at_zero, "proxy_y"),
                &force_below = numbers(below, "force");
  const auto is_felt = [&](std::size_t i) { return force[i] > kMin_N; };
  const auto on_fixture = [&](std::size_t i) {
    return proxy_y[i] >= 0.99 * (kRegionRadius_m + kContactRadius_m);
  };
  const double most_N = max_of(force), most_below_N = max_of(force_below);
  const auto is_most = [&](std::size_t i) { return force[i] == most_N; };
  const auto is_most_below = [&](std::size_t i) { return force_below[i] == most_below_N; };
  const Claims claims(figure);
  claim_second(claims,
               "with the HIP in the plane of the points, the force begins where it does in the second "
               "implementation: x of the HIP",
               first_x(at_zero, is_felt), "force_begins_m");
  claim_second(
      claims,
      "with the HIP in the plane of the points, the largest force is that of the second implementation: "
      "its magnitude",
      most_N, "max_force_N");
  claim_second(claims,
               "with the HIP in the plane of the points, the force is largest where it is in the second "
               "implementation: x of the HIP",
               first_x(at_zero, is_most), "max_force_at_m");
  claim_second(
      claims,
      "with the HIP in the plane of the points, the proxy is on the fixture (within 1 % of r_f + r_c) "
      "where it is in the second implementation: x of the HIP",
      first_x(at_zero, on_fixture), "on_fixture_at_m");
  claim_second(claims,
               "with the HIP in the plane of the points, the force on the fixture, k_s r_f, is that of the "
               "second implementation: its mean",
               mean_force(at_zero, 0.02, 0.03), "force_on_fixture_N");
  claim_second(claims,
               "with the HIP 5 mm below the points, the force before the fixture is that of the second "
               "implementation: its mean",
               mean_force(below, -0.035, -0.025), "below_force_before_N");
  claim_second(
      claims,
      "with the HIP 5 mm below the points, the largest force is that of the second implementation: its "
      "magnitude",
      most_below_N, "below_max_force_N");
  claim_second(claims,
               "with the HIP 5 mm below the points, the proxy pops up where it does in the second "
               "implementation: x of the HIP",
               first_x(below, is_most_below), "below_pops_up_at_m");
  claim_second(claims,
               "with the HIP 5 mm below the points, the force on the fixture is that of the second "
               "implementation: its mean",
               mean_force(below, 0.02, 0.03), "below_force_on_fixture_N");
  claims.at_most(
      "the felt stiffness is that of the points, away from kinks and steps: largest relative difference",
      max_stiffness_error(stiffness), 0.01, "fraction");
  return figure;
}

}  // namespace remote_touch
