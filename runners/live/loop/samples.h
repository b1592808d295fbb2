// Times of a run of any length, in bounded memory.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace remote_touch {

// Keeps all samples while there are at most kMax. When there are more, it keeps every second one, then every
// fourth, and so on, evenly over the run. size(), least() and greatest() are those of all samples.
class Samples {
 public:
  static constexpr std::size_t kMax = 1 << 20;  // 8 MB; 17 minutes at 1 kHz until the first is left out

  void push_back(double value);
  std::size_t size() const { return count_; }  // number of all samples
  double least() const { return least_; }
  double greatest() const { return greatest_; }
  const std::vector<double>& kept() const { return kept_; }
  double operator[](std::size_t i) const { return kept_[i]; }

 private:
  std::vector<double> kept_;
  std::size_t count_ = 0, stride_ = 1;
  double least_ = std::numeric_limits<double>::quiet_NaN(), greatest_ = least_;
};

// The greatest value of each piece of a run. Any run has at most 2 kPieces pieces, with equal numbers of
// values.
class GreatestOfPieces {
 public:
  static constexpr std::size_t kPieces = 1000;

  void push_back(double time_s, double value);
  const std::vector<double>& begin_s() const { return begin_s_; }
  const std::vector<double>& greatest() const { return greatest_; }

 private:
  void join_pairs();
  std::vector<double> begin_s_, greatest_;
  std::size_t length_ = 1, in_last_ = 0;
};

}  // namespace remote_touch
