// How fast the levels of the kernels are on this processor, and which one is chosen. A higher level is not
// always faster: some processors gain nothing by AVX-512, or lose.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"

namespace remote_touch {

// Some ten microseconds of work with the kernels that are given.
struct KernelTask {
  std::string name;
  std::function<void(const Kernels&)> run;
};

// Of each level, in rising order: the geometric mean over the tasks of the least time of one, s.
using LevelTimes = std::vector<double>;

// Levels and tasks take turns, so that what disturbs the machine disturbs all of them, until max_s have
// passed (each is run three times at least, 20 times at most). now_s: a clock, in s, that does not go back.
LevelTimes time_levels(std::span<const Kernels* const> levels, std::span<const KernelTask> tasks,
                       const std::function<double()>& now_s, double max_s);

// A higher level has to be so much faster to be preferred to a lower one: about the scatter of the
// measurement. With equal times the lower one is better, since wide vectors can slow down what is around
// them.
inline constexpr double kClearlyFaster = 1.03;

// The number of the level to use. pre: times is not empty.
std::size_t fastest_level(const LevelTimes& times);

}  // namespace remote_touch
