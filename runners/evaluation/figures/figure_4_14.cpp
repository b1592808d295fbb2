// Fig 4.14: sharp corners, against what a ball of radius r_c can reach.
#include <algorithm>
#include <cmath>

#include "analysis/measures/contact_measures.h"
#include "analysis/measures/interval_estimates.h"
#include "analysis/theory/exact_contacts.h"
#include "core/kernels/isa.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

constexpr double kSampling_m = 1e-5;  // sampling of the exact profile; its corners are multiples of it

// The true profile and its closing with a ball of radius r_c, sampled from x = low on.
struct Oracle {
  double low;
  std::vector<double> heights, closing;

  Oracle(const Scenario& scenario, double from, double to) : low(from) {
    for (int i = 0; from + i * kSampling_m <= to; ++i)
      heights.push_back(scenario.surface_height(from + i * kSampling_m, 0, 0));
    closing = ball_closing(heights, kSampling_m, kContactRadius_m);
  }
  double at(double x) const {
    const double place = (x - low) / kSampling_m;
    const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(closing.size() - 2)));
    return closing[i] + (place - static_cast<double>(i)) * (closing[i + 1] - closing[i]);
  }
};

struct Contact {
  double x, y, error, shell;
};

std::vector<Contact> contacts(const Trace& trace, const Oracle& oracle, double from, double to) {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const Vec3 p = contact_point(trace, i, kContactRadius_m);
    if (!pressing(trace, i, kContactRadius_m) || p.x() < from || p.x() > to) continue;
    contacts.push_back(
        {p.x(), p.y(), p.y() - oracle.at(p.x()), trace.nearest_distance_m[i] - kContactRadius_m});
  }
  return contacts;
}

double max_magnitude(const std::vector<double>& values) {
  return max_where(
      values.size(), [](std::size_t) { return true; }, [&](std::size_t i) { return std::abs(values[i]); });
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return values.empty() ? std::nan("") : std::sqrt(sum / static_cast<double>(values.size()));
}

Table contact_table(const std::vector<Contact>& contacts) {
  return table_over<Contact>(
      "contact", "contact point", contacts,
      {{"x", "m", "position of the contact point", &Contact::x},
       {"y", "m", "height of the contact point", &Contact::y},
       {"error", "m", "height over the exact closing with a ball of r_c", &Contact::error},
       {"shell", "m", "distance of the nearest point less r_c", &Contact::shell}});
}

Table profile_table(const Oracle& oracle) {
  TableRows rows;
  for (std::size_t i = 0; i < oracle.heights.size(); i += 20)
    rows.push_back({oracle.low + static_cast<double>(i) * kSampling_m, oracle.heights[i], oracle.closing[i]});
  return table_of("profile", "exact profile and its closing",
                  {{"x", "m", "position"},
                   {"surface_y", "m", "true height"},
                   {"closing_y", "m", "height that a ball of r_c can reach"}},
                  rows);
}

Table surface_table(const PointCloud& cloud) {
  Table table{"surface", "the points"};
  table.add("x", "m", "x of the point", {cloud.x.begin(), cloud.x.end()});
  table.add("y", "m", "height, y", {cloud.y.begin(), cloud.y.end()});
  table.add("z", "m", "z of the point", {cloud.z.begin(), cloud.z.end()});
  return table;
}

// Returns the points of the grid row under the path, and the position of the proxy when it is nearest to
// valley_x, the last full valley.
std::vector<Table> points_and_ball(const Scenario& scenario, const Trace& trace, double valley_x) {
  const PointCloud cloud = scenario.cloud(0);
  TableRows points;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (std::abs(cloud.z[i] - trace.hip_position_m[0].z()) < 1e-6) points.push_back({cloud.x[i], cloud.y[i]});
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (std::abs(trace.proxy_position_m[i].x() - valley_x) <
        std::abs(trace.proxy_position_m[nearest].x() - valley_x))
      nearest = i;
  const Vec3& ball = trace.proxy_position_m[nearest];
  const std::vector<ColumnName> columns = {{"x", "m", "position"}, {"y", "m", "height"}};
  return {table_of("points", "one row of the grid", columns, points),
          table_of("ball", "the proxy in a valley", columns, {{ball.x(), ball.y()}})};
}

}  // namespace

Figure figure_4_14(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig4.14");
  const auto scenario = experiment.build_scenario(kernels_for(Isa::x86_64));
  const Trace trace = context.run(experiment);
  constexpr double kFrom = -0.2, kTo = 0.2;  // the ends of the grid have no neighbours on one side
  const Oracle oracle(*scenario, -0.22, 0.22);
  const std::vector<Contact> contact = contacts(trace, oracle, kFrom, kTo);

  Figure figure{
      "4.14", "Sharp corners",
      "A 300 x 100 cloud shaped as a triangle wave of growing amplitude. Top: the points as a "
      "surface. Middle: a cross-section of the wave and the contact point. Bottom: a part of it, "
      "with the points and the proxy, a ball of radius r_c. Convex corners are rendered sharp; in a "
      "valley the proxy rests on both flanks."};
  figure.tables = {contact_table(contact), profile_table(oracle), surface_table(scenario->cloud(0))};
  for (Table& table : points_and_ball(*scenario, trace, 0.135)) figure.tables.push_back(std::move(table));
  const Curve points{"points", "x", "y", CurveStyle::dots, "points"};
  const Curve line{"contact", "x", "y", CurveStyle::line, "contact point"};
  figure.panels = {
      plot("The point cloud, x, y and z equally scaled", "x (m)", "z (m)",
           {{"surface", "x", "z", CurveStyle::surface, "", 0, "y"}}),
      plot("The whole wave", "x (m)", "y (m)",
           {{"profile", "x", "surface_y", CurveStyle::dashed, "surface"}, line}),
      plot("A part of it", "x (m)", "y (m)",
           {points,
            line,
            {"ball", "x", "y", CurveStyle::circle, "proxy, a ball of radius r_c", kContactRadius_m}},
           {.x_range = {{0.095, 0.175}}, .y_range = {{-0.014, 0.015}}, .equal_aspect = true})};
  const Claims claims(figure);
  const std::vector<double>& error = numbers(figure.tables[0], "error");
  claims.at_most("the contact point follows the exact closing of the wave with a ball of r_c: rms distance",
                 rms(error), 1e-4, "m", "very well");
  claims.at_most(
      "the contact point follows the exact closing of the wave with a ball of r_c: largest distance",
      max_magnitude(error), 5e-4, "m");
  claims.at_most("the nearest point is r_c from the proxy: largest difference",
                 max_magnitude(numbers(figure.tables[0], "shell")), 2e-5, "m", "1e-5");
  return figure;
}

}  // namespace remote_touch
