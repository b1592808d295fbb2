#include "analysis/scorecard/overview.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/scorecard/card_numbers.h"

namespace remote_touch {

namespace {

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

}  // namespace

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

}  // namespace remote_touch
