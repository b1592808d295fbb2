// Fig 4.13: 5396 lifts, noise against acceleration.
#include <algorithm>
#include <cmath>

#include "analysis/statistics/mean.h"
#include "runners/evaluation/figures/figures.h"
#include "runners/evaluation/figures/pop_through_map.h"
#include "runners/experiment/settings/second_implementation.h"

namespace remote_touch {

namespace {

// Adds the survival of the same regions in the second implementation, and the difference from ours in
// standard errors.
Table with_second_implementation(Table regions) {
  const auto column = [](const char* name) { return second_column("chapter_4", "/map/regions", name); };
  const std::vector<double> second = column("survived"), variance = column("variance"),
                            nodes = column("nodes"), &survived = numbers(regions, "survived");
  std::vector<double> apart;
  for (std::size_t i = 0; i < second.size(); ++i)
    apart.push_back((survived.at(i) - second[i]) /
                    SharedLifts{second[i], variance[i], nodes[i], 1}.standard_error(1));
  regions.add("second", "1", "the same by the second implementation", second);
  regions.add("apart", "1", "difference in units of its standard error", apart);
  return regions;
}

}  // namespace

Figure figure_4_13(const FigureContext& context) {
  const Table map = map_table("map", context.sweep(context.map("fig4.13")));
  const Table without = map_table(
      "map_without_estimate", context.sweep(context.map("fig4.13", {"renderer.velocity_estimate=false"})));
  const Table regions = with_second_implementation(region_table("regions", map));
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
  figure.panels[0].grid_position = {0, 0}, figure.panels[1].grid_position = {0, 1};
  figure.claims = {
      of_map(claim_agrees("4.13", "success over the whole map, 5396 lifts, 1000 steps per frame", "-",
                          mean(numbers(map, "survived")), second_fraction("/map/whole"), 1)),
      of_map(claim_at_most("4.13",
                           "largest difference from the second implementation in 25 regions of the map, in "
                           "standard errors",
                           "-", max_apart(regions), kByChanceOf25, "1")),
      of_map(claim_between("4.13", "success over the whole map without the velocity estimate", "-",
                           mean(numbers(without, "survived")), 0.03, 0.09, "fraction")),
  };
  return figure;
}

}  // namespace remote_touch
