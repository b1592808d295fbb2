// Counts of values in fixed narrow buckets, from which quantiles follow with a known error.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace remote_touch {

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

}  // namespace remote_touch
