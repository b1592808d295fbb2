#include "runners/experiment/provenance/cache_size.h"

#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <string>
#include <system_error>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kNs_per_s = 1'000'000'000;

struct CachedFile {
  fs::path path;
  std::uintmax_t bytes = 0;
  std::int64_t used_ns = 0;  // since 1970: the time of access, which the reader sets
};

bool is_ours(const fs::path& file) {
  return file.extension() == ".tool" || file.extension() == ".spheres" || file.extension() == ".levels";
}

bool is_abandoned(const CachedFile& file) {
  return file.path.filename().string().find(".partial-") != std::string::npos &&
         std::time(nullptr) - file.used_ns / kNs_per_s > 3600;
}

// Returns the regular files of the folder. A file that another process removes at the same time is left out.
std::vector<CachedFile> files_in(const fs::path& folder) {
  std::vector<CachedFile> files;
  std::error_code unreachable;
  // An iterator that cannot be incremented becomes the end. A range-based for would throw.
  for (fs::directory_iterator entry(folder, unreachable), end; entry != end; entry.increment(unreachable)) {
    struct stat about {};
    if (::stat(entry->path().c_str(), &about) == 0 && S_ISREG(about.st_mode))
      files.push_back({entry->path(), static_cast<std::uintmax_t>(about.st_size),
                       kNs_per_s * about.st_atim.tv_sec + about.st_atim.tv_nsec});
  }
  return files;
}

bool removed(const CachedFile& file) {
  std::error_code refused;
  return fs::remove(file.path, refused);
}

void remove_abandoned(const std::vector<CachedFile>& files) {
  for (const CachedFile& file : files)
    if (is_abandoned(file)) removed(file);
}

}  // namespace

std::uintmax_t max_cache_bytes() {
  constexpr double kDefault_MB = 512, kBytes_per_MB = 1e6, kMax_MB = 1e9;
  const char* const set = std::getenv("REMOTE_TOUCH_CACHE_MB");
  if (set == nullptr || *set == '\0') return static_cast<std::uintmax_t>(kDefault_MB * kBytes_per_MB);
  const std::string text = set;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= kMax_MB))
    throw InputError("REMOTE_TOUCH_CACHE_MB = " + text, "expected a number of megabytes");
  return static_cast<std::uintmax_t>(value * kBytes_per_MB);
}

CacheSize cache_size(const fs::path& folder) {
  CacheSize size;
  for (const CachedFile& file : files_in(folder))
    if (is_ours(file.path)) ++size.files, size.bytes += file.bytes;
  return size;
}

void remove_abandoned(const fs::path& folder) {
  remove_abandoned(files_in(folder));
}

CacheSize shrink_cache(const fs::path& folder, std::uintmax_t max_bytes) {
  std::vector<CachedFile> files = files_in(folder);
  remove_abandoned(files);
  std::erase_if(files, [](const CachedFile& file) { return !is_ours(file.path); });
  std::ranges::sort(files, [](const CachedFile& a, const CachedFile& b) { return a.used_ns < b.used_ns; });
  CacheSize left{files.size(), 0};
  for (const CachedFile& file : files) left.bytes += file.bytes;
  for (const CachedFile& file : files) {
    if (left.bytes <= max_bytes) break;
    if (removed(file)) --left.files, left.bytes -= file.bytes;
  }
  return left;
}

}  // namespace remote_touch
