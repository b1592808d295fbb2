#include "runners/evaluation/figures/parts/box_contacts.h"

#include <algorithm>
#include <cmath>

#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

constexpr double kPrintedContacts = 6;  // 6.3.1

// Maxima over a run, for each spacing.
struct Counts {
  std::string name, rule;       // name in tables; rule of the experiment
  double known_at_default = 0;  // touching points at 3 mm, the same on every processor
  std::vector<double> spacing_m, points, active, clusters;

  double points_at(double wanted_m) const {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (std::abs(spacing_m[i] - wanted_m) < 1e-9) return points[i];
    return std::nan("");
  }
  double spacings_with(double count) const {
    return static_cast<double>(std::count(points.begin(), points.end(), count));
  }
};

std::vector<Counts> counts(const SweepResult& result) {
  const auto& spacings = std::get<std::vector<double>>(result.axes.at(0).values);
  std::vector<Counts> list = {{"spacings_look_ahead", "look-ahead", 12, spacings, {}, {}, {}},
                              {"spacings_voxels", "voxels", 8, spacings, {}, {}, {}}};
  for (std::size_t rule = 0; rule < list.size(); ++rule)
    for (std::size_t i = 0; i < spacings.size(); ++i) {
      const std::size_t run = result.run(result.cell_at({i, rule}), 0);
      list[rule].points.push_back(result.measure("max_contact_count")[run]);
      list[rule].active.push_back(result.measure("max_active_constraints")[run]);
      list[rule].clusters.push_back(result.measure("max_contact_clusters")[run]);
    }
  return list;
}

Table count_table(const Counts& counts) {
  TableRows rows;
  for (std::size_t i = 0; i < counts.points.size(); ++i)
    rows.push_back(
        {counts.spacing_m[i], counts.points[i], counts.active[i], counts.clusters[i], kPrintedContacts});
  return table_of(counts.name, "contact rule " + counts.rule + ": counts over the spacing of the points",
                  {{"spacing", "m", "spacing of the points"},
                   {"points", "1", "most points that touch at once"},
                   {"active", "1", "most active constraints at once"},
                   {"clusters", "1", "most 10 mm cells that touch at once"},
                   {"printed", "1", "as many as 6 contact points (6.3.1)"}},
                  rows);
}

void add_claims(Figure& figure, const Counts& counts) {
  const Claims claims(figure, "contact rule " + counts.rule + ": ");
  const std::string paper = "6, at a spacing that is not printed";
  claims.differs("with points 3 mm apart more than 6 touch at once: largest number", counts.points_at(0.003),
                 counts.known_at_default, counts.known_at_default, "points", paper);
  claims.at_least(
      "at some spacings from 1 to 6 mm, in steps of 0.5 mm, the most points that touch at once are 6: "
      "number of these spacings",
      counts.spacings_with(kPrintedContacts), 1, "spacings", paper);
}

}  // namespace

void add_contacts_over_spacing(Figure& figure, const SweepResult& sweep, int row) {
  const auto panel = [&](const char* title, int column, std::pair<double, double> y_range) {
    return plot(title, "spacing of the points (m)", "largest count in a run", {},
                {.at = {{row, column}}, .y_range = y_range});
  };
  Panel points = panel("Points that touch", 0, {0, 35}),
        others = panel("Counts that depend little on the spacing", 1, {0, 8});
  for (const Counts& rule : counts(sweep)) {
    figure.tables.push_back(count_table(rule));
    add_claims(figure, rule);
    points.curves.push_back({rule.name, "spacing", "points", CurveStyle::line, rule.rule});
    others.curves.push_back(
        {rule.name, "spacing", "clusters", CurveStyle::line, rule.rule + ", 10 mm cells"});
    others.curves.push_back(
        {rule.name, "spacing", "active", CurveStyle::dashed, rule.rule + ", active constraints"});
  }
  points.curves.push_back(
      {"spacings_voxels", "spacing", "printed", CurveStyle::dashed, "printed: 6 contact points (6.3.1)"});
  figure.panels.push_back(points);
  figure.panels.push_back(others);
}

}  // namespace remote_touch
