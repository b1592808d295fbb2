#include "runners/experiment/provenance/cache_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string_view>

#include "runners/experiment/provenance/cache_size.h"
#include "runners/experiment/provenance/provenance.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kHash = 64;

std::string first_line(const CacheKind& kind) {
  return "remote-touch-" + kind.name + "/" + std::to_string(kind.version) + "\n";
}

// The bytes of a file, mapped rather than read: large tools are in memory once only.
class MappedFile {
 public:
  MappedFile(const fs::path& path, std::size_t max_bytes) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    struct stat about {};
    if (::fstat(file, &about) == 0 && S_ISREG(about.st_mode) && about.st_size > 0 &&
        (max_bytes == 0 || static_cast<std::size_t>(about.st_size) <= max_bytes)) {
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
  const MappedFile file(path, kind.max_bytes);
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
  if (good && kind.max_bytes == 0) shrink_cache(folder, max_cache_bytes());
  if (good && kind.max_bytes > 0) remove_abandoned(folder);
  return good;
}

}  // namespace remote_touch
