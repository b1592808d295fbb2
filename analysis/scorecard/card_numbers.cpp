#include "analysis/scorecard/card_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>

namespace remote_touch {

namespace {

// Fraction of a mean by which it may differ: for rounding, and for changes too small to matter.
constexpr double kSlack = 1e-3;

using Texts = std::vector<std::string>;
using Counts = std::vector<std::int32_t>;
using Numbers = std::vector<double>;

// The table with its columns scene, method and noise_sigma.
template <class Row>
Table table_of_cells(const char* name, const char* title, const std::vector<Row>& rows) {
  Table table{name, title};
  add_column(table, rows, "scene", "scene", [](const Row& row) { return row.cell.scene; });
  add_column(table, rows, "method", "method", [](const Row& row) { return row.cell.method; });
  add_column(table, rows, "noise_sigma", "standard deviation of the noise; NaN: the scene's own",
             [](const Row& row) { return row.cell.noise_m; });
  table.columns.back().units = "m";
  return table;
}

CardCell cell_in(const Table& table, std::size_t row) {
  return {values_of<Texts>(table, "scene")[row], values_of<Texts>(table, "method")[row],
          values_of<Numbers>(table, "noise_sigma")[row]};
}

// Key for sorting. A NaN noise is the scene's own, and comes before all others.
std::tuple<std::string, std::string, double> key_of(const CardCell& cell) {
  return {cell.scene, cell.method, std::isnan(cell.noise_m) ? -1 : cell.noise_m};
}

std::string words(const CardCell& cell) {
  if (std::isnan(cell.noise_m)) return cell.scene + ", " + cell.method + ", own noise";
  char noise[40];
  std::snprintf(noise, sizeof noise, ", noise %g mm", 1e3 * cell.noise_m);
  return cell.scene + ", " + cell.method + noise;
}

std::string sentence(const CardCell& cell, const char* format, auto... numbers) {
  char text[200];
  std::snprintf(text, sizeof text, format, numbers...);
  return words(cell) + ": " + text;
}

void compare(const CardNumbers::Count& then, const CardNumbers::Count& now, std::vector<std::string>& list) {
  const Proportion &a = then.successes, &b = now.successes;
  if (b.runs == a.runs && b.events == a.events) return;
  list.push_back(
      sentence(now.cell, "%d of %d runs succeed, stored %d of %d", b.events, b.runs, a.events, a.runs));
}

void compare(const CardNumbers::Mean& then, const CardNumbers::Mean& now, std::vector<std::string>& list) {
  const double a = then.value.value, b = now.value.value;
  if (std::isnan(a)) return;  // no stored mean to compare with; the counts show it
  if (then.units != now.units) {
    list.push_back(words(now.cell) + ": " + now.measure + " is in " + now.units + ", stored in " +
                   then.units);
    return;
  }
  if (std::abs(b - a) <= kSlack * std::abs(a)) return;  // not for NaN
  const std::string what = now.measure + (now.units == "1" ? "" : " in " + now.units);
  list.push_back(std::isnan(b) ? sentence(now.cell, "%s is NaN, stored %.6g", what.c_str(), a)
                               : sentence(now.cell, "%s is %.6g, stored %.6g", what.c_str(), b, a));
}

}  // namespace

CardNumbers numbers_of(const Scorecard& card, KeptMeasures kept) {
  CardNumbers numbers;
  for (const SceneScore& scene : card.scenes)
    for (std::size_t c = 0; c < card.methods.size(); ++c)
      for (std::size_t i = 0; i < scene.noise_m.size(); ++i) {
        const CardCell cell{scene.name, card.methods[c], scene.noise_m[i]};
        numbers.counts.push_back({cell, scene.success[c].at_level[i]});
        for (const JudgedMeasure& measure : scene.measures)
          if (kept == KeptMeasures::all || measure.better != Better::neither)
            numbers.means.push_back({cell, measure.name, measure.units, measure.at_level[c][i]});
      }
  return numbers;
}

Table counts_table(const CardNumbers& numbers) {
  Table table = table_of_cells("success",
                               "fractions of successful runs with their 95 % intervals (Clopper and Pearson)",
                               numbers.counts);
  const auto add = [&](const char* name, const char* meaning, auto part) {
    add_column(table, numbers.counts, name, meaning, [part](const auto& row) { return row.successes.*part; });
  };
  add("successes", "successful runs", &Proportion::events);
  add("runs", "number of runs; runs that are all one and the same, as without noise, count once",
      &Proportion::runs);
  add("fraction", "fraction of successful runs", &Proportion::fraction);
  add("low", "lower end of the interval", &Proportion::low);
  add("high", "upper end of the interval", &Proportion::high);
  return table;
}

Table means_table(const CardNumbers& numbers) {
  using Row = CardNumbers::Mean;
  const std::vector<Row>& rows = numbers.means;
  Table table = table_of_cells(
      "measures",
      "means with their 95 % intervals (Student, Hall); judged measures over the successful runs, reported "
      "measures over all runs",
      rows);
  add_column(table, rows, "measure", "measure", &Row::measure);
  add_column(table, rows, "units", "unit of the measure", &Row::units);
  add_column(table, rows, "runs", "runs that have a number",
             [](const Row& row) { return static_cast<std::int32_t>(row.value.clusters); });
  add_column(table, rows, "mean", "mean, in the measure's unit",
             [](const Row& row) { return row.value.value; });
  add_column(table, rows, "low", "lower end of the interval", [](const Row& row) { return row.value.low; });
  add_column(table, rows, "high", "upper end of the interval", [](const Row& row) { return row.value.high; });
  return table;
}

CardNumbers numbers_in(const Table& counts, const Table& means) {
  CardNumbers numbers;
  const auto number = [](const Table& table, const char* name, std::size_t row) {
    return values_of<Numbers>(table, name)[row];
  };
  for (std::size_t i = 0; i < values_of<Texts>(counts, "scene").size(); ++i)
    numbers.counts.push_back(
        {cell_in(counts, i),
         {values_of<Counts>(counts, "successes")[i], values_of<Counts>(counts, "runs")[i],
          number(counts, "fraction", i), number(counts, "low", i), number(counts, "high", i)}});
  for (std::size_t i = 0; i < values_of<Texts>(means, "scene").size(); ++i)
    numbers.means.push_back({cell_in(means, i),
                             values_of<Texts>(means, "measure")[i],
                             values_of<Texts>(means, "units")[i],
                             {.value = number(means, "mean", i),
                              .low = number(means, "low", i),
                              .high = number(means, "high", i),
                              .clusters = values_of<Counts>(means, "runs")[i]}});
  return numbers;
}

std::vector<std::string> differences(const CardNumbers& stored, const CardNumbers& now) {
  std::map<decltype(key_of({})), const CardNumbers::Count*> counts;
  std::map<std::pair<decltype(key_of({})), std::string>, const CardNumbers::Mean*> means;
  for (const auto& row : stored.counts) counts[key_of(row.cell)] = &row;
  for (const auto& row : stored.means) means[{key_of(row.cell), row.measure}] = &row;
  std::vector<std::string> list;
  for (const auto& row : now.counts) {
    const auto found = counts.find(key_of(row.cell));
    if (found == counts.end())
      list.push_back(words(row.cell) + ": its successes are not in the stored card");
    else
      compare(*found->second, row, list);
  }
  for (const auto& row : now.means) {
    const auto found = means.find({key_of(row.cell), row.measure});
    if (found == means.end())
      list.push_back(words(row.cell) + ": " + row.measure + " is not in the stored card");
    else
      compare(*found->second, row, list);
  }
  return list;
}

}  // namespace remote_touch
