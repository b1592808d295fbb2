// The measured times of the kernels' levels in the cache. A file that is read is sound, and is written as it
// was.
#include <cmath>

#include "runners/experiment/provenance/kernel_choice.h"
#include "tests/fuzz/shared/cache_target.h"

namespace remote_touch::fuzz::level_times {
namespace {

void read(std::string_view bytes) {
  constexpr std::size_t kLevels = 3;
  const auto folder = cache_folder("levels", kLevelTimesFormat, bytes);
  const auto times = read_level_times(folder, kCacheKey, kLevels);
  if (!times) return;
  require(times->size() == kLevels, "each level has a time");
  for (const double time_s : *times) require(std::isfinite(time_s) && time_s > 0, "a time is positive");
  require(fastest_level(*times) < kLevels, "the choice is one of them");
  require_written_as_read(folder, "levels", [&] { write_level_times(folder, kCacheKey, *times); });
}

const Registered registered("level_times", read);

}  // namespace
}  // namespace remote_touch::fuzz::level_times
