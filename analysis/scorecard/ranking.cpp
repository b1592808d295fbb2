#include "analysis/scorecard/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/statistics/student.h"

namespace remote_touch {

namespace {

// Returns the differences in badness of two methods, above 0 where a is worse, for the pairs in which both
// have a number. repeats: levels at which both methods repeat one run.
std::vector<double> differences(const PairedValues& a, const PairedValues& b, Better better,
                                const Repeats& repeats) {
  PairedValues by_level(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < a[i].size(); ++k)
      by_level[i].push_back(badness(a[i][k], better) - badness(b[i][k], better));
  std::vector<double> known;
  for (const auto& level : distinct(by_level, repeats))
    std::copy_if(level.begin(), level.end(), std::back_inserter(known),
                 [](double d) { return !std::isnan(d); });
  return known;
}

MethodComparison comparison(const std::vector<double>& worse_by, bool event) {
  MethodComparison result;
  if (static_cast<std::int64_t>(worse_by.size()) < kMinPairs) return result;
  double sum = 0;
  std::int64_t plus = 0, minus = 0;
  for (const double d : worse_by) sum += d, plus += d > 0, minus += d < 0;
  result.p = event ? sign_test(plus, minus) : mean_test(worse_by);
  result.has_better_mean = sum < 0;
  return result;
}

double mean_badness(const PairedValues& values, Better better) {
  double sum = 0, count = 0;
  for (const auto& group : values)
    for (const double value : group)
      if (!std::isnan(value)) sum += badness(value, better), ++count;
  return sum / count;
}

Repeats of_both(const Repeats& a, const Repeats& b) {
  Repeats both(std::min(a.size(), b.size()));
  for (std::size_t i = 0; i < both.size(); ++i) both[i] = a[i] && b[i];
  return both;
}

void decide(Ranking& r) {
  if (r.against.empty() || r.ranked == 0) return;
  const auto is_above = [&](std::size_t i, std::size_t k) {
    return r.against[r.order[i]][r.order[k]].shows_better();
  };
  r.top_group = {r.order[0]};
  for (std::size_t i = 1; i < r.ranked; ++i)
    if (!is_above(0, i)) r.top_group.push_back(r.order[i]);
  r.has_best = r.ranked > 1 && r.top_group.size() == 1;
  r.has_worst = r.ranked > 1;
  for (std::size_t i = 0; i + 1 < r.ranked; ++i) r.has_worst = r.has_worst && is_above(i, r.ranked - 1);
}

}  // namespace

PairedValues distinct(const PairedValues& values, const Repeats& repeats) {
  PairedValues once = values;
  for (std::size_t i = 0; i < std::min(once.size(), repeats.size()); ++i)
    if (repeats[i] && once[i].size() > 1) once[i].erase(once[i].begin() + 1, once[i].end());
  return once;
}

Ranking ranking(const std::vector<PairedValues>& methods, Better better, bool event,
                const std::vector<Repeats>& repeats) {
  Ranking result;
  std::vector<double> bad;
  const auto repeats_of = [&](std::size_t c) { return c < repeats.size() ? repeats[c] : Repeats{}; };
  for (std::size_t c = 0; c < methods.size(); ++c) {
    const PairedValues values = distinct(methods[c], repeats_of(c));
    result.mean.push_back(student_mean(values, repeats_of(c)));
    bad.push_back(result.mean.back().pairs >= (event ? 1 : kMinPairs)
                      ? mean_badness(values, better)
                      : std::numeric_limits<double>::infinity());
  }
  result.order.resize(methods.size());
  std::iota(result.order.begin(), result.order.end(), std::size_t{0});
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](std::size_t a, std::size_t b) { return bad[a] < bad[b]; });
  for (const double each : bad) result.ranked += each < std::numeric_limits<double>::infinity() ? 1 : 0;
  if (better == Better::neither) return result;
  result.against.assign(methods.size(), std::vector<MethodComparison>(methods.size()));
  for (std::size_t i = 0; i < result.ranked; ++i)
    for (std::size_t k = 0; k < result.ranked; ++k) {
      const std::size_t a = result.order[i], b = result.order[k];
      if (a == b) continue;
      result.against[a][b] = comparison(
          differences(methods[a], methods[b], better, of_both(repeats_of(a), repeats_of(b))), event);
    }
  decide(result);
  return result;
}

// Each pair of methods is one test, although against[a][b] and against[b][a] both hold its p value.
void correct_together(const std::vector<Ranking*>& rankings) {
  std::vector<MethodComparison*> there, back;
  std::vector<double> p;
  for (Ranking* r : rankings)
    for (std::size_t a = 0; a < r->against.size(); ++a)
      for (std::size_t b = a + 1; b < r->against.size(); ++b) {
        if (std::isnan(r->against[a][b].p)) continue;
        there.push_back(&r->against[a][b]), back.push_back(&r->against[b][a]);
        p.push_back(r->against[a][b].p);
      }
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < p.size(); ++i) there[i]->p = back[i]->p = adjusted[i];
  for (Ranking* r : rankings) decide(*r);
}

}  // namespace remote_touch
