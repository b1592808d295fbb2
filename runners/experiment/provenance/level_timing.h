// The speeds of the kernel levels on this processor, and the choice of a level. A higher level is not always
// faster: AVX-512 makes some processors no faster, or even slower.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"

namespace remote_touch {

// Some ten microseconds of work with given kernels.
struct KernelTask {
  std::string name;
  std::function<void(const Kernels&)> run;
};

// One time for each level, in rising order of the levels, s: the geometric mean, over the tasks, of the
// shortest time of a task.
using LevelTimes = std::vector<double>;

// Measures the tasks with all levels until max_s have passed; each is run three times at least, 20 times at
// most. Levels and tasks take turns, so that a disturbance of the machine affects all of them. now_s: a
// clock, in s, that does not go back.
LevelTimes time_levels(std::span<const Kernels* const> levels, std::span<const KernelTask> tasks,
                       const std::function<double()>& now_s, double max_s);

// The factor by which a higher level must be faster to be preferred to a lower one: about the scatter of the
// measurement. At equal times the lower one is better, because wide vectors can slow down the code around
// them.
inline constexpr double kClearlyFaster = 1.03;

// Returns the index of the level to use. pre: times is not empty.
std::size_t fastest_level(const LevelTimes& times);

}  // namespace remote_touch
