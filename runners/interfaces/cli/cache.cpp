#include <cstdio>

#include "core/kernels/isa.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/cache_file.h"
#include "runners/experiment/provenance/kernel_choice.h"
#include "runners/interfaces/cli/commands.h"

namespace remote_touch {

namespace {

// Prints the instruction set in use and the measured speeds. Prints nothing if the speeds were not measured:
// the processor has one level only, or the level was always forced.
void print_level_times(const std::filesystem::path& folder, const Kernels& in_use) {
  const auto times = read_level_times(folder, level_times_key(), supported_kernels().size());
  if (times)
    std::printf("instruction set of the inner loops: %s in use; speed as measured: %s\n", in_use.isa,
                speeds_text(*times).c_str());
}

}  // namespace

int command_cache(const CommandLine& line, const CacheRequest& request) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty())
    throw InputError("REMOTE_TOUCH_CACHE", "is not set, nor is HOME: expected a folder for the cache");
  constexpr double kBytes_per_MB = 1e6;
  const CacheSize size =
      request.max_MB ? shrink_cache(folder, static_cast<std::uintmax_t>(*request.max_MB * kBytes_per_MB))
                     : cache_size(folder);
  std::printf("%s: %zu files, %.1f MB; the maximum is %.1f MB\n", folder.c_str(), size.files,
              static_cast<double>(size.bytes) / kBytes_per_MB,
              static_cast<double>(max_cache_bytes()) / kBytes_per_MB);
  print_level_times(folder, *line.kernels);
  return kDone;
}

}  // namespace remote_touch
