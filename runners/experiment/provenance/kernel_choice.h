// The x86-64 level of the kernels, chosen where a program starts. All levels give the same bits, so no result
// depends on the choice.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"

namespace remote_touch {

// The speeds of the kernel levels on this processor, and the choice of a level. A higher level is not always
// faster: AVX-512 makes some processors no faster, or even slower.

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

// Small pieces of the work that takes most time: steps of the proxy, noise, disks of a tool, and two rows of
// the depth pipeline.

// Returns the tasks. Their inputs are made once. The tasks share nothing and write to memory of their own.
std::vector<KernelTask> representative_tasks();

// Measures all levels that this machine has. This takes about 6 ms, and 10 ms on a slow machine.
LevelTimes time_supported_levels();

// Returns the kernels of the level `forced` or, if that is empty, of the fastest level. The times are read
// from the cache folder; if it has none, they are measured now and stored there. A cache that cannot be used
// is no error. Throws InputError if the machine does not have the forced level.
const Kernels& choose_kernels(const std::string& forced, const std::filesystem::path& cache_folder,
                              const std::function<LevelTimes()>& measure = time_supported_levels);

// Returns the key of the times in the cache: a hash of all that they depend on. This is the processor, as it
// identifies itself, and version, sources, compiler and flags of this program.
std::string level_times_key();

// Returns nothing if the folder has no such file, or if it is damaged or has another number of levels.
std::optional<LevelTimes> read_level_times(const std::filesystem::path& folder, const std::string& key,
                                           std::size_t levels);
// Returns false if the file cannot be written, which is not an error.
bool write_level_times(const std::filesystem::path& folder, const std::string& key, const LevelTimes& times);

// Returns the speed of each level relative to the lowest level, such as "x86-64 1.00, x86-64-v3 2.31". pre:
// there are as many times as this machine has levels.
std::string speeds_text(const LevelTimes& times);

inline constexpr int kLevelTimesFormat = 1;  // raise it when the tasks change

}  // namespace remote_touch
