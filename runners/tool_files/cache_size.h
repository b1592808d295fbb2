// The size of the cache folder, which is bounded: tools of many variants of a mesh would fill the disk.
#pragma once

#include <cstdint>
#include <filesystem>

namespace remote_touch {

struct CacheSize {
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

CacheSize cache_size(const std::filesystem::path& folder);

// Removes the files that were used longest ago, until so many bytes are left at most; also what killed
// programs left half written an hour ago or earlier. Files of other kinds stay. Returns what is left.
CacheSize shrink_cache(const std::filesystem::path& folder, std::uintmax_t max_bytes);

}  // namespace remote_touch
