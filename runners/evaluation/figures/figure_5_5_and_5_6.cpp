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

// The point is the origin, so distances to it are lengths. Both radii are columns, to be drawn as lines.
Table distances(const Trace& t) {
  TableRows rows;
  for (std::size_t i = 0; i < t.length(); ++i)
    rows.push_back({t.time_s[i], t.proxy_position_m[i].norm(), t.hip_position_m[i].norm(),
                    t.force_N[i].norm(), kFixtureRadius_m, kBoundary_m});
  return table_of("distances", "distances to the point, and the force",
                  {{"time", "s", "simulated time"},
                   {"proxy", "m", "distance of the proxy's centre to the point"},
                   {"hip", "m", "distance of the HIP to the point"},
                   {"force", "N", "magnitude of the force"},
                   {"radius", "m", "r_f"},
                   {"boundary", "m", "r_f + r_c"}},
                  rows);
}

double entrenched_ticks(const Trace& trace) {
  return static_cast<double>(std::count(trace.state.begin(), trace.state.end(),
                                        static_cast<std::int32_t>(ContactState::entrenched)));
}

// Returns the largest distance between proxy and HIP over the ticks in which the HIP is outside the region;
// NaN if it never is.
double max_gap_outside(const Trace& trace) {
  return max_where(
      trace.length(), [&](std::size_t i) { return trace.hip_position_m[i].norm() > kBoundary_m; },
      [&](std::size_t i) { return (trace.proxy_position_m[i] - trace.hip_position_m[i]).norm(); });
}

// Returns the largest difference between the force and k_s times the depth of the HIP in the region, over the
// ticks in which the HIP is inside; NaN if it never is. The depth is the distance from the HIP to the contact
// point of a proxy that rests where the region is nearest to the HIP.
double max_force_error(const Trace& trace) {
  const auto depth_m = [&](std::size_t i) { return kFixtureRadius_m - trace.hip_position_m[i].norm(); };
  return max_where(
      trace.length(), [&](std::size_t i) { return !(depth_m(i) <= 0); },
      [&](std::size_t i) { return std::abs(trace.force_N[i].norm() - kStiffness_N_per_m * depth_m(i)); });
}

}  // namespace

Figure figure_5_5(FigureContext& context) {
  const Trace trace = context.run(Experiment::load("fig5.5"));
  Figure figure{"5.5", "Single point virtual fixture",
                "One point at the origin with r_f = 100 mm. The HIP passes through its region, leaves it and "
                "crosses its rim. The proxy's centre stays r_f + r_c away; the force is k_s times the depth "
                "of the HIP in the region."};
  figure.tables = {distances(trace)};
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
      min_of(numbers(figure.tables[0], "proxy")), kBoundary_m - 1e-6, kBoundary_m + 1e-6, "m", ">= 0.105");
  claims.at_most("no tick ends with the proxy entrenched: ticks that do", entrenched_ticks(trace), 0,
                 "ticks");
  claims.at_most("the proxy is at the HIP while the HIP is outside the region: largest distance",
                 max_gap_outside(trace), kShell_5_5_m, "m", "0");
  claims.at_most("the force is k_s times the depth of the HIP in the region: largest difference",
                 max_force_error(trace), kStiffness_N_per_m * kShell_5_5_m, "N");
  Claims(figure, "", &Claim::set_up)
      .at_most("the HIP enters the region: its smallest distance to the point",
               min_of(numbers(figure.tables[0], "hip")), kBoundary_m, "m");
  return figure;
}

// Fig 5.6: the proxy climbs onto a fixture of larger radius; and a stiffness that varies across a plane.

namespace {

constexpr double kRegionRadius_m = 0.01;
constexpr double kMin_N = 0.01;  // a force above this is felt

// The ticks of a run in which the HIP moves towards larger x: positions, force, and force over stretch.
struct RegionCrossing {
  std::vector<double> hip_x, hip_y, proxy_y, contact_x, contact_y, force, stiffness;
};

RegionCrossing crossing(const Trace& trace) {
  RegionCrossing c;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (!(trace.hip_position_m[i].x() > trace.hip_position_m[i - 1].x())) continue;
    const Vec3 contact = contact_point(trace, i, kContactRadius_m);
    const double stretch = (trace.hip_position_m[i] - trace.proxy_position_m[i]).norm() - kContactRadius_m;
    c.hip_x.push_back(trace.hip_position_m[i].x()), c.hip_y.push_back(trace.hip_position_m[i].y());
    c.proxy_y.push_back(trace.proxy_position_m[i].y());
    c.contact_x.push_back(contact.x()), c.contact_y.push_back(contact.y());
    c.force.push_back(trace.force_N[i].norm());
    c.stiffness.push_back(c.force.back() / stretch);
  }
  return c;
}

Table crossing_table(const std::string& name, const RegionCrossing& c) {
  Table table{name, "contact point, HIP and force while the HIP moves along x"};
  table.add("hip_x", "m", "HIP along the plane", c.hip_x);
  table.add("hip_y", "m", "height of the HIP", c.hip_y);
  table.add("contact_x", "m", "contact point along the plane", c.contact_x);
  table.add("contact_y", "m", "height of the contact point", c.contact_y);
  table.add("force", "N", "magnitude of the force", c.force);
  return table;
}

// Returns the x of the HIP when the condition on the row holds for the first time; NaN if it never holds.
template <class Condition>
double first_x(const RegionCrossing& c, Condition&& holds) {
  for (std::size_t i = 0; i < c.hip_x.size(); ++i)
    if (holds(i)) return c.hip_x[i];
  return kNoValue;
}

std::size_t row_of_max_force(const RegionCrossing& c) {
  return static_cast<std::size_t>(std::max_element(c.force.begin(), c.force.end()) - c.force.begin());
}

// Returns the mean force over the rows with the HIP between from_x and to_x; NaN if there are none.
double mean_force(const RegionCrossing& c, double from_x, double to_x) {
  return mean(values_where(
      c.hip_x.size(), [&](std::size_t i) { return c.hip_x[i] >= from_x && c.hip_x[i] <= to_x; },
      [&](std::size_t i) { return c.force[i]; }));
}

// Returns two tables: the points of the cloud near the step, and the first point with r_f = 0.01 m.
std::vector<Table> point_tables() {
  TableRows points;
  for (int i = -20; i < 20; ++i) points.push_back({0.0015 * (i + 0.5), 0});
  const std::vector<ColumnName> columns = {{"x", "m", "along the plane"}, {"y", "m", "height"}};
  return {table_of("points", "points of the cloud near the step", columns, points),
          table_of("first_region", "the first point with a region", columns, {{0.00075, 0}})};
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

Table stiffness_table(const RegionCrossing& c) {
  TableRows rows;
  for (std::size_t i = 0; i < c.contact_x.size(); ++i)
    rows.push_back({c.contact_x[i], c.stiffness[i], assigned_N_per_m(c.contact_x[i])});
  return table_of("stiffness", "stiffness that is felt, and that of the points under the contact point",
                  {{"contact_x", "m", "contact point along the plane"},
                   {"felt", "N/m", "force over the stretch of the virtual coupling"},
                   {"assigned", "N/m", "stiffness of a point under the contact point"}},
                  rows);
}

// Returns the largest relative error of the felt stiffness, over contact points that are farther from the
// ends of the ramp and from the step than a ball of r_3 reaches; NaN if there are none.
double max_stiffness_error(const RegionCrossing& c) {
  const auto is_far = [&](std::size_t i) {
    const auto far_from = [&](double place) { return std::abs(c.contact_x[i] - place) > 0.01; };
    return far_from(-0.03) && far_from(0) && far_from(0.02);
  };
  return max_where(c.contact_x.size(), is_far, [&](std::size_t i) {
    return std::abs(c.stiffness[i] / assigned_N_per_m(c.contact_x[i]) - 1);
  });
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
  const RegionCrossing at_zero = crossing(context.run(Experiment::load("fig5.6")));
  const RegionCrossing below = crossing(context.run(Experiment::load("fig5.6-below")));
  const RegionCrossing stiffness = crossing(context.run(Experiment::load("fixture-stiffness")));

  Figure figure{
      "5.6", "Virtual fixtures with varying radius and stiffness",
      "A flat 100 x 100 grid with r_f = 0 for x < 0 and 10 mm for x >= 0. The HIP moves along x, in "
      "the plane (left) and 5 mm below it (middle): force builds up before the proxy pops up onto "
      "the fixture. Right: a plane whose stiffness rises and then steps down, felt as the weighted "
      "mean (5.8) of the points around the proxy."};
  figure.tables = point_tables();
  figure.tables.push_back(crossing_table("at_zero", at_zero));
  figure.tables.push_back(crossing_table("below", below));
  figure.tables.push_back(stiffness_table(stiffness));
  figure.tables.push_back(crossing_table("stiffness_run", stiffness));
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

  const std::size_t peak = row_of_max_force(at_zero), peak_below = row_of_max_force(below);
  const auto on_fixture = [&](std::size_t i) {
    return at_zero.proxy_y[i] >= 0.99 * (kRegionRadius_m + kContactRadius_m);
  };
  const Claims claims(figure);
  claim_second(claims,
               "with the HIP in the plane of the points, the force begins where it does in the second "
               "implementation: x of the HIP",
               first_x(at_zero, [&](std::size_t i) { return at_zero.force[i] > kMin_N; }), "force_begins_m");
  claim_second(
      claims,
      "with the HIP in the plane of the points, the largest force is that of the second implementation: "
      "its magnitude",
      at_zero.force[peak], "max_force_N");
  claim_second(claims,
               "with the HIP in the plane of the points, the force is largest where it is in the second "
               "implementation: x of the HIP",
               at_zero.hip_x[peak], "max_force_at_m");
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
      below.force[peak_below], "below_max_force_N");
  claim_second(claims,
               "with the HIP 5 mm below the points, the proxy pops up where it does in the second "
               "implementation: x of the HIP",
               below.hip_x[peak_below], "below_pops_up_at_m");
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
