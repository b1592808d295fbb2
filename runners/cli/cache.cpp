#include <cstdio>

#include "core/parameters/input_error.h"
#include "runners/cache/cache_folder.h"
#include "runners/cache/cache_size.h"
#include "runners/cli/commands.h"

namespace remote_touch {

int command_cache(const CommandLine&, const CacheRequest& request) {
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
  return kDone;
}

}  // namespace remote_touch
