// The tally of the runs of one cell.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace remote_touch {

// The exact sum of doubles, which does not depend on the order of the terms.

// The sum is kept as a short list of doubles; added exactly they give the sum. Adding a double changes the
// list without a rounding. Source: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast
// robust geometric predicates", Discrete & Computational Geometry 18 (1997), theorem 10. Most sums fit into
// three doubles, which are added to from the largest down. Only what these cannot hold goes to a list like
// Shewchuk's. Sums above 2^1022 are exact, too: whole multiples of 2^1023 are counted apart.
class UnroundedSum {
 public:
  // pre: the value is finite.
  void add(double value);
  // Adds the square of a finite value: its rounded square and, by std::fma, the rest. This is exact if value
  // is 0 or |value| is at least 2^-485 (1e-146). The square of a smaller value is rounded to a multiple of
  // 2^-1074, the least double. If the rounded square is infinite, |value| >= 2^512 (1.34e154), the sum
  // becomes infinite and remains so. In both cases the result depends on the values alone, not on their
  // order.
  void add_square(double value);
  // Adds a product of finite values. Exact if it is 0, or at least 2^-968 in magnitude; else it is rounded as
  // a square is. pre: the rounded product is finite.
  void add_product(double a, double b);
  void add(const UnroundedSum& other);

  // Returns the sum, correctly rounded to nearest (even), so infinity if it is above the largest double. The
  // sum of nothing is +0.
  double value() const;
  // True after the square of a value was too large.
  bool is_infinite() const { return is_infinite_; }

  // Returns value(), then the rounded rest, and so on until nothing is left; empty if the sum is 0. Equal
  // sums have equal parts, and the exact sum of the parts is the sum. At most 42. If value() is infinite, the
  // parts are: that infinity; a whole number u; and the parts of the sum minus u 2^1023, which is in
  // (-2^1022, 2^1022]. They are infinity alone if is_infinite().
  std::vector<double> parts() const;
  // Returns nothing unless the numbers are what parts() returns for some sum.
  static std::optional<UnroundedSum> from_parts(std::span<const double> parts);

  bool operator==(const UnroundedSum& other) const { return parts() == other.parts(); }

 private:
  std::array<double, 3> largest_{};  // their exact sum counts; they may overlap
  std::vector<double> others_;  // the rest that largest_ cannot hold: nonoverlapping, by increasing magnitude
  std::int64_t units_ = 0;      // multiples of 2^1023
  bool is_infinite_ = false;
};

// Counts of values in fixed narrow buckets, from which quantiles follow with a known error.

// The bucket of a double is its sign, its exponent and the first 5 bits of its mantissa, so that nothing is
// rounded. There are 32 buckets of equal width from each power of two to the next. Buckets are numbered in
// the order of their values: 0 holds 0 and -0 only; b > 0 holds the doubles whose bits, shifted right by 47,
// are b - 1; -b holds their negatives. The sketch of values does not depend on their order.
class QuantileSketch {
 public:
  // Number of the bucket of a finite value.
  static std::int32_t bucket_of(double value);
  // Returns the middle of a bucket. It differs from each value v in the bucket by at most |v| / 64 (1.6 %),
  // because the bucket is 1/32 of the power of two at or below |v| wide. Below 2^-1022 it differs by at most
  // 2^-1028 instead. The middle of bucket 0 is 0.
  static double middle_of(std::int32_t bucket);

  // pre: the value is finite.
  void add(double value);
  void add(const QuantileSketch& other);

  std::int64_t count() const;  // number of values
  // Approximates x_k of the sorted values x_1 .. x_n, k = max(1, ceil(p n)), by the middle of its bucket.
  // This is the inverse of the empirical distribution function: type 1 of Hyndman and Fan, Sample quantiles
  // in statistical packages, The American Statistician 50 (1996). The product p n is rounded to a double. NaN
  // without values. pre: 0 <= p <= 1.
  double quantile(double p) const;
  // Returns the bucket that has x_k; 0 without values.
  std::int32_t bucket_at(double p) const;

  // Buckets with their counts, increasing. from_pairs() returns nothing unless pairs() may return the list.
  std::vector<std::pair<std::int32_t, std::int64_t>> pairs() const;
  static std::optional<QuantileSketch> from_pairs(
      const std::vector<std::pair<std::int32_t, std::int64_t>>& pairs);

  bool operator==(const QuantileSketch&) const = default;

 private:
  std::vector<std::int32_t> buckets_;  // increasing
  std::vector<std::int64_t> counts_;   // counts of these buckets; above 0
};

// The tally of one measure in the runs of a cell.

// Equal values in any order, and in any parts that are added to each other, give equal bits.
struct MeasureTally {
  std::int64_t values = 0;    // number of finite values; least, greatest, sums and sketch are of these only
  std::int64_t unknown = 0;   // NaN
  std::int64_t infinite = 0;  // infinity of either sign
  double least = std::numeric_limits<double>::infinity();  // infinity and -infinity without values
  double greatest = -std::numeric_limits<double>::infinity();
  UnroundedSum sum,
      squares;  // sums of the values and of their squares; add_square() states the range of the latter
  QuantileSketch sketch;

  void add(double value);  // any double; -0 counts as 0
  void add(const MeasureTally& other);

  // Returns the rounded sum divided by the number of values; NaN without values.
  double mean() const;
  // Returns (n sum of squares - (sum)^2) / (n (n - 1)). The numerator is rounded once, so nothing cancels.
  // NaN with fewer than two values, or if the sum or the sum of squares is above the largest double (values
  // of 1e154). Deviations below 1e-146 are lost.
  double variance() const;
  double standard_deviation() const;
  // Returns the quantile of QuantileSketch, clipped to least .. greatest. It differs by at most 1.6 % from
  // the value that it approximates, x_k of the sorted values. p = 0 gives least and p = 1 greatest. NaN
  // without values.
  double quantile(double p) const;

  // Checks a tally of unknown origin. Returns what contradicts what, such as "the extremes are outside the
  // sketch"; empty if it is consistent.
  std::string contradiction() const;
  bool operator==(const MeasureTally&) const = default;
};

// The layout that all tallies of one sweep have.
struct TallyLayout {
  std::size_t measures = 0;    // number of measures
  std::size_t note_kinds = 0;  // number of kinds of notes, at most 64
  std::vector<std::size_t>
      events;  // the measures whose runs are listed, increasing; empty for keep = "tally"
};

// Runs with a note of one kind.
struct NoteTally {
  std::int64_t runs = 0;
  std::uint64_t first = 0;  // lowest number of such a run; without meaning (0) if there is none

  bool operator==(const NoteTally&) const = default;
};

// The same runs, in any order and in any parts that are added to each other, give equal bits. Numbers of runs
// are those of SweepResult: cell times replicates plus replicate. The caller adds no run twice.
struct CellTally {
  CellTally() = default;
  explicit CellTally(const TallyLayout& layout)
      : measures(layout.measures), notes(layout.note_kinds), events(layout.events.size()) {}

  std::int64_t done = 0;
  std::int64_t failed = 0;
  std::uint64_t first_failed = 0;  // lowest number of a failed run; without meaning (0) if none failed
  std::string first_error;         // why that run failed
  std::vector<MeasureTally> measures;
  std::vector<NoteTally> notes;  // one for each kind
  // One list for each of the layout's events: the numbers of the runs in which it is above 0.5, increasing.
  std::vector<std::vector<std::uint64_t>> events;

  std::int64_t runs() const { return done + failed; }
  // Adds a run that was done. values: one for each measure; NaN if unknown. note_bits: bit i is set if the
  // run has a note of kind i. pre: the tally was made for this layout.
  void add_done(const TallyLayout& layout, std::uint64_t run, std::span<const double> values,
                std::uint64_t note_bits);
  // Adds a run that failed. It counts in no measure and has no notes.
  void add_failed(std::uint64_t run, const std::string& error);
  // pre: both tallies were made for the same layout.
  void add(const CellTally& other);

  // Checks a tally of unknown origin. Returns what contradicts what, such as "the runs of a note exceed the
  // finished runs"; empty if it is consistent.
  std::string contradiction() const;
  bool operator==(const CellTally&) const = default;
};

}  // namespace remote_touch
