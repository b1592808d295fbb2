#include "core/beyond/tracked_surface/height_profile.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

void HeightProfile::clear(double half_range) {
  const int half = static_cast<int>(std::ceil(std::min(half_range, kMaxRange) / kBin));
  bins_ = std::min(2 * half, kMaxBins);
  half_range_ = 0.5 * bins_ * kBin;
  std::fill_n(count_.begin(), bins_ + 1, 0.0);
}

void HeightProfile::add_bins(const std::int32_t* bin, std::size_t number) {
  for (std::size_t i = 0; i < number; ++i) count_[static_cast<std::size_t>(bin[i])] += 1;
}

double HeightProfile::max() const {
  return bins_ == 0 ? 0 : *std::max_element(count_.begin(), count_.begin() + bins_);
}

// Applies a box filter twice, which is a triangular filter.
HeightProfile HeightProfile::smoothed(double sigma) const {
  HeightProfile result = *this;
  const int half = std::max(1, static_cast<int>(std::round(1.2 * sigma / kBin)));
  result.window_ = 1.5 * (2 * half + 1);
  std::array<double, kMaxBins + 1> sums;
  sums[0] = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < bins_; ++i)
      sums[static_cast<std::size_t>(i + 1)] = sums[static_cast<std::size_t>(i)] + result.count(i);
    for (int i = 0; i < bins_; ++i)
      result.count_[static_cast<std::size_t>(i)] =
          (sums[static_cast<std::size_t>(std::min(bins_, i + half + 1))] -
           sums[static_cast<std::size_t>(std::max(0, i - half))]) /
          (2 * half + 1);
  }
  return result;
}

// Sums for all shifts together, bin by bin, so that empty bins cost nothing.
double HeightProfile::shift_of(const HeightProfile& other, double reach) const {
  constexpr double kNearness = 0.1;  // relative reduction of a sum at the end of the reach
  const int max = std::min(static_cast<int>(std::round(reach / kBin)), kMaxBins);
  const int offset = (other.bins_ - bins_) / 2;
  std::array<double, 2 * kMaxBins + 1> products;
  std::fill_n(products.begin(), 2 * max + 1, 0.0);
  for (int b = 0; b < bins_; ++b) {
    const double here = count(b);
    if (here == 0) continue;
    const int middle = b + offset;  // bin of the same height in the other profile
    for (int k = std::max(-max, -middle); k <= std::min(max, other.bins_ - 1 - middle); ++k)
      products[static_cast<std::size_t>(max + k)] += here * other.count(middle + k);
  }
  double best = -1;
  int at = 0;
  for (int step = 0; step <= 2 * max; ++step) {
    const int k = step % 2 == 0 ? step / 2 : -(step + 1) / 2;
    const double sum =
        products[static_cast<std::size_t>(max + k)] * (1 - kNearness * (k * k) / (max * max + 1.0));
    if (sum > best) best = sum, at = k;
  }
  return at * kBin;
}

double HeightProfile::valley_from(double height, int direction) const {
  if (bins_ == 0) return 0;
  const int start = std::clamp(static_cast<int>((height + half_range_) / kBin), 0, bins_ - 1);
  const double peak = count(start);
  constexpr double kSure = 4, kPeakFraction = 0.15;
  double min = peak;
  int where = start;
  for (int b = start; b >= 0 && b < bins_; b += direction) {
    if (count(b) < min) min = count(b), where = b;
    if (where == start) continue;
    const double chance = kSure * std::sqrt((min + 1) / window_);
    if (count(b) > min + kPeakFraction * peak + chance) return std::abs(centre(where) - height);
  }
  return 2 * half_range_;
}

}  // namespace remote_touch
