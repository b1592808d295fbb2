#include "analysis/tally/quantile_sketch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace remote_touch {

namespace {

constexpr int kDroppedBits = 47;  // number of the bits, of the 52 of the mantissa
constexpr std::int32_t kLastBucket = 0x7ff << 5;

}  // namespace

std::int32_t QuantileSketch::bucket_of(double value) {
  if (value == 0) return 0;
  const auto bits = std::bit_cast<std::uint64_t>(std::abs(value));
  const auto bucket = static_cast<std::int32_t>(bits >> kDroppedBits) + 1;
  return value > 0 ? bucket : -bucket;
}

double QuantileSketch::middle_of(std::int32_t bucket) {
  if (bucket == 0) return 0;
  const auto first = static_cast<std::uint64_t>(std::abs(bucket) - 1) << kDroppedBits;
  const auto middle = std::bit_cast<double>(first | std::uint64_t{1} << (kDroppedBits - 1));
  return bucket > 0 ? middle : -middle;
}

void QuantileSketch::add(double value) {
  const std::int32_t bucket = bucket_of(value);
  const auto at = std::lower_bound(buckets_.begin(), buckets_.end(), bucket);
  const auto i = at - buckets_.begin();
  if (at == buckets_.end() || *at != bucket) {
    buckets_.insert(at, bucket);
    counts_.insert(counts_.begin() + i, 0);
  }
  ++counts_[static_cast<std::size_t>(i)];
}

void QuantileSketch::add(const QuantileSketch& other) {
  QuantileSketch both;
  std::size_t i = 0, j = 0;
  while (i < buckets_.size() || j < other.buckets_.size()) {
    const bool here = j == other.buckets_.size() || (i < buckets_.size() && buckets_[i] <= other.buckets_[j]);
    const bool there =
        i == buckets_.size() || (j < other.buckets_.size() && other.buckets_[j] <= buckets_[i]);
    both.buckets_.push_back(here ? buckets_[i] : other.buckets_[j]);
    both.counts_.push_back((here ? counts_[i++] : 0) + (there ? other.counts_[j++] : 0));
  }
  *this = std::move(both);
}

std::int64_t QuantileSketch::count() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
}

std::int32_t QuantileSketch::bucket_at(double p) const {
  const double rank = std::max(1.0, std::ceil(p * static_cast<double>(count())));
  std::int64_t below = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    below += counts_[i];
    if (static_cast<double>(below) >= rank) return buckets_[i];
  }
  return buckets_.empty() ? 0 : buckets_.back();
}

double QuantileSketch::quantile(double p) const {
  return buckets_.empty() ? std::numeric_limits<double>::quiet_NaN() : middle_of(bucket_at(p));
}

std::vector<std::pair<std::int32_t, std::int64_t>> QuantileSketch::pairs() const {
  std::vector<std::pair<std::int32_t, std::int64_t>> pairs;
  pairs.reserve(buckets_.size());
  for (std::size_t i = 0; i < buckets_.size(); ++i) pairs.emplace_back(buckets_[i], counts_[i]);
  return pairs;
}

std::optional<QuantileSketch> QuantileSketch::from_pairs(
    const std::vector<std::pair<std::int32_t, std::int64_t>>& pairs) {
  QuantileSketch sketch;
  std::int64_t total = 0;
  for (const auto& [bucket, count] : pairs) {
    if (bucket < -kLastBucket || bucket > kLastBucket || count < 1) return {};
    if (!sketch.buckets_.empty() && bucket <= sketch.buckets_.back()) return {};
    if (__builtin_add_overflow(total, count, &total)) return {};
    sketch.buckets_.push_back(bucket);
    sketch.counts_.push_back(count);
  }
  return sketch;
}

}  // namespace remote_touch
