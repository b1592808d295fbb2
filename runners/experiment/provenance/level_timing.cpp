#include "runners/experiment/provenance/level_timing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

constexpr int kMinRounds = 3, kMaxRounds = 20;
constexpr double kShortest_s = 1e-9;  // used if the clock did not advance, to keep the logarithm finite

double geometric_mean(const std::vector<double>& times_s) {
  double sum = 0;
  for (const double time_s : times_s) sum += std::log(std::max(time_s, kShortest_s));
  return std::exp(sum / static_cast<double>(times_s.size()));
}

}  // namespace

LevelTimes time_levels(std::span<const Kernels* const> levels, std::span<const KernelTask> tasks,
                       const std::function<double()>& now_s, double max_s) {
  const std::vector<double> unknown(tasks.size(), std::numeric_limits<double>::infinity());
  std::vector<std::vector<double>> least_s(levels.size(), unknown);
  const double start_s = now_s();
  for (int round = 0; round < kMaxRounds; ++round) {
    if (round >= kMinRounds && now_s() - start_s >= max_s) break;
    for (std::size_t t = 0; t < tasks.size(); ++t)
      for (std::size_t l = 0; l < levels.size(); ++l) {
        const double before_s = now_s();
        tasks[t].run(*levels[l]);
        least_s[l][t] = std::min(least_s[l][t], now_s() - before_s);
      }
  }
  LevelTimes times;
  for (const std::vector<double>& of_tasks : least_s) times.push_back(geometric_mean(of_tasks));
  return times;
}

std::size_t fastest_level(const LevelTimes& times) {
  std::size_t chosen = 0;
  for (std::size_t level = 1; level < times.size(); ++level)
    if (times[level] * kClearlyFaster <= times[chosen]) chosen = level;
  return chosen;
}

}  // namespace remote_touch
