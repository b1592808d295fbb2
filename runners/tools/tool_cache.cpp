#include "runners/tools/tool_cache.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "analysis/sha256.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

// The file is a line "remote-touch-tool/1\n", the key and the fields below as they are in memory (it never
// leaves the machine), and the SHA-256 of all that.
constexpr std::size_t kHash = 64;
const std::string kMagic = "remote-touch-tool/" + std::to_string(kToolFormat) + "\n";

// Values one after the other, into a hash and into a file where there is one.
class Packing {
 public:
  explicit Packing(int file = -1) : file_(file) {}
  bool good() const { return good_; }
  void bytes(const void* data, std::size_t size) {
    hash_.add(data, size);
    write(static_cast<const char*>(data), size);
  }
  template <class Value>
  void value(const Value& v) {
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    bytes(&v, sizeof v);
  }
  template <class Value>
  void list(const std::vector<Value>& values) {
    value(values.size());
    bytes(values.data(), values.size() * sizeof(Value));
  }
  void text(const std::string& t) {
    value(t.size());
    bytes(t.data(), t.size());
  }
  std::string hex() { return hash_.hex(); }
  void end_with_hash() {
    const std::string end = hex();
    write(end.data(), end.size());
  }

 private:
  void write(const char* data, std::size_t size) {
    while (good_ && file_ >= 0 && size > 0) {
      const ssize_t part = ::write(file_, data, size);
      if (part < 0 && errno == EINTR) continue;
      good_ = part > 0;
      if (good_) data += part, size -= static_cast<std::size_t>(part);
    }
  }

  int file_;
  bool good_ = true;
  Sha256 hash_;
};

// Takes from bytes; once something is missing, good() is false and all that follows stays as it was.
class Unpacking {
 public:
  Unpacking(const char* begin, const char* end) : at_(begin), end_(end) {}
  bool done() const { return good_ && at_ == end_; }
  template <class Value>
  void value(Value& v) {
    if (has(1, sizeof v)) std::memcpy(&v, at_, sizeof v), at_ += sizeof v;
  }
  template <class Value>
  void list(std::vector<Value>& values) {
    std::size_t count = 0;
    value(count);
    if (!has(count, sizeof(Value))) return;
    values.resize(count);
    std::memcpy(static_cast<void*>(values.data()), at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
  }
  void text(std::string& t) {
    std::size_t count = 0;
    value(count);
    if (has(count, 1)) t.assign(at_, count), at_ += count;
  }

 private:
  bool has(std::size_t count, std::size_t size) {
    good_ = good_ && count <= static_cast<std::size_t>(end_ - at_) / size;
    return good_;
  }
  const char *at_, *end_;
  bool good_ = true;
};

static_assert(sizeof(Vec3) == 3 * sizeof(double));  // lists of vectors are lists of numbers

// Every field, in order, for both directions.
template <class Direction, class Stored>
void visit(Direction& pack, Stored& stored) {
  auto& tool = stored.tool;
  pack.list(tool.mesh.vertices);
  pack.list(tool.mesh.triangles);
  for (int i = 0; i < 3; ++i) pack.value(tool.grid.origin_T[i]), pack.value(tool.grid.cells[i]);
  pack.value(tool.grid.size_m);
  pack.list(tool.voxels);
  pack.list(tool.distance_m);
  pack.value(tool.volume_m3);
  for (int i = 0; i < 9; ++i) pack.value(tool.inertia_m2(i / 3, i % 3));
  pack.value(tool.reach_m);
  pack.text(stored.report);
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

fs::path tool_cache_folder() {
  const auto from = [](const char* variable) {
    const char* value = std::getenv(variable);
    return fs::path(value != nullptr ? value : "");
  };
  if (const fs::path own = from("REMOTE_TOUCH_CACHE"); !own.empty()) return own;
  if (const fs::path caches = from("XDG_CACHE_HOME"); !caches.empty()) return caches / "remote-touch";
  if (const fs::path home = from("HOME"); !home.empty()) return home / ".cache" / "remote-touch";
  return {};
}

std::string sha256_of_mesh(const TriangleMesh& mesh) {
  Packing pack;
  pack.list(mesh.vertices);
  pack.list(mesh.triangles);
  return pack.hex();
}

std::string tool_key(const std::string& mesh_sha256, const VoxelToolSettings& settings) {
  Packing pack;
  pack.value(kToolFormat);
  pack.text(mesh_sha256);
  pack.value(settings.voxel_m), pack.value(settings.size_m), pack.value(settings.repair);
  return pack.hex();
}

std::optional<StoredTool> read_tool(const fs::path& folder, const std::string& key) {
  if (folder.empty()) return {};
  const MappedFile file(folder / (key + ".tool"));
  const std::string_view bytes = file.bytes();
  if (bytes.size() < kMagic.size() + kHash || !bytes.starts_with(kMagic)) return {};
  const std::string_view content = bytes.substr(0, bytes.size() - kHash);
  Sha256 hash;
  hash.add(content.data(), content.size());
  if (hash.hex() != bytes.substr(content.size())) return {};
  Unpacking unpack(content.data() + kMagic.size(), content.data() + content.size());
  std::string stored_key;
  unpack.text(stored_key);
  StoredTool stored;
  visit(unpack, stored);
  const VoxelGrid& grid = stored.tool.grid;
  if (!unpack.done() || stored_key != key || stored.tool.voxels.size() != grid.cell_count() ||
      stored.tool.distance_m.size() != grid.node_count())
    return {};
  return stored;
}

bool write_tool(const fs::path& folder, const std::string& key, const StoredTool& stored) {
  if (folder.empty()) return false;
  std::error_code failure;  // then no file can be made there either
  fs::create_directories(folder, failure);
  // A name for each writer: threads of one process make the same tool too.
  std::string temporary = (folder / (key + ".partial-XXXXXX")).string();
  const int file = ::mkstemp(temporary.data());
  if (file < 0) return false;
  Packing pack(file);
  pack.bytes(kMagic.data(), kMagic.size());
  pack.text(key);
  visit(pack, stored);
  pack.end_with_hash();
  // No flush to the disk: what a power cut leaves fails the check of its hash.
  bool good = ::close(file) == 0 && pack.good();
  good = good && ::rename(temporary.c_str(), (folder / (key + ".tool")).c_str()) == 0;
  if (!good) ::unlink(temporary.c_str());
  return good;
}

}  // namespace remote_touch
