#include "runners/live/loop/samples.h"

#include "analysis/statistics/means_and_extremes.h"

namespace remote_touch {

void Samples::push_back(double value) {
  least_ = count_ == 0 ? value : min_or_nan(least_, value);
  greatest_ = count_ == 0 ? value : max_or_nan(greatest_, value);
  if (count_++ % stride_ != 0) return;
  if (kept_.size() == kMax) {
    for (std::size_t i = 0; i < kMax / 2; ++i) kept_[i] = kept_[2 * i];
    kept_.resize(kMax / 2);
    stride_ *= 2;
  }
  kept_.push_back(value);
}

void GreatestOfPieces::push_back(double time_s, double value) {
  if (in_last_ == 0 || in_last_ == length_) {
    if (begin_s_.size() == 2 * kPieces) join_pairs();
    begin_s_.push_back(time_s), greatest_.push_back(value);
    in_last_ = 0;
  }
  greatest_.back() = max_or_nan(greatest_.back(), value);
  ++in_last_;
}

void GreatestOfPieces::join_pairs() {
  for (std::size_t i = 0; i < kPieces; ++i) {
    begin_s_[i] = begin_s_[2 * i];
    greatest_[i] = max_or_nan(greatest_[2 * i], greatest_[2 * i + 1]);
  }
  begin_s_.resize(kPieces), greatest_.resize(kPieces);
  length_ *= 2;
}

}  // namespace remote_touch
