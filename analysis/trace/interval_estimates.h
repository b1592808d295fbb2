// Statistics of plain numbers: means and higher moments, extremes that keep NaN, 95 % intervals of means and
// of fractions of runs, and tests of pairs.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace remote_touch {

// Value of a measure if a run has nothing to measure. It is not computed as 0 / 0, because the sign of that
// NaN depends on the machine.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

// Adds the numbers in the order of the list. Returns NaN for an empty list.
double mean(const std::vector<double>& values);

// Returns the mean of value(i) over each i below `count` for which qualifies(i) is true; NaN if there is
// none. If the values are true or false, it is the fraction that is true. The NaN is not computed as 0 / 0,
// because the sign of that NaN depends on the machine.
template <class Qualifies, class Value>
double mean_where(std::size_t count, Qualifies&& qualifies, Value&& value) {
  double sum = 0, number = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (qualifies(i)) sum += value(i), ++number;
  return number == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / number;
}

// Moments of the numbers that are not NaN. variance: with count - 1; third: mean of the cubed deviations.
struct Moments {
  double count = 0, mean = 0, variance = 0, third = 0;
};
Moments moments_of(const std::vector<double>& values);

// Minima and maxima that keep NaN. std::max(0.0, NaN) is 0, so a claim about such a maximum would pass
// without a value.

// Returns the larger value, and NaN if one of them is NaN.
inline double max_or_nan(double a, double b) {
  return std::isnan(a) || a > b ? a : b;
}
// Returns the smaller value, and NaN if one of them is NaN.
inline double min_or_nan(double a, double b) {
  return std::isnan(a) || a < b ? a : b;
}

// Returns the largest value; NaN if one of them is NaN or there is none.
inline double max_of(std::span<const double> values) {
  double max = values.empty() ? std::nan("") : values[0];
  for (const double v : values) max = max_or_nan(max, v);
  return max;
}
// Returns the smallest value; NaN if one of them is NaN or there is none.
inline double min_of(std::span<const double> values) {
  double min = values.empty() ? std::nan("") : values[0];
  for (const double v : values) min = min_or_nan(min, v);
  return min;
}

// Returns value(i) for each i below `count` for which qualifies(i) is true.
template <class Qualifies, class Value>
std::vector<double> values_where(std::size_t count, Qualifies&& qualifies, Value&& value) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
    if (qualifies(i)) values.push_back(value(i));
  return values;
}
// Returns the largest of these values; NaN if one of them is NaN or no i qualifies.
template <class Qualifies, class Value>
double max_where(std::size_t count, Qualifies&& qualifies, Value&& value) {
  return max_of(values_where(count, qualifies, value));
}
// Returns the smallest of these values; NaN if one of them is NaN or no i qualifies.
template <class Qualifies, class Value>
double min_where(std::size_t count, Qualifies&& qualifies, Value&& value) {
  return min_of(values_where(count, qualifies, value));
}

// A number of an answer with its 95 % interval. Every interval is two-sided, at 95 %. Every p is two-sided.
// NaN: there is no such number. A p and an interval come from the same test: p <= 0.05 exactly if the
// interval does not hold 0.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  double p = std::numeric_limits<double>::quiet_NaN();  // null hypothesis: the value is 0
  // The number of independent runs or pairs: runs that share random numbers count as one, a cluster.
  std::int64_t clusters = 0;
  std::int64_t unknown = 0;  // number of runs or pairs whose outcome is unknown (NaN)
  std::string method = {};   // name of the interval; empty: there is none
  std::string note = {};     // why something is missing, and what the reader must know; "; " between reasons
  // True if p <= 0.05, but few large differences decide (estimated_difference()): such an estimate shows
  // neither "better" nor "worse".
  bool is_skewed = false;

  // Adds a reason to the note, once; an empty one is left out.
  void add_note(const std::string& reason) {
    if (note.find(reason) == std::string::npos) note += (note.empty() ? "" : "; ") + reason;
  }
};

// The fewest pairs or clusters with which a test can reach p = 0.05: 2 / 2^6 = 0.03.
inline constexpr std::int64_t kLeastPairs = 6;
// The note of an estimate whose is_skewed is true.
inline constexpr const char* kSkewedNote = "skewed: few large differences decide";
// The method of an estimate from runs without random numbers. Its value is exact, and it has an interval only
// if outcomes are unknown or if it lies between two values of an axis.
inline constexpr const char* kExactMethod = "exact";

// Student's t: intervals of the mean of a few numbers.

// Two-sided p value: the probability of a |t| at least as large, with this number of degrees of freedom. pre:
// degrees >= 1.
double student_two_sided(double t, double degrees);
// Two-sided critical value: |t| is larger than this with the given probability in (0, 1]. pre: degrees >= 1.
double student_quantile(double probability, double degrees);

// The numbers of a stratum, such as the runs of a cell: strata may have different means.
struct Stratum {
  std::vector<double> numbers;  // NaNs are skipped and count as unknown
  bool is_fixed = false;        // the numbers are equal by construction: they count as one without scatter
};

// Mean of all numbers. The interval is Student's, from the scatter within the strata, with the degrees of
// freedom of F. Satterthwaite (Biometrics Bulletin 2 (1946), 110-114), rounded down. From 6 numbers and 5
// degrees on, it is the hull of that and of the interval corrected for skewness by P. Hall (J. R. Stat. Soc.
// B 54 (1992), 221-228); with fewer a note says that it assumes a normal distribution. It is NaN, with a
// note, if nothing scatters. Numbers that are alone in a stratum which is not fixed form one stratum
// together. If all strata are fixed, the value is exact, and the method is kExactMethod.
Estimate estimated_mean(const std::vector<Stratum>& strata);
// The same for one stratum.
Estimate estimated_mean(const std::vector<double>& numbers);

// The moments of a stratum of which the numbers are not known.
struct StratumMoments {
  Moments moments;
  bool is_fixed = false;
  std::int64_t unknown = 0;
};
// The same; without the correction for skewness unless has_third, which says that Moments::third is set.
Estimate estimated_mean(const std::vector<StratumMoments>& strata, bool has_third);

// Fractions of runs in which an event happened, and their confidence intervals.

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

// Tests and intervals for pairs: two versions of a run with the same noise.

// Root mean square, without overflow or underflow of the squares; 0 for an empty list. pre: no NaN.
double root_mean_square(const std::vector<double>& values);

// Exact two-sided sign test: the probability of a split at least as uneven as plus against minus if every
// differing pair goes either way with probability 1/2. On the discordant pairs of an event it is the exact
// form of McNemar's test (Q. McNemar, Psychometrika 12 (1947), 153-157). Returns 1 if no pair differs. The
// relative error is below 1e-10 for counts up to 1e7 each; a result below about 1e-300 is returned as 0. It
// uses only +, -, * and /, so every machine computes the same bits. pre: plus, minus >= 0.
double sign_test(std::int64_t plus, std::int64_t minus);

// Mean of paired differences of clusters, with a test that it is 0. Those that are not finite are unknown.
// - Fewer than 6 differences: the interval of estimated_mean(), and no p.
// - 6 to 16: the exact test by sign flips (R. Fisher, The Design of Experiments, 1935), which assumes that a
//   difference is as likely as its opposite; the ends of the interval are means of subsets of the differences
//   (J. Hartigan, J. Am. Stat. Assoc. 64 (1969), 1303-1317).
// - More: Student's t; p is at least 2^(1 - n), which an exact test of n pairs can reach.
// If all differences are 0, p is 1. If all are equal, there is no interval, but a note. Numbers that differ
// by less than 1e-9 of the sum of all magnitudes count as equal. is_skewed is true, with a note, if p <= 0.05
// but the interval of estimated_mean() holds 0.
Estimate estimated_difference(const std::vector<double>& differences);

// The outcomes of an event in the two runs of a pair: 1, 0, or NaN if unknown.
struct OutcomePair {
  double first = 0, second = 0;
};
// Difference of the fractions of an event, second minus first. Each element has the pairs of one cluster. If
// each cluster has one pair: the exact sign test of the pairs that differ, and the interval of T. Tango
// (Statistics in Medicine 17 (1998), 891-908), extended to 0 if p > 0.05; no p below 6 pairs. Otherwise the
// clusters' means are compared as numbers. The value is that of the known pairs. With unknown outcomes, the
// interval is the hull of those of both extreme assignments of them, and p the larger one; it is 1 if the two
// differences have different signs.
Estimate estimated_event_difference(const std::vector<std::vector<OutcomePair>>& clusters);

// p values of tests made together, adjusted so that the probability of any false "adjusted < alpha" is at
// most alpha, whatever their dependence (S. Holm, Scand. J. Stat. 6 (1979), 65-70). Returned in the given
// order; none is below its own p. NaN: there was no test; it does not count, and stays NaN. pre: the others
// are within [0, 1].
std::vector<double> holm_adjusted(const std::vector<double>& p);
// Returns the number of tests among them: of the p values that are not NaN.
std::int64_t tests_among(const std::vector<double>& p);
// The fewest pairs whose exact test can reach an adjusted p of alpha in a family of this many tests: with n
// pairs, the least p is 2^(1 - n).
std::int64_t pairs_for_family(std::int64_t tests, double alpha = 0.05);

}  // namespace remote_touch
