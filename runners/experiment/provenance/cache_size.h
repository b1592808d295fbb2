// The size of the cache folder, which is bounded: tools of many variants of a mesh would fill the disk.
#pragma once

#include <cstdint>
#include <filesystem>

namespace remote_touch {

struct CacheSize {
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

// The greatest size of the cache folder: the environment variable REMOTE_TOUCH_CACHE_MB, else 512 MB. Throws
// InputError.
std::uintmax_t max_cache_bytes();

CacheSize cache_size(const std::filesystem::path& folder);

// Removes what killed programs left half written an hour ago or earlier.
void remove_abandoned(const std::filesystem::path& folder);

// The same, then the files that were used longest ago, until so many bytes are left at most. Files of other
// kinds stay. Returns what is left.
CacheSize shrink_cache(const std::filesystem::path& folder, std::uintmax_t max_bytes);

}  // namespace remote_touch
