// The rules of estimates: worked examples, and properties that all of them share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "analysis/trace/curve_fits.h"
#include "analysis/trace/interval_estimates.h"

namespace remote_touch::estimates_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The value agrees with one that is printed with three significant digits.
void expect_near(double value, double printed) {
  const double tolerance = printed == 0 ? 1e-12 : 0.0051 * std::abs(printed);
  EXPECT_NEAR(value, printed, tolerance);
}
void expect_interval(const Estimate& e, double value, double low, double high) {
  expect_near(e.value, value), expect_near(e.low, low), expect_near(e.high, high);
}

TEST(EstimatedFraction, EqualsTheExamples) {
  expect_interval(estimated_fraction(EventCounts{0, 20}), 0, 0, 0.168);
  expect_interval(estimated_fraction(EventCounts{1, 19}), 0.05, 0.00127, 0.249);
  expect_interval(estimated_fraction(EventCounts{7, 3}), 0.7, 0.348, 0.933);
  const Estimate unknown = estimated_fraction(EventCounts{106, 5, 89});
  expect_interval(unknown, 0.955, 0.458, 0.992);
  EXPECT_EQ(unknown.unknown, 89);
  EXPECT_EQ(unknown.clusters, 200);
  EXPECT_EQ(unknown.method, "Clopper-Pearson");
}

TEST(EstimatedFraction, OfClustersEqualsTheExamples) {
  const Estimate e = estimated_fraction(std::vector<EventCounts>{{0, 4}, {0, 4}, {1, 3}, {2, 2}, {4, 0}});
  expect_interval(e, 0.35, 0.0187, 0.878);
  EXPECT_EQ(e.clusters, 5);
  EXPECT_EQ(e.method, "Korn-Graubard");
  // Equal clusters do not scatter, whatever the rounding of their mean.
  expect_interval(estimated_fraction(std::vector<EventCounts>(8, {0, 3})), 0, 0, 0.369);
  expect_interval(estimated_fraction(std::vector<EventCounts>(5, {1, 4})), 0.2, 0.00505, 0.716);
  expect_interval(estimated_fraction(std::vector<EventCounts>(6, {1, 4})), 0.2, 0.0087, 0.671);
}

TEST(EstimatedMean, EqualsTheExamples) {
  const Estimate e = estimated_mean({0.2, 0.3, 0.3, 0.5, 0.6, 0.9, 1.4, 5});
  expect_interval(e, 1.15, -0.191, 6.28);
  EXPECT_EQ(e.method, "Student's t, Hall");
  const Estimate few = estimated_mean({0.0451, 0.0386, 0.0451, 0.0361, 0.0427});
  expect_interval(few, 0.04152, 0.0365, 0.0465);
  EXPECT_EQ(few.note, "assumes a normal distribution");
  const Estimate strata = estimated_mean(std::vector<Stratum>{{{1, 2, 3, 9}}, {{10, 11, 12, 16, 30}}});
  expect_interval(strata, 10.4, 4.78, 20.5);
  EXPECT_EQ(strata.clusters, 9);
  for (const double scale : {1e-90, 1e80}) {
    const Estimate scaled = estimated_mean({scale, 2 * scale, 3 * scale, scale, 2 * scale, 5 * scale, scale});
    EXPECT_NEAR(scaled.low / scale, estimated_mean({1, 2, 3, 1, 2, 5, 1}).low, 1e-9);
    EXPECT_NEAR(scaled.high / scale, estimated_mean({1, 2, 3, 1, 2, 5, 1}).high, 1e-9);
  }
}

TEST(EstimatedMean, IsExactForFixedStrata) {
  const Estimate exact = estimated_mean(std::vector<Stratum>{{{4, 4, 4, 4}, true}, {{7, 7}, true}});
  EXPECT_EQ(exact.value, 5.5);
  EXPECT_EQ(exact.clusters, 2);
  EXPECT_EQ(exact.method, kExactMethod);
  EXPECT_TRUE(std::isnan(exact.low) && std::isnan(exact.high) && std::isnan(exact.p));
  const Estimate mixed = estimated_mean(std::vector<Stratum>{{{1, 1, 1}, true}, {{5, 6}}});
  EXPECT_EQ(mixed.value, 4);
  EXPECT_NEAR(mixed.high - mixed.value, 12.7062 * std::sqrt(2 * 0.5) / 3, 1e-4);
  const Estimate lone = estimated_mean(std::vector<Stratum>{{{1}}, {{5, kNan}}, {{kNan}}, {{-3}}});
  EXPECT_EQ(lone.low, estimated_mean({1, 5, -3}).low);
  EXPECT_EQ(lone.unknown, 2);
  const Estimate equal = estimated_mean({3, 3, 3});
  EXPECT_EQ(equal.note, "no scatter");
  EXPECT_TRUE(std::isnan(equal.low));
  EXPECT_EQ(estimated_mean(std::vector<double>{3}).note, "one run");
}

TEST(EstimatedMean, OfEqualNumbersHasNoScatter) {
  for (std::size_t n = 2; n <= 20; ++n)
    for (int i = 1; i <= 200; ++i) {
      const Estimate e = estimated_mean(std::vector<double>(n, 0.1234567 * i));
      EXPECT_TRUE(std::isnan(e.low) && e.note == "no scatter") << n << " times " << 0.1234567 * i;
    }
}

const std::vector<double> kSkewed = {-.4233, -.4994, -.4994, -.4994, -.4233, -.4994,
                                     -.4614, .504,   -.4625, -.4994, -.4245, -.4614};

TEST(EstimatedDifference, EqualsTheExamples) {
  const Estimate skewed = estimated_difference(kSkewed);
  expect_interval(skewed, -0.3875, -0.487, -0.220);
  expect_near(skewed.p, 0.00635);
  EXPECT_TRUE(skewed.is_skewed);
  EXPECT_EQ(skewed.note, kSkewedNote);
  const Estimate zeros = estimated_difference({0, 0, 1, 2, 2, 3, -1, 4});
  expect_interval(zeros, 1.375, 0, 3);
  expect_near(zeros.p, 0.0938);
  const Estimate seven = estimated_difference({1, 1, 2, 2, 3, 3, 4});
  expect_interval(seven, 16.0 / 7, 1, 3.5);
  expect_near(seven.p, 0.0156);
  const Estimate infinite = estimated_difference({1, 1, INFINITY, 2, 2, 3, 3, 4});
  EXPECT_EQ(infinite.value, 16.0 / 7);
  EXPECT_EQ(infinite.p, seven.p);
  EXPECT_EQ(infinite.unknown, 1);
  const Estimate five = estimated_difference({0.4, 1.1, -0.2, 0.9, 1.3});
  expect_interval(five, 0.7, -0.0502, 1.45);
  EXPECT_TRUE(std::isnan(five.p));
  const Estimate many = estimated_difference({3, -1, 2, 0, 4, 1, -2, 5, 2, 1, 0, 3, -1, 2, 6, 1, 0, 2});
  expect_interval(many, 28.0 / 18, 0.501, 2.61);
  expect_near(many.p, 0.00634);
}

TEST(EstimatedDifference, OfEqualPairsHasNoInterval) {
  for (const std::size_t n : {6, 16, 17, 60}) {
    const Estimate none = estimated_difference(std::vector<double>(n, 0));
    EXPECT_EQ(none.p, 1);
    EXPECT_FALSE(none.note.empty());
    const Estimate same = estimated_difference(std::vector<double>(n, 0.1));
    EXPECT_EQ(same.p, std::exp2(1 - static_cast<double>(n)));
    EXPECT_TRUE(std::isnan(none.low) && std::isnan(same.low) && std::isnan(same.high));
  }
}

// p is the fraction of the choices of signs whose sum is at least as large in magnitude.
TEST(EstimatedDifference, PIsThatOfAllSignFlips) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<double> d(6 + random() % 6);
    for (double& x : d) x = static_cast<double>(random() % 200) - 80;  // nearly always no ties of sums
    const auto sum_of = [&](unsigned signs) {
      double sum = 0;
      for (std::size_t i = 0; i < d.size(); ++i) sum += (signs >> i & 1u) != 0 ? -d[i] : d[i];
      return sum;
    };
    double as_large = 0;
    for (unsigned signs = 0; signs < 1u << d.size(); ++signs)
      as_large += std::abs(sum_of(signs)) >= std::abs(sum_of(0)) ? 1 : 0;
    if (sum_of(0) == 0) continue;
    EXPECT_EQ(estimated_difference(d).p, as_large / std::exp2(d.size()));
  }
}

// Interval and p never contradict each other.
TEST(EstimatedDifference, PAndIntervalAgree) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 1500; ++trial) {
    const int shape = trial % 5;
    std::vector<double> d(2 + random() % 24);
    for (double& x : d) {
      const double z = normal(random);
      x = shape == 0 ? z + 0.5 : shape == 1 ? std::exp(z) - 0.9 : std::round(2 * z + 0.7);
      if (shape == 3 && random() % 3 != 0) x = 0;
      if (shape == 4 && random() % 4 == 0) x = kNan;
    }
    const Estimate e = estimated_difference(d);
    const auto known =
        static_cast<std::int64_t>(std::count_if(d.begin(), d.end(), [](double x) { return !std::isnan(x); }));
    EXPECT_EQ(e.clusters, known);
    EXPECT_EQ(std::isnan(e.p), known < 6);
    if (!std::isnan(e.p) && !std::isnan(e.low)) {
      EXPECT_EQ(e.p <= 0.05, e.low > 0 || e.high < 0) << trial;
      EXPECT_LE(e.low, e.value + 1e-12);
      EXPECT_GE(e.high, e.value - 1e-12);
    }
  }
}

// One pair per cluster: `up` pairs with the event only in the second run, `down` only in the first.
std::vector<std::vector<OutcomePair>> pairs_of(int up, int down, int pairs) {
  std::vector<std::vector<OutcomePair>> all(static_cast<std::size_t>(pairs), {{1, 1}});
  for (int i = 0; i < up; ++i) all[static_cast<std::size_t>(i)] = {{0, 1}};
  for (int i = 0; i < down; ++i) all[static_cast<std::size_t>(up + i)] = {{1, 0}};
  return all;
}

TEST(EstimatedEventDifference, EqualsTheExamples) {
  const Estimate five = estimated_event_difference(pairs_of(5, 0, 12));
  expect_interval(five, 5.0 / 12, 0, 0.680);
  expect_near(five.p, 0.0625);
  const Estimate six = estimated_event_difference(pairs_of(6, 0, 12));
  expect_interval(six, 0.5, 0.136, 0.746);
  expect_near(six.p, 0.03125);
  const Estimate none = estimated_event_difference(pairs_of(0, 0, 12));
  expect_interval(none, 0, -0.242, 0.242);
  EXPECT_EQ(none.p, 1);
}

TEST(EstimatedEventDifference, PAndIntervalAgreeInAllTables) {
  for (const int pairs : {5, 6, 9, 12, 23, 40, 80})
    for (int up = 0; up <= pairs; ++up)
      for (int down = 0; up + down <= pairs; down += pairs < 30 ? 1 : 3) {
        const Estimate e = estimated_event_difference(pairs_of(up, down, pairs));
        const Estimate m = estimated_event_difference(pairs_of(down, up, pairs));
        EXPECT_EQ(std::isnan(e.p), pairs < 6);
        EXPECT_EQ(pairs < 6 ? e.low > 0 || e.high < 0 : e.p <= 0.05, e.low > 0 || e.high < 0)
            << up << " " << down << " " << pairs;
        EXPECT_NEAR(m.low, -e.high, 1e-9);
        EXPECT_TRUE(std::isnan(e.p) ? std::isnan(m.p) : m.p == e.p);
      }
}

// The interval holds those of all assignments of unknown outcomes, p is at least theirs, whether the clusters
// are runs or not.
TEST(EstimatedEventDifference, CoversEveryAssignmentOfUnknownOutcomes) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t size = 1 + random() % 2;
    std::vector<std::vector<OutcomePair>> clusters(8, std::vector<OutcomePair>(size));
    std::vector<double*> unknown;
    for (auto& cluster : clusters)
      for (OutcomePair& pair : cluster) {
        pair = {random() % 5 == 0 ? 1.0 : 0.0, random() % 5 != 0 ? 1.0 : 0.0};
        if (random() % 6 == 0 && unknown.size() < 6)
          unknown.push_back(random() % 2 ? &pair.first : &pair.second);
      }
    auto hidden = clusters;
    for (std::size_t i = 0; i < clusters.size(); ++i)
      for (std::size_t k = 0; k < size; ++k)
        for (double* cell : unknown) {
          if (cell == &clusters[i][k].first) hidden[i][k].first = kNan;
          if (cell == &clusters[i][k].second) hidden[i][k].second = kNan;
        }
    const Estimate e = estimated_event_difference(hidden);
    EXPECT_EQ(e.unknown > 0, !unknown.empty());
    for (unsigned assignment = 0; assignment < 1u << unknown.size(); ++assignment) {
      for (std::size_t i = 0; i < unknown.size(); ++i) *unknown[i] = assignment >> i & 1u;
      const Estimate one = estimated_event_difference(clusters);
      if (std::isnan(one.low) || unknown.empty()) continue;
      EXPECT_LE(e.low, one.value + 1e-9);
      EXPECT_GE(e.high, one.value - 1e-9);
      EXPECT_GE(e.p, 0.05 < one.p ? 0.05 : 0);
    }
    EXPECT_TRUE(std::isnan(e.p) || std::isnan(e.low) || (e.p <= 0.05) == (e.low > 0 || e.high < 0));
  }
}

// Unknown outcomes never make an interval that the known outcomes do not have.
TEST(EstimatedEventDifference, UnknownOutcomesAddNoCertainty) {
  std::vector<std::vector<OutcomePair>> one(1, std::vector<OutcomePair>(100, {0, 0}));
  EXPECT_TRUE(std::isnan(estimated_event_difference(one).low));
  one[0][0] = {kNan, kNan};
  const Estimate e = estimated_event_difference(one);
  EXPECT_TRUE(std::isnan(e.low) && std::isnan(e.high) && std::isnan(e.p));
  EXPECT_EQ(e.note, "one run");
  std::vector<std::vector<OutcomePair>> eight(8, {{0, 1}, {0, 1}});
  for (auto& cluster : eight) cluster[0].first = kNan;
  const Estimate all = estimated_event_difference(eight);
  EXPECT_EQ(all.low, 0.5);  // a test of eight equal clusters
  EXPECT_EQ(all.high, 1);
}

std::vector<RunsAtValue> values_of(const std::vector<double>& x, const std::vector<std::int64_t>& events,
                                   std::int64_t runs, const std::vector<std::int64_t>& unknown = {}) {
  std::vector<RunsAtValue> all;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::int64_t none = i < unknown.size() ? unknown[i] : 0;
    all.push_back({x[i], {events[i], runs - events[i] - none, none}});
  }
  return all;
}

void expect_limit(const Estimate& e, double value, double low, double high) {
  EXPECT_EQ(std::isnan(e.value), std::isnan(value));
  if (!std::isnan(value)) expect_near(e.value, value);
  EXPECT_TRUE(std::isnan(low) ? std::isnan(e.low) : e.low == low) << e.low;
  EXPECT_TRUE(std::isnan(high) ? std::isnan(e.high) : e.high == high) << e.high;
}

TEST(EstimatedLimit, EqualsTheExamples) {
  const auto tens = values_of({1, 2, 3, 4, 5, 6, 7, 8}, {0, 0, 1, 4, 9, 10, 10, 10}, 10);
  expect_limit(estimated_limit(tens, {0.5}).estimate, 4.2, 3, 5);
  const auto plateau = values_of({1, 2, 3, 4}, {0, 2, 2, 4}, 4);
  EXPECT_DOUBLE_EQ(estimated_limit(plateau, {0.5}).estimate.value, 2.5);
  const Estimate rare = estimated_limit(tens, {0.05}).estimate;
  expect_limit(rare, 2.5, kNan, 4);
  EXPECT_EQ(rare.note, "low: 5 % needs 72 runs");
  std::vector<RunsAtValue> fixed;
  for (int i = 0; i < 5; ++i) fixed.push_back({1.0 + 2 * i, {i < 2 ? 0 : 30, i < 2 ? 30 : 0}, true});
  const Estimate exact = estimated_limit(fixed, {0.5}).estimate;
  expect_limit(exact, exact.value, 3, 5);
  EXPECT_EQ(exact.clusters, 5);
  const auto unknown = values_of({0, 3, 6, 9, 12}, {0, 0, 21, 106, 156}, 200, {10, 53, 107, 89, 44});
  expect_limit(estimated_limit(unknown, {0.5}).estimate, 7.13, 3, 12);
  expect_limit(estimated_limit(unknown, {0.05}).estimate, 3.66, kNan, 6);
  EXPECT_EQ(runs_for_level(0.5), 6);
  EXPECT_EQ(runs_for_level(0.1), 36);
  EXPECT_EQ(runs_for_level(0.05), 72);
  EXPECT_GT(runs_for_level(1e-20), 1000000);
}

// There is no one limit. If both ends of the axis are clear, the interval holds all crossings.
TEST(EstimatedLimit, OfACurveThatRisesAndFalls) {
  const auto bump = values_of({0, 3, 9, 12, 16, 40, 60, 80}, {0, 0, 40, 40, 40, 0, 1, 0}, 40);
  for (const bool rises : {true, false}) {
    const Limit limit = estimated_limit(bump, {0.5, rises});
    expect_limit(limit.estimate, kNan, kNan, kNan);
    EXPECT_EQ(limit.place, LimitPlace::rises_and_falls);
    EXPECT_NE(limit.estimate.note.find("the curve rises and falls"), std::string::npos);
  }
  const Limit back = estimated_limit(values_of({1, 2, 3, 4}, {0, 40, 0, 40}, 40), {0.5});
  expect_limit(back.estimate, back.estimate.value, 1, 4);
  EXPECT_EQ(back.estimate.note, "the curve rises and falls");
  EXPECT_EQ(estimated_limit(values_of({1, 2, 3, 4}, {0, 26, 14, 40}, 40), {0.5}).estimate.note, "");
}

TEST(EstimatedLimit, BorrowsOnlyIndependentRuns) {
  const auto few = values_of({1, 2, 3, 4, 5, 6}, {0, 0, 0, 3, 3, 3}, 3);
  expect_limit(estimated_limit(few, {0.5}).estimate, 3.5, 2, 5);
  LimitRule shared{0.5};
  shared.values_are_independent = false;
  const Estimate open = estimated_limit(few, shared).estimate;
  expect_limit(open, 3.5, kNan, kNan);
  EXPECT_EQ(open.note, "low: 50 % needs 6 runs; high: 50 % needs 6 runs");
}

// A run is lost above its threshold.
std::vector<OutcomesAtValue> thresholds(const std::vector<double>& limits) {
  std::vector<OutcomesAtValue> curve;
  for (int x = 1; x <= 10; ++x) {
    curve.push_back({static_cast<double>(x), {}});
    for (const double limit : limits)
      curve.back().outcomes.push_back(x > limit ? EventOutcome::event : EventOutcome::without);
  }
  return curve;
}

const std::vector<double> kA = {3.2, 3.6, 2.8, 4.1, 3.9, 3.3, 3.5, 2.6},
                          kB = {5.1, 6.4, 4.9, 6.8, 6.2, 5.4, 6.6, 4.7},
                          kC = {3.4, 4.7, 2.5, 5.2, 3.1, 4.4, 3.8, 2.9};

Estimate compared(const std::vector<double>& a, const std::vector<double>& b, LimitComparison comparison) {
  return estimated_limit_comparison(thresholds(a), thresholds(b), {0.5}, comparison);
}

TEST(EstimatedLimitComparison, EqualsTheExamples) {
  const auto limit = [](const std::vector<double>& t) {
    std::vector<RunsAtValue> runs;
    for (const OutcomesAtValue& value : thresholds(t)) runs.push_back(value.runs());
    return estimated_limit(runs, {0.5}).estimate;
  };
  expect_limit(limit(kA), 3.4, 2, 5);
  expect_limit(limit(kB), 6, 4, 7);
  expect_limit(limit(kC), 3.67, 2, 6);
  const Estimate b = compared(kA, kB, LimitComparison::difference);
  expect_interval(b, 2.6, 0, 4);
  EXPECT_EQ(b.p, 0.001);
  expect_interval(compared(kA, kB, LimitComparison::ratio), 6 / 3.4, 1, 3);
  const Estimate c = compared(kA, kC, LimitComparison::difference);
  expect_interval(c, 4.0 / 15, -2, 2);
  EXPECT_EQ(c.p, 1);
}

TEST(EstimatedLimitComparison, NeedsClosedIntervals) {
  const Estimate few = compared({3, 3, 3, 4, 4}, {6, 6, 7, 7, 7}, LimitComparison::difference);
  EXPECT_TRUE(std::isnan(few.p) && std::isnan(few.low));
  EXPECT_FALSE(few.note.empty());
  const Estimate open = compared(kA, std::vector<double>(8, 12), LimitComparison::difference);
  EXPECT_TRUE(std::isnan(open.p));
  EXPECT_EQ(open.note, "the interval of a limit is open");
}

// Without a test there is no value. In the second example 0.04 * 1 is raised to the value before it.
TEST(HolmsFamily, EqualsTheExamples) {
  const std::pair<std::vector<double>, std::vector<double>> examples[] = {
      {{0.001, kNan, 0.03, 1, 0.012, 0.2}, {0.005, kNan, 0.09, 1, 0.048, 0.4}},
      {{0.01, 0.04, 0.03, 0.005}, {0.03, 0.06, 0.06, 0.02}},
      {{0.02}, {0.02}},
      {{1, 0.4, 1, 0.9}, {1, 1, 1, 1}},
      {{0.25, 0.25}, {0.5, 0.5}},
      {{0, 0, 1}, {0, 0, 1}},
      {{}, {}}};
  for (const auto& [p, expected] : examples) {
    const std::vector<double> adjusted = holm_adjusted(p);
    ASSERT_EQ(adjusted.size(), expected.size());
    for (std::size_t i = 0; i < p.size(); ++i)
      EXPECT_TRUE(std::isnan(expected[i]) ? std::isnan(adjusted[i])
                                          : std::abs(adjusted[i] - expected[i]) < 1e-15)
          << p[i];
  }
  EXPECT_EQ(tests_among({0.001, kNan, 0.2}), 2);
  EXPECT_EQ(pairs_for_family(1), 6);
  EXPECT_EQ(pairs_for_family(20), 10);  // 20 * 2^-9 = 0.039
}

}  // namespace
}  // namespace remote_touch::estimates_test
