// Fractions of runs in which an event happened, quantiles, and their confidence intervals.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/statistics/estimate.h"

namespace remote_touch {

// Two-sided 95 % point of the standard normal distribution.
inline constexpr double kTwoSided95 = 1.959963984540054;

// The two tails of a binomial distribution: the probability of at most, or of at least, `events` events in
// `runs` runs that each have one with this probability.
double probability_of_at_most(double events, double runs, double probability);
double probability_of_at_least(double events, double runs, double probability);

// Exact interval [low, high] of a fraction (C. Clopper, E. Pearson, Biometrika 26 (1934), 404-413); [0, 1]
// without runs. The numbers need not be whole. pre: 0 <= events <= runs.
std::pair<double, double> exact_interval(double events, double runs);

// The outcomes of some runs. An outcome is unknown if the measure of the event is NaN.
struct EventCounts {
  std::int64_t events = 0, without = 0, unknown = 0;

  std::int64_t known() const { return events + without; }
  std::int64_t runs() const { return known() + unknown; }
  void add(const EventCounts& other) {
    events += other.events, without += other.without, unknown += other.unknown;
  }
};

EventCounts sum_of(const std::vector<EventCounts>& counts);

// Fraction of the known runs in which the event happened. `low` is the low end if no unknown run had the
// event, and `high` the high end if all had it (C. Manski, Partial Identification of Probability
// Distributions, 2003). Each element has the runs of one cluster, which share random numbers; clusters are
// independent. If each cluster has one run, the interval is exact_interval(). Otherwise the value is the mean
// of the clusters' fractions, and the interval that of E. Korn and B. Graubard (Survey Methodology 24 (1998),
// 193-201): the exact one with the number of independent runs that has the variance of the clusters.
Estimate estimated_fraction(const std::vector<EventCounts>& clusters);
// The same for independent runs.
Estimate estimated_fraction(const EventCounts& runs);
// Fraction of runs that draw no random number: it is exact. There is an interval only if outcomes are
// unknown.
Estimate exact_fraction(const EventCounts& runs);

// Quantile of independent values, 0 < q < 1: the value x_k of the sorted x_1 .. x_n, k = max(1, ceil(q n)),
// between two of them whose ranks follow from the binomial distribution, whatever the distribution of the
// values is. An end is NaN if there are too few values for it. NaNs are skipped and count as unknown.
Estimate estimated_quantile(std::vector<double> values, double q);

}  // namespace remote_touch
