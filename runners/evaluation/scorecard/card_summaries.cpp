#include "runners/evaluation/scorecard/evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

// Fraction of a mean by which it may differ: for rounding, and for changes too small to matter.
constexpr double kSlack = 1e-3;

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

CardCell cell_in(const TableRow& row) {
  return {row.text("scene"), row.text("method"), row.number("noise_sigma")};
}

// Key for sorting. A NaN noise is the scene's own, and comes before all others.
std::tuple<std::string, std::string, double> key_of(const CardCell& cell) {
  return {cell.scene, cell.method, std::isnan(cell.noise_m) ? -1 : cell.noise_m};
}

std::string words(const CardCell& cell) {
  if (std::isnan(cell.noise_m)) return cell.scene + ", " + cell.method + ", own noise";
  return cell.scene + ", " + cell.method + formatted(", noise %g mm", 1e3 * cell.noise_m);
}

std::string sentence(const CardCell& cell, const char* format, auto... numbers) {
  return words(cell) + ": " + formatted(format, numbers...);
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

constexpr double kUntested = std::numeric_limits<double>::quiet_NaN();

// A scene without runs counts with no method.
EventCounts counts_of(const Proportion& share) {
  return {share.events, share.runs - share.events, 0};
}

// Adds a weakness if other methods are better by more than chance. It names the first of them in the order of
// the ranking.
void add_significant(const SceneScore& scene, const std::string& what, const std::string& units,
                     const Ranking& ranking, const Scorecard& card, std::size_t own,
                     std::vector<Weakness>& list) {
  if (ranking.against.empty()) return;
  Weakness found{scene.name, what, units, {}, 0, ranking.mean[own].value, 0, 0, true};
  for (const std::size_t c : ranking.order) {
    if (!ranking.against[c][own].shows_better()) continue;
    if (found.ahead++ > 0) continue;
    found.other = card.methods[c], found.other_mean = ranking.mean[c].value;
    found.p = ranking.against[c][own].p;
  }
  if (found.ahead > 0) list.push_back(found);
}

// Counts the methods c whose fraction(c) is larger than that of `own`, and names the one with the largest.
template <class Fraction>
Weakness more_often(const SceneScore& scene, const char* what, const Scorecard& card, std::size_t own,
                    Fraction&& fraction) {
  Weakness found{scene.name, what, "1", {}, 0, fraction(own), fraction(own), kUntested, false};
  for (std::size_t c = 0; c < card.methods.size(); ++c) {
    if (!(fraction(c) > fraction(own))) continue;
    ++found.ahead;
    if (fraction(c) > found.other_mean) found.other = card.methods[c], found.other_mean = fraction(c);
  }
  return found;
}

void add_not_significant(const SceneScore& scene, const Scorecard& card, std::size_t own,
                         std::vector<Weakness>& list) {
  Weakness noisy =
      more_often(scene, "success", card, own, [&](std::size_t c) { return scene.success[c].noisy.fraction; });
  const auto& against = scene.ranking.against;
  const auto is_significant = [&](std::size_t c) {
    return !against.empty() && against[c][own].shows_better();
  };
  for (std::size_t c = 0; c < card.methods.size(); ++c) {
    if (is_significant(c)) noisy.ahead = 0;  // it is in the list already
    if (card.methods[c] == noisy.other && !against.empty()) noisy.p = against[c][own].p;
  }
  if (noisy.ahead > 0) list.push_back(noisy);
  if (!scene.success[own].noise_free) return;
  const Weakness quiet = more_often(scene, "success without noise", card, own,
                                    [&](std::size_t c) { return scene.success[c].noise_free->fraction; });
  if (quiet.ahead > 0) list.push_back(quiet);
}

void add_scene(const SceneThreshold& scene, ThresholdSummary& summary) {
  for (std::size_t c = 0; c < summary.methods.size(); ++c) {
    ThresholdCounts& counts = summary.methods[c];
    const Successes& below = scene.below[c];
    counts.scenes += below.noisy.runs > 0 ? 1 : 0;
    counts.below += below.noisy.events, counts.runs += below.noisy.runs;
    if (!below.noise_free) continue;
    counts.noise_free_below += below.noise_free->events, counts.noise_free_runs += below.noise_free->runs;
  }
}

}  // namespace

std::vector<TableRow> rows_by(const Table& table, const char* text_column) {
  std::vector<TableRow> rows;
  const std::size_t count = values_of<std::vector<std::string>>(table, text_column).size();
  for (std::size_t i = 0; i < count; ++i) rows.push_back({&table, i});
  return rows;
}

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
  const auto add = [&](const char* name, const char* meaning, auto part) {
    add_column(table, rows, name, meaning, [part](const Row& row) { return row.value.*part; });
  };
  add("mean", "mean, in the measure's unit", &Estimate::value);
  add("low", "lower end of the interval", &Estimate::low);
  add("high", "upper end of the interval", &Estimate::high);
  return table;
}

CardNumbers numbers_in(const Table& counts, const Table& means) {
  CardNumbers numbers;
  for (const TableRow& row : rows_by(counts, "scene"))
    numbers.counts.push_back({cell_in(row),
                              {row.count("successes"), row.count("runs"), row.number("fraction"),
                               row.number("low"), row.number("high")}});
  for (const TableRow& row : rows_by(means, "scene"))
    numbers.means.push_back({cell_in(row),
                             row.text("measure"),
                             row.text("units"),
                             {.value = row.number("mean"),
                              .low = row.number("low"),
                              .high = row.number("high"),
                              .clusters = row.count("runs")}});
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

Mark mark_of(const Ranking& ranking, std::size_t method) {
  if (ranking.order.empty()) return Mark::none;
  if (ranking.has_best && ranking.order.front() == method) return Mark::best;
  if (ranking.has_worst && ranking.order[ranking.ranked - 1] == method) return Mark::worst;
  return Mark::none;
}

std::vector<MethodSummary> overview(const Scorecard& card) {
  std::vector<MethodSummary> methods(card.methods.size());
  for (std::size_t c = 0; c < methods.size(); ++c) {
    MethodSummary& method = methods[c];
    std::vector<EventCounts> noisy, noise_free, old;
    for (const SceneScore& scene : card.scenes) {
      const Mark mark = mark_of(scene.ranking, c);
      method.held += scene.success[c].noisy.fraction > kHeldFraction;
      method.best += mark == Mark::best, method.worst += mark == Mark::worst;
      noisy.push_back(counts_of(scene.success[c].noisy));
      if (const auto& quiet = scene.success[c].noise_free) noise_free.push_back(counts_of(*quiet));
      if (!scene.old_success.empty()) old.push_back(counts_of(scene.old_success[c].noisy));
    }
    method.success = estimated_fraction(noisy);
    method.noise_free = estimated_fraction(noise_free);
    method.old_success = estimated_fraction(old);
  }
  return methods;
}

std::vector<Weakness> weaknesses(const Scorecard& card, const std::string& method) {
  const auto found = std::find(card.methods.begin(), card.methods.end(), method);
  if (found == card.methods.end()) return {};
  const auto own = static_cast<std::size_t>(found - card.methods.begin());
  std::vector<Weakness> list;
  for (const SceneScore& scene : card.scenes) {
    add_significant(scene, "success", "1", scene.ranking, card, own, list);
    for (const JudgedMeasure& measure : scene.measures)
      add_significant(scene, measure.name, measure.units, measure.ranking, card, own, list);
  }
  for (const SceneScore& scene : card.scenes) add_not_significant(scene, card, own, list);
  return list;
}

Table overview_table(const Scorecard& card) {
  using Row = MethodSummary;
  const std::vector<Row> rows = overview(card);
  Table table{"overview", "each method over all scenes"};
  const auto add = [&](const char* name, const char* meaning, auto value) {
    add_column(table, rows, name, meaning, value);
  };
  table.add("method", "1", "method", card.methods);
  add("scenes", "scenes", [](const Row& one) { return static_cast<std::int32_t>(one.success.clusters); });
  add("success", "mean over the scenes of the fraction of successes with noise",
      [](const Row& one) { return one.success.value; });
  add("low", "lower end of its interval, with scenes as clusters (Korn and Graubard)",
      [](const Row& one) { return one.success.low; });
  add("high", "upper end of its interval", [](const Row& one) { return one.success.high; });
  add("noise_free", "mean over the scenes of the fraction of successes without noise",
      [](const Row& one) { return one.noise_free.value; });
  add("old_success", "like success, by the previous rule, over the scenes that have one",
      [](const Row& one) { return one.old_success.value; });
  add("held", "scenes held in more than 90 % of the runs", &Row::held);
  add("best", "scenes in which it is significantly better than all other methods", &Row::best);
  add("worst", "scenes in which it is significantly worse than all other methods", &Row::worst);
  return table;
}

std::string own_method(const std::vector<std::string>& methods) {
  const char* const of_teleoperation = "slave-region";
  const bool has_it = std::find(methods.begin(), methods.end(), of_teleoperation) != methods.end();
  return has_it ? of_teleoperation : "tracked-sheet";
}

Table behind_table(const Scorecard& card) {
  using Row = Weakness;
  const std::string own = own_method(card.methods);
  const std::vector<Row> rows = weaknesses(card, own);
  Table table{"behind", "where " + own + " is behind another method"};
  const auto add = [&](const char* name, const char* meaning, auto value) {
    add_column(table, rows, name, meaning, value);
  };
  add("scene", "scene", &Row::scene);
  add("what", "success or measure", &Row::what);
  add("units", "unit of the measure", &Row::units);
  add("other", "the best of the methods that are ahead", &Row::other);
  add("ahead", "number of methods that are ahead", &Row::ahead);
  add("significant", "1 if the difference is significant, else 0",
      [](const Row& one) { return static_cast<std::int32_t>(one.is_significant); });
  add("own_mean", "mean of the own method, in the measure's unit", &Row::own_mean);
  add("other_mean", "mean of the other", &Row::other_mean);
  add("p", "p value, corrected for all comparisons of the card; NaN: not tested", &Row::p);
  return table;
}

std::vector<ThresholdSummary> threshold_summary(const Scorecard& card) {
  std::vector<ThresholdSummary> list;
  for (const PerceptionThreshold& threshold : perception_thresholds()) {
    ThresholdSummary summary{threshold, std::vector<ThresholdCounts>(card.methods.size())};
    bool is_reported = false;
    for (const SceneScore& scene : card.scenes) {
      const auto found = std::ranges::find(scene.thresholds, threshold.measure, &SceneThreshold::measure);
      if (found == scene.thresholds.end()) continue;
      is_reported = true;
      add_scene(*found, summary);
    }
    if (is_reported) list.push_back(std::move(summary));
  }
  return list;
}

Table thresholds_table(const Scorecard& card) {
  struct Row {
    PerceptionThreshold threshold;
    std::string method;
    ThresholdCounts counts;
  };
  std::vector<Row> rows;
  for (const ThresholdSummary& summary : threshold_summary(card))
    for (std::size_t c = 0; c < card.methods.size(); ++c)
      rows.push_back({summary.threshold, card.methods[c], summary.methods[c]});
  Table table{"thresholds", "runs in which a measure is below a published threshold of perception"};
  const auto text = [&](const char* name, const char* meaning, const char* PerceptionThreshold::*member) {
    add_column(table, rows, name, meaning,
               [member](const Row& row) { return std::string(row.threshold.*member); });
  };
  const auto count = [&](const char* name, const char* meaning, int ThresholdCounts::*member) {
    add_column(table, rows, name, meaning,
               [member](const Row& row) { return static_cast<std::int32_t>(row.counts.*member); });
  };
  text("measure", "measure", &PerceptionThreshold::measure);
  add_column(table, rows, "method", "method", &Row::method);
  text("units", "unit of the measure and of its threshold", &PerceptionThreshold::unit);
  add_column(table, rows, "threshold", "the threshold, in the measure's unit",
             [](const Row& row) { return row.threshold.value; });
  text("meaning", "what the source of the threshold measured", &PerceptionThreshold::meaning);
  text("source", "the source of the threshold", &PerceptionThreshold::source);
  count("scenes", "scenes with at least one successful run with noise that has the measure",
        &ThresholdCounts::scenes);
  count("below", "successful runs with noise whose measure is below the threshold", &ThresholdCounts::below);
  count("runs", "successful runs with noise that have the measure", &ThresholdCounts::runs);
  count("noise_free_below", "like below, without noise", &ThresholdCounts::noise_free_below);
  count("noise_free_runs", "like runs, without noise", &ThresholdCounts::noise_free_runs);
  return table;
}

}  // namespace remote_touch
