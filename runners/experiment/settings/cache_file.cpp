#include "runners/experiment/settings/cache_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"

namespace remote_touch {

namespace fs = std::filesystem;

// The environment is read here and not in runners/interfaces/cli. A cache is not an input, so no result
// depends on it, and every program that makes tools, also a test, must find the same one.
fs::path cache_folder() {
  const auto from = [](const char* variable) {
    const char* value = std::getenv(variable);
    return fs::path(value != nullptr ? value : "");
  };
  if (const fs::path own = from("REMOTE_TOUCH_CACHE"); !own.empty()) return own;
  if (const fs::path caches = from("XDG_CACHE_HOME"); !caches.empty()) return caches / "remote-touch";
  if (const fs::path home = from("HOME"); !home.empty()) return home / ".cache" / "remote-touch";
  return {};
}

namespace {

constexpr std::int64_t kNs_per_s = 1'000'000'000;

struct CachedFile {
  fs::path path;
  std::uintmax_t bytes = 0;
  std::int64_t used_ns = 0;  // since 1970: the time of access, which the reader sets
};

bool is_ours(const fs::path& file) {
  return file.extension() == ".tool" || file.extension() == ".spheres";
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

constexpr std::size_t kHash = 64;

std::string first_line(const CacheKind& kind) {
  return "remote-touch-" + kind.name + "/" + std::to_string(kind.version) + "\n";
}

// The bytes of a file, mapped rather than read: large tools are in memory once only.
class MappedFile {
 public:
  explicit MappedFile(const fs::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    struct stat about {};
    if (::fstat(file, &about) == 0 && S_ISREG(about.st_mode) && about.st_size > 0) {
      size_ = static_cast<std::size_t>(about.st_size);
      data_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file, 0);
      if (data_ == MAP_FAILED) data_ = nullptr, size_ = 0;
    }
    ::close(file);
  }
  ~MappedFile() {
    if (data_ != nullptr) ::munmap(data_, size_);
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return {static_cast<const char*>(data_), size_}; }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

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

CacheSize shrink_cache(const fs::path& folder, std::uintmax_t max_bytes) {
  std::vector<CachedFile> files = files_in(folder);
  for (const CachedFile& file : files)
    if (is_abandoned(file)) removed(file);
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

void CacheWriter::bytes(const void* data, std::size_t size) {
  hash_.add(data, size);
  write(static_cast<const char*>(data), size);
}

void CacheWriter::end_with_hash() {
  const std::string end = hex();
  write(end.data(), end.size());
}

void CacheWriter::write(const char* data, std::size_t size) {
  while (good_ && file_ >= 0 && size > 0) {
    const ssize_t part = ::write(file_, data, size);
    if (part < 0 && errno == EINTR) continue;
    good_ = part > 0;
    if (good_) data += part, size -= static_cast<std::size_t>(part);
  }
}

std::string build_for_keys() {
  std::string text;
  for (const auto& [name, value] : provenance("", "", ""))
    if (name == "version" || name == "source_digest" || name == "compiler" || name == "flags")
      text += name + " " + value + "\n";
  return text;
}

bool read_cache_file(const fs::path& folder, const CacheKind& kind, const std::string& key,
                     const std::function<void(Unpacker&)>& take) {
  if (folder.empty()) return false;
  const fs::path path = folder / (key + "." + kind.name);
  const MappedFile file(path);
  const std::string_view bytes = file.bytes();
  const std::string line = first_line(kind);
  if (bytes.size() < line.size() + kHash || !bytes.starts_with(line)) return false;
  const std::string_view content = bytes.substr(0, bytes.size() - kHash);
  Sha256 hash;
  hash.add(content.data(), content.size());
  if (hash.hex() != bytes.substr(content.size())) return false;
  Unpacker unpack(content.data() + line.size(), content.data() + content.size());
  std::string stored_key;
  unpack.text(stored_key);
  if (stored_key != key) return false;
  take(unpack);
  const bool good = unpack.done();
  const timespec used_now[] = {{0, UTIME_NOW}, {0, UTIME_OMIT}};  // the oldest are removed first
  if (good) ::utimensat(AT_FDCWD, path.c_str(), used_now, 0);
  return good;
}

bool write_cache_file(const fs::path& folder, const CacheKind& kind, const std::string& key,
                      const std::function<void(CacheWriter&)>& put) {
  if (folder.empty()) return false;
  std::error_code failure;  // mkstemp() then fails too
  fs::create_directories(folder, failure);
  // Each writer has a name of its own, because threads of one process may write the same file.
  std::string temporary = (folder / (key + ".partial-XXXXXX")).string();
  const int file = ::mkstemp(temporary.data());
  if (file < 0) return false;
  CacheWriter pack(file);
  try {
    const std::string line = first_line(kind);
    pack.bytes(line.data(), line.size());
    pack.text(key);
    put(pack);
    pack.end_with_hash();
  } catch (...) {
    ::close(file);
    ::unlink(temporary.c_str());
    throw;
  }
  // The file is not flushed to the disk: if a power cut leaves a part of it, the check of its hash fails.
  bool good = ::close(file) == 0 && pack.good();
  good = good && ::rename(temporary.c_str(), (folder / (key + "." + kind.name)).c_str()) == 0;
  if (!good) ::unlink(temporary.c_str());
  if (good) shrink_cache(folder, max_cache_bytes());
  return good;
}

}  // namespace remote_touch
