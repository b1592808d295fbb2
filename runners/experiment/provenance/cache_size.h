// The size of the cache folder, which is bounded: tools of many variants of a mesh would fill the disk.
#pragma once

#include <cstdint>
#include <filesystem>

namespace remote_touch {

struct CacheSize {
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

// Returns the maximum size of the cache folder: the environment variable REMOTE_TOUCH_CACHE_MB, or 512 MB if
// it is not set. Throws InputError if it is not a number of megabytes.
std::uintmax_t max_cache_bytes();

CacheSize cache_size(const std::filesystem::path& folder);

// Removes temporary files of programs that were killed while they wrote them, if they were not used for an
// hour.
void remove_abandoned(const std::filesystem::path& folder);

// Removes these temporary files, and then the cache files that were used longest ago, until their size is at
// most max_bytes. Other files are kept. Returns the number and size of the cache files that are left.
CacheSize shrink_cache(const std::filesystem::path& folder, std::uintmax_t max_bytes);

}  // namespace remote_touch
