// Fig 4.13: 5396 lifts, noise against acceleration.
#include <algorithm>
#include <cmath>

#include "runners/figures/figures.h"
#include "runners/figures/pop_through_map.h"

namespace remote_touch {

namespace {

// Success of an independent implementation by region, rows of acceleration, columns of noise.
constexpr double kReference[5][5] = {{1.00, 1.00, 1.00, 0.95, 0.73},
                                     {1.00, 0.97, 0.89, 0.68, 0.26},
                                     {0.82, 0.82, 0.42, 0.20, 0.03},
                                     {0.08, 0.25, 0.05, 0.01, 0.00},
                                     {0.00, 0.01, 0.00, 0.00, 0.00}};

Table with_reference(Table regions) {
  std::vector<double> reference;
  for (const auto& row : kReference) reference.insert(reference.end(), std::begin(row), std::end(row));
  regions.add("reference", "1", "the same of an independent implementation", reference);
  return regions;
}

double max_deviation(const Table& regions) {
  const auto &survived = numbers(regions, "survived"), &reference = numbers(regions, "reference");
  double max = 0;
  for (std::size_t i = 0; i < survived.size(); ++i) max = std::max(max, std::abs(survived[i] - reference[i]));
  return max;
}

}  // namespace

Figure figure_4_13(const FigureContext& context) {
  const Table map = map_table("map", context.sweep(context.map("fig4.13")));
  const Table without = map_table(
      "map_without_estimate", context.sweep(context.map("fig4.13", {"renderer.velocity_estimate=false"})));
  const Table regions = with_reference(region_table("regions", map));
  Figure figure{
      "4.13",
      "Pop-through map",
      "5396 lifts of a 200 x 200 cloud, noise against acceleration, 1000 proxy steps per frame. A filled "
      "square is a lift that did not pop through. Right: the same noise without the velocity estimate.",
      {map, survivors("survived", map), without, survivors("survived_without_estimate", without), regions,
       bound_table()}};
  const Curve bound{"bound", "noise", "printed", CurveStyle::line, "bound (4.25) as printed"};
  figure.panels = {
      map_panel("With the velocity estimate",
                {{"survived", "noise", "acceleration", CurveStyle::squares, "did not pop through"}, bound}),
      map_panel("Without", {{"survived_without_estimate", "noise", "acceleration", CurveStyle::squares,
                             "did not pop through"},
                            bound})};
  figure.panels[0].place = {0, 0}, figure.panels[1].place = {0, 1};
  figure.claims = {
      of_map(claim_between("4.13", "success over the whole map, 5396 lifts, 1000 steps per frame", "-",
                           mean(numbers(map, "survived")), 0.395, 0.455, "fraction")),
      of_map(claim_at_most("4.13", "largest difference from the reference in the 25 regions of the map", "-",
                           max_deviation(regions), 0.1, "fraction")),
      of_map(claim_between("4.13", "success over the whole map without the velocity estimate", "-",
                           mean(numbers(without, "survived")), 0.03, 0.09, "fraction")),
  };
  return figure;
}

}  // namespace remote_touch
