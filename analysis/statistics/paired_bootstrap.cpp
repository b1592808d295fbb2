#include "analysis/statistics/paired_bootstrap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/numeric/noise.h"

namespace remote_touch {

namespace {

// Random whole numbers below a limit. The streams of simulations encode their purpose in the upper bits of
// the first word of the counter. Here all of its bits are set, which no stream of a simulation has.
class Choices {
 public:
  Choices(std::uint64_t key, int draw)
      : stream_{{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)},
                {0xFFFFFFFFu, static_cast<std::uint32_t>(draw), 0}} {}
  std::size_t below(std::size_t count) {
    if (next_ == words_.size()) words_ = uniforms(stream_, point_++), next_ = 0;
    const double fraction = words_[next_++];  // uniform in (0, 1)
    return std::min(count - 1, static_cast<std::size_t>(fraction * static_cast<double>(count)));
  }

 private:
  NoiseStream stream_;
  std::uint32_t point_ = 0;
  std::array<double, 4> words_{};
  std::size_t next_ = 4;
};

// Quantile of sorted values: the value that this fraction of them lies below, interpolated between
// neighbours.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), sorted.size() - 1);
  const double above = sorted[std::min(i + 1, sorted.size() - 1)];
  return sorted[i] + (place - static_cast<double>(i)) * (above - sorted[i]);
}

double drawn_mean(const std::vector<std::vector<double>>& groups, Choices choices, double pairs) {
  double sum = 0;
  for (const std::vector<double>& group : groups)
    for (std::size_t i = 0; i < group.size(); ++i) sum += group[choices.below(group.size())];
  return sum / pairs;
}

}  // namespace

MeanDifference bootstrap_mean(const std::vector<std::vector<double>>& differences, std::uint64_t key,
                              int draws) {
  std::vector<std::vector<double>> groups;
  double sum = 0;
  std::int64_t count = 0;
  for (const std::vector<double>& all : differences) {
    groups.emplace_back();
    for (const double d : all)
      if (!std::isnan(d)) groups.back().push_back(d), sum += d, ++count;
  }
  MeanDifference result = mean_of_sum(sum, count);
  if (count < 2 || draws < 1) return result;
  std::vector<double> means;
  for (int draw = 0; draw < draws; ++draw)
    means.push_back(drawn_mean(groups, Choices(key, draw), static_cast<double>(count)));
  std::sort(means.begin(), means.end());
  result.low = quantile(means, 0.025), result.high = quantile(means, 0.975);
  return result;
}

}  // namespace remote_touch
