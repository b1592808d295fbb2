// Coverage: the fraction of intervals that hold the truth, by simulation with fixed seeds. The page of
// runners/sweep has these numbers, with more repeats: COVERAGE_REPEATS in the source.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "analysis/trace/curve_fits.h"
#include "analysis/trace/interval_estimates.h"

namespace remote_touch::coverage_test {
namespace {

#ifndef COVERAGE_REPEATS
#define COVERAGE_REPEATS 2000
#endif
constexpr int kRepeats = COVERAGE_REPEATS;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform() { return std::generate_canonical<double, 53>(engine_); }
  double normal() { return normal_(engine_); }
  bool happens(double probability) { return uniform() < probability; }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

using Draw = std::function<Estimate(Random&)>;

// Fraction of the printed intervals that hold the truth.
double coverage(double truth, unsigned seed, const Draw& draw) {
  Random random(seed);
  double printed = 0, held = 0;
  for (int i = 0; i < kRepeats; ++i) {
    const Estimate e = draw(random);
    if (std::isnan(e.low) && std::isnan(e.high) && e.method != "binomial walks") continue;
    ++printed, held += !(e.low > truth) && !(e.high < truth) ? 1 : 0;
  }
  return held / printed;
}

// Reports a row, and fails if it is below the bound by more than chance: 2.3 standard deviations.
void expect_covers(const std::string& row, double bound, double measured) {
  std::printf("  %-58s %.3f\n", row.c_str(), measured);
  EXPECT_GE(measured, bound - 2.3 * std::sqrt(bound * (1 - bound) / kRepeats) - 1e-9) << row;
}
// The same for a fraction that must not be above the limit.
void expect_at_most(const std::string& row, double limit, double measured) {
  std::printf("  %-58s %.3f\n", row.c_str(), measured);
  EXPECT_LE(measured, limit) << row;
}
std::string short_text(double number) {
  return std::to_string(number).substr(0, 4);
}

struct Shape {
  const char* name;
  std::function<double(Random&)> draw;
  double mean;
};
const Shape kNormal = {"normal", [](Random& r) { return r.normal(); }, 0};
const Shape kExponential = {"exponential", [](Random& r) { return -std::log(1 - r.uniform()); }, 1};
const Shape kLognormal = {"lognormal", [](Random& r) { return std::exp(r.normal()); }, std::exp(0.5)};
Shape zeros(double fraction) {
  return {"zeros and exponential",
          [fraction](Random& r) { return r.happens(fraction) ? 0 : -std::log(1 - r.uniform()); },
          1 - fraction};
}

std::vector<double> sample(const Shape& shape, int n, Random& random) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(shape.draw(random));
  return values;
}

TEST(Coverage, OfMeans) {
  const struct {
    Shape shape;
    int n;
    double bound;
  } rows[] = {{kNormal, 12, 0.957},    {kExponential, 12, 0.944}, {kLognormal, 12, 0.907},
              {kLognormal, 40, 0.939}, {zeros(0.5), 12, 0.953},   {zeros(0.8), 12, 0.929},
              {zeros(0.8), 20, 0.950}};
  for (const auto& [shape, n, bound] : rows)
    expect_covers(std::string("mean, ") + shape.name + ", n = " + std::to_string(n), bound,
                  coverage(shape.mean, 1, [&, n = n, &shape = shape](Random& r) {
                    return estimated_mean(sample(shape, n, r));
                  }));
}

TEST(Coverage, OfDifferences) {
  for (const int n : {8, 12, 24})
    expect_covers("difference, normal, n = " + std::to_string(n), 0.945,
                  coverage(0, 2, [&](Random& r) { return estimated_difference(sample(kNormal, n, r)); }));
  for (const auto& [shape, bound] : {std::pair{kExponential, 0.917}, {kLognormal, 0.860}}) {
    expect_covers(std::string("difference, ") + shape.name + ", n = 12", bound,
                  coverage(shape.mean, 3, [&, &shape = shape](Random& r) {
                    return estimated_difference(sample(shape, 12, r));
                  }));
    Random random(4);
    double found = 0;
    for (int i = 0; i < kRepeats; ++i) {
      std::vector<double> d = sample(shape, 12, random);
      for (double& value : d) value -= shape.mean;
      const Estimate e = estimated_difference(d);
      found += e.p <= 0.05 && !e.is_skewed ? 1 : 0;
    }
    expect_at_most(std::string("its false p <= 0.05 without the note, ") + shape.name,
                   (shape.mean == 1 ? 0.063 : 0.094) + 0.015, found / kRepeats);
  }
}

// Eight events of a cluster share a normal number.
EventCounts cluster_of(double z, double threshold, Random& random) {
  EventCounts counts;
  for (int i = 0; i < 8; ++i)
    ++(0.7 * z + std::sqrt(1 - 0.49) * random.normal() > threshold ? counts.events : counts.without);
  return counts;
}

TEST(Coverage, OfFractions) {
  const std::pair<double, double> rare = {2.0537, 0.02}, more = {1.2816, 0.1};
  for (const auto& [threshold, p] : {rare, more})
    for (const int clusters : {5, 12, 40})
      expect_covers("pooled event, " + std::to_string(clusters) + " clusters of 8, p = " + short_text(p),
                    0.92, coverage(p, 5, [&, threshold = threshold](Random& r) {
                      std::vector<EventCounts> all;
                      for (int c = 0; c < clusters; ++c) all.push_back(cluster_of(r.normal(), threshold, r));
                      return estimated_fraction(all);
                    }));
  expect_covers("event, 20 % unknown, all of them events, n = 40", 0.95, coverage(0.5, 6, [](Random& r) {
                  EventCounts counts;
                  for (int i = 0; i < 40; ++i) {
                    const bool event = r.happens(0.5);
                    ++(event && r.happens(0.4) ? counts.unknown : event ? counts.events : counts.without);
                  }
                  return estimated_fraction(counts);
                }));
}

TEST(Coverage, OfPairedEvents) {
  double least = 1;
  for (const int n : {6, 12, 24, 40})
    for (const auto& [up, down] : {std::pair{0.1, 0.1}, {0.3, 0.05}, {0.5, 0.3}, {0.8, 0.1}, {0.05, 0.0}})
      least = std::min(
          least, coverage(up - down, 7, [&, up = up, down = down](Random& r) {
            std::vector<std::vector<OutcomePair>> pairs;
            for (int i = 0; i < n; ++i) {
              const double u = r.uniform();
              pairs.push_back({OutcomePair{u >= up && u < up + down ? 1.0 : 0.0, u < up ? 1.0 : 0.0}});
            }
            return estimated_event_difference(pairs);
          }));
  expect_covers("paired events, n = 6..40, least", 0.928, least);
}

std::vector<OutcomesAtValue> curve_of(double limit, double width, int runs, Random& random) {
  std::vector<OutcomesAtValue> curve;
  for (int x = 1; x <= 10; ++x) {
    curve.push_back({static_cast<double>(x), {}});
    for (int i = 0; i < runs; ++i)
      curve.back().outcomes.push_back(random.happens(1 / (1 + std::exp(-(x - limit) / width)))
                                          ? EventOutcome::event
                                          : EventOutcome::without);
  }
  return curve;
}

TEST(Coverage, OfLimits) {
  for (const auto& [level, runs] : {std::pair{0.5, 40}, {0.05, 200}})
    for (const double width : {0.02, 0.3, 1.0}) {
      const double truth = 5.37 + width * std::log(level / (1 - level));
      expect_covers("limit " + short_text(level) + ", width of the rise " + short_text(width), 0.997,
                    coverage(truth, 8, [&, level = level, runs = runs](Random& r) {
                      std::vector<RunsAtValue> values;
                      for (const OutcomesAtValue& value : curve_of(5.37, width, runs, r))
                        values.push_back(value.runs());
                      return estimated_limit(values, {level}).estimate;
                    }));
    }
}

TEST(Coverage, OfDifferencesOfLimits) {
  Random random(9);
  double printed = 0, held = 0;
  for (int i = 0; i < std::min(kRepeats, 100); ++i) {
    const Estimate e = estimated_limit_comparison(
        curve_of(4.2, 0.5, 20, random), curve_of(6.6, 0.5, 20, random), {0.5}, LimitComparison::difference);
    if (std::isnan(e.low)) continue;
    ++printed, held += e.low < 2.4 && 2.4 < e.high ? 1 : 0;
  }
  std::printf("  %-58s %.3f\n", "difference of limits, 100 repeats", held / printed);
  EXPECT_GE(held / printed, 0.95);
}

// Four tables of six true nulls in one command.
TEST(Coverage, OfHolmsFamily) {
  Random random(10);
  double found = 0;
  for (int i = 0; i < kRepeats; ++i) {
    std::vector<double> p;
    for (int test = 0; test < 24; ++test) p.push_back(estimated_difference(sample(kNormal, 20, random)).p);
    for (const double adjusted : holm_adjusted(p))
      if (adjusted < 0.05) {
        ++found;
        break;
      }
  }
  expect_at_most("4 tables of 6 true nulls: any adjusted p < 0.05", 0.05 + 0.011, found / kRepeats);
}

}  // namespace
}  // namespace remote_touch::coverage_test
