// Fig 4.13: 5396 lifts, noise against acceleration.
#include <algorithm>
#include <cmath>

#include "runners/figures/figures.h"
#include "runners/figures/pop_through_map.h"

namespace remote_touch {

namespace {

// Success of an independent implementation by region, rows of acceleration, columns of noise (in r_c).
constexpr double kNoiseEdges[] = {0, 0.5, 1, 1.5, 2, 3.001};
constexpr double kAccelerationEdges[] = {0, 300, 600, 898, 1150, 1e9};
constexpr double kReference[5][5] = {{1.00, 1.00, 1.00, 0.95, 0.73},
                                     {1.00, 0.97, 0.89, 0.68, 0.26},
                                     {0.82, 0.82, 0.42, 0.20, 0.03},
                                     {0.08, 0.25, 0.05, 0.01, 0.00},
                                     {0.00, 0.01, 0.00, 0.00, 0.00}};

double success_within(const Table& map, int row, int column) {
  const auto &noise = numbers(map, "noise"), &acceleration = numbers(map, "acceleration"),
             &survived = numbers(map, "survived");
  // A node on an edge belongs to the region above it, whatever its last bit.
  constexpr double kEdge = 1e-9;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const double x = noise[i] + kEdge, y = acceleration[i] + kEdge;
    if (x < kNoiseEdges[column] || x >= kNoiseEdges[column + 1]) continue;
    if (y < kAccelerationEdges[row] || y >= kAccelerationEdges[row + 1]) continue;
    sum += survived[i], ++count;
  }
  return sum / count;
}

Table region_table(const Table& map) {
  std::vector<double> noise, acceleration, success, reference;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) {
      noise.push_back(kNoiseEdges[column]), acceleration.push_back(kAccelerationEdges[row]);
      success.push_back(success_within(map, row, column));
      reference.push_back(kReference[row][column]);
    }
  Table table{"regions", "success by region"};
  table.add("noise_from", "r_c", "lower edge of the region", noise);
  table.add("acceleration_from", "r_c/s^2", "lower edge of the region", acceleration);
  table.add("survived", "1", "share of lifts that did not pop through", success);
  table.add("reference", "1", "the same of an independent implementation", reference);
  return table;
}

double largest_deviation(const Table& regions) {
  const auto &survived = numbers(regions, "survived"), &reference = numbers(regions, "reference");
  double largest = 0;
  for (std::size_t i = 0; i < survived.size(); ++i)
    largest = std::max(largest, std::abs(survived[i] - reference[i]));
  return largest;
}

Table bound_table() {
  Table table = noise_table("bound", "bound on pop-through");
  add_bound(table, "printed", "(4.25) with (4.23) and (4.24) as printed", printed_bound);
  return table;
}

}  // namespace

Figure figure_4_13(const Laboratory& laboratory) {
  const Table map = map_table("map", laboratory.sweep(Sweep::load("fig4.13")));
  const Table without = map_table(
      "map_without_estimate", laboratory.sweep(Sweep::load("fig4.13", {"renderer.velocity_estimate=false"})));
  const Table regions = region_table(map);
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
      claim_between("4.13", "success over the whole map, 5396 lifts, 1000 steps per frame", "-",
                    mean(numbers(map, "survived")), 0.395, 0.455, "share"),
      claim_at_most("4.13", "largest difference from the reference in the 25 regions of the map", "-",
                    largest_deviation(regions), 0.1, "share"),
      claim_between("4.13", "success over the whole map without the velocity estimate", "-",
                    mean(numbers(without, "survived")), 0.03, 0.09, "share"),
  };
  return figure;
}

}  // namespace remote_touch
