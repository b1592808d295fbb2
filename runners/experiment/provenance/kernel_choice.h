// The x86-64 level of the kernels, chosen where a program starts. All levels give the same bits, so no result
// depends on the choice.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/kernels/kernels.h"
#include "runners/experiment/provenance/level_timing.h"

namespace remote_touch {

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
