// Histogram of the heights of a patch's points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace remote_touch {

// Counts in bins of a tenth of a contact radius, symmetric about height 0.
class HeightProfile {
 public:
  static constexpr double kBin = 0.1;
  static constexpr double kMaxRange = 51.2;

  explicit HeightProfile(double half_range = 0) { clear(half_range); }
  void clear(double half_range);
  void add(double height) {
    const double bin = (height + half_range_) / kBin;
    if (bin >= 0 && bin < bins_) count_[static_cast<std::size_t>(bin)] += 1;  // false for NaN
  }

  // Adds points, given by the indices of their bins. The index bins() means that a point is in no bin.
  void add_bins(const std::int32_t* bin, std::size_t number);

  int bins() const { return bins_; }
  double half_range() const { return half_range_; }
  double centre(int bin) const { return (bin + 0.5) * kBin - half_range_; }
  double count(int bin) const { return count_[static_cast<std::size_t>(bin)]; }
  double max() const;

  // Returns the profile smoothed with a triangle of about this standard deviation.
  HeightProfile smoothed(double sigma) const;
  // Returns the distance, at most reach in either direction, by which the other profile must be moved down to
  // agree best with this one, that is with the largest sum of products. If several distances are nearly as
  // good, it is the smallest of them.
  double shift_of(const HeightProfile& other, double reach) const;
  // Returns the distance from a height, upwards (1) or downwards (-1), to the border of another sheet: the
  // bottom of a valley that chance does not explain. Returns 2 half_range() if there is none. pre: the
  // profile is smoothed.
  double valley_from(double height, int direction) const;

 private:
  double half_range_ = 0;
  double window_ = 1;  // number of bins over which a count is averaged
  int bins_ = 0;
  static constexpr int kMaxBins = 1024;
  std::array<double, kMaxBins + 1> count_;  // count of each bin; then the count of points in no bin
};

}  // namespace remote_touch
