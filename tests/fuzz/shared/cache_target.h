// Cache files: the bytes after their first line and key, as they are or with the hash that makes them valid.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz {

inline constexpr const char* kCacheKey = "key";

// Returns the folder of KEY.KIND. If the first byte is 'r', the rest is the whole file; otherwise the rest is
// its fields.
std::filesystem::path cache_folder(const std::string& kind, int version, std::string_view bytes);
std::string cache_bytes(const std::filesystem::path& folder, const std::string& kind);

// Requires that write() leaves the cache file as it was read.
template <class Write>
void require_written_as_read(const std::filesystem::path& folder, const std::string& kind, Write write) {
  const std::string before = cache_bytes(folder, kind);
  write();
  require(cache_bytes(folder, kind) == before, "a cache file is written as it was read");
}

}  // namespace remote_touch::fuzz
