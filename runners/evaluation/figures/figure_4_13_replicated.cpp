// Fig 4.13 with replicates: probabilities and where they cross one half, with confidence.
#include <algorithm>
#include <cmath>

#include "analysis/measures/no_value.h"
#include "analysis/statistics/isotonic_regression.h"
#include "analysis/statistics/mean.h"
#include "runners/evaluation/figures/figures.h"
#include "runners/evaluation/figures/pop_through_map.h"
#include "runners/experiment/settings/second_implementation.h"

namespace remote_touch {

namespace {

// Returns, for each noise strength, the acceleration at which half of the lifts survive: there the falling
// curve that is nearest to the measured shares crosses one half. Columns `low` and `high` are the
// accelerations at which the lower and the upper ends of the Wilson intervals cross one half.
Table contour(const std::string& name, const Table& map, std::size_t columns) {
  const auto &noise = numbers(map, "noise"), &acceleration = numbers(map, "acceleration");
  const std::size_t rows = noise.size() / columns;  // the map runs through the accelerations first
  const auto crossings = [&](const std::string& column) {
    const auto &values = numbers(map, column), &runs = numbers(map, "runs");
    std::vector<double> list;
    for (std::size_t row = 0; row < rows; ++row) {
      const auto from = static_cast<std::ptrdiff_t>(row * columns),
                 to = from + static_cast<std::ptrdiff_t>(columns);
      const std::vector<double> x(acceleration.begin() + from, acceleration.begin() + to);
      const std::vector<double> fraction(values.begin() + from, values.begin() + to);
      const std::vector<double> weight(runs.begin() + from, runs.begin() + to);
      list.push_back(crossing(x, isotonic_falling(fraction, weight), 0.5));
    }
    return list;
  };
  std::vector<double> strengths;
  for (std::size_t row = 0; row < rows; ++row) strengths.push_back(noise[row * columns]);
  Table table{name, "acceleration at which half of the lifts survive"};
  table.add("noise", "r_c", "standard deviation of the noise", strengths);
  table.add("acceleration", "r_c/s^2", "half of the lifts survive", crossings("survived"));
  table.add("low", "r_c/s^2", "lower end of the intervals crosses one half", crossings("survived_low"));
  table.add("high", "r_c/s^2", "upper end of the intervals crosses one half", crossings("survived_high"));
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
  std::vector<double> acceleration, apart;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const auto same = [&](double strength) { return std::abs(strength - noise[i]) < 1e-9; };
    const auto at = static_cast<std::size_t>(std::find_if(ours.begin(), ours.end(), same) - ours.begin());
    acceleration.push_back(at < ours.size() ? numbers(contour, "acceleration")[at] : kNoValue);
    apart.push_back((acceleration.back() - second[i]) / std::hypot(error[i], our_error[i]));
  }
  Table table{"contour_second", "the contour by the second implementation, six noise strengths"};
  table.add("noise", "r_c", "standard deviation of the noise", noise);
  table.add("second", "r_c/s^2", "half of the lifts survive in the second implementation", second);
  table.add("acceleration", "r_c/s^2", "half of the lifts survive here", acceleration);
  table.add("apart", "1", "difference in units of its standard error", apart);
  return table;
}

Panel probability_panel(const std::string& title, const std::string& map, const std::string& contour) {
  return map_panel(title,
                   {{map, "noise", "acceleration", CurveStyle::map, "", 0, "survived"},
                    {contour, "noise", "acceleration", CurveStyle::line, "half survive"},
                    {contour, "noise", "low", CurveStyle::dashed, "ends of the 95 % intervals cross 1/2"},
                    {contour, "noise", "high", CurveStyle::dashed, "ends of the 95 % intervals cross 1/2"},
                    {contour, "noise", "printed_bound", CurveStyle::line, "bound (4.25) as printed"}});
}

}  // namespace

Figure figure_4_13_replicated(const FigureContext& context) {
  const Sweep sweep = context.map("fig4.13-replicated");
  const SweepResult result = context.sweep(sweep);
  const std::size_t columns = result.axes.at(1).length();
  const Table map = map_table("map", result);
  const Table without =
      map_table("map_without_estimate",
                context.sweep(context.map("fig4.13-replicated", {"renderer.velocity_estimate=false"})));
  const Table half = contour("contour", map, columns), second = second_table(half);
  Figure figure{
      "4.13-replicated",
      "Probability of pop-through",
      "Every third noise and second acceleration of Fig 4.13, 20 lifts each, 1000 proxy steps per frame: "
      "share of lifts that did not pop through, and where it crosses one half, with 95 % Wilson intervals.",
      {map, without, half, contour("contour_without_estimate", without, columns), second}};
  figure.panels = {probability_panel("With the velocity estimate", "map", "contour"),
                   probability_panel("Without", "map_without_estimate", "contour_without_estimate")};
  figure.panels[0].grid_position = {0, 0}, figure.panels[1].grid_position = {0, 1};
  constexpr double kLiftsANode = 20;
  figure.claims = {
      of_map(claim_agrees("4.13-replicated", "success over the map", "-", mean(numbers(map, "survived")),
                          second_fraction("/map/coarse"), kLiftsANode)),
      of_map(claim_between("4.13-replicated", "success over the map without the velocity estimate", "-",
                           mean(numbers(without, "survived")), 0.03, 0.09, "fraction")),
      of_map(claim_at_most("4.13-replicated",
                           "largest difference of the 50 % contour from the second implementation, six noise "
                           "strengths, in standard errors",
                           "-", max_apart(second), kByChanceOf6, "1")),
  };
  return figure;
}

}  // namespace remote_touch
