// Uses deprecated functions of OpenSSL, because they allocate no memory. Their replacements load
// configurations and tables in each program (5000 allocations), and crash if one allocation fails.
#define OPENSSL_SUPPRESS_DEPRECATED
#include "analysis/storage/digest.h"

#include <fcntl.h>
#include <openssl/sha.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file) : file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (file_ < 0) refuse_reading(file, errno);
  }
  ~OpenFile() { ::close(file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  operator int() const { return file_; }

 private:
  int file_;
};

SHA256_CTX* context(const std::shared_ptr<void>& state) {
  return static_cast<SHA256_CTX*>(state.get());
}

}  // namespace

Sha256::Sha256() : state_(std::make_shared<SHA256_CTX>()) {
  SHA256_Init(context(state_));
}

void Sha256::add(const void* data, std::size_t size) {
  SHA256_Update(context(state_), data, size);
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> bytes{};
  SHA256_Final(bytes.data(), context(state_));
  std::string text;
  for (const unsigned char b : bytes) text += "0123456789abcdef"[b >> 4], text += "0123456789abcdef"[b & 15];
  return text;
}

ssize_t read_all(int descriptor, void* to, std::size_t size, off_t from) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t part =
        ::pread(descriptor, static_cast<char*>(to) + done, size - done, from + static_cast<off_t>(done));
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) return part < 0 ? -1 : static_cast<ssize_t>(done);
    done += static_cast<std::size_t>(part);
  }
  return static_cast<ssize_t>(size);
}

void refuse_reading(const std::filesystem::path& file, int error) {
  throw InputError(file.string(),
                   std::string("cannot be read (") + std::strerror(error) + "): expected a readable file");
}

std::string sha256_of_file(const std::filesystem::path& file, std::size_t from, std::string_view before) {
  std::vector<char> part(1 << 18);
  Sha256 hash;
  hash.add(before.data(), before.size());
  const OpenFile open(file);
  for (auto at = static_cast<off_t>(from);;) {
    const ssize_t size = read_all(open, part.data(), part.size(), at);
    if (size == 0) return hash.hex();
    if (size < 0) refuse_reading(file, errno);
    hash.add(part.data(), static_cast<std::size_t>(size));
    at += size;
  }
}

static_assert(std::endian::native == std::endian::little,
              "the digest hashes the bytes of the columns as they lie");

namespace {

template <class Number>
void add_values(Sha256& hash, const std::vector<Number>& numbers) {
  hash.add(numbers.data(), numbers.size() * sizeof(Number));
}

void add_values(Sha256& hash, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) hash.add(text.c_str(), text.size() + 1);
}

void begin_column(Sha256& hash, const std::string& name, int width) {
  hash.add(name.c_str(), name.size() + 1);
  hash.add(&width, sizeof width);
}

void add(Sha256& hash, const Values& values) {
  std::visit([&hash](const auto& v) { add_values(hash, v); }, values);
}

void add(Sha256& hash, const Column& column) {
  begin_column(hash, column.name, column.width);
  add(hash, column.values);
}

}  // namespace

ColumnDigest::ColumnDigest() : hash_(std::make_unique<Sha256>()) {}
ColumnDigest::~ColumnDigest() = default;

void ColumnDigest::begin(const std::string& name, int width) {
  begin_column(*hash_, name, width);
}

void ColumnDigest::add(const Values& values) {
  remote_touch::add(*hash_, values);
}

std::string ColumnDigest::text() {
  return hash_->hex();
}

std::string digest(const std::vector<Column>& columns) {
  Sha256 hash;
  for (const Column& column : columns) add(hash, column);
  return hash.hex();
}

std::string digest(const std::vector<Table>& tables) {
  Sha256 hash;
  for (const Table& table : tables) {
    hash.add(table.name.c_str(), table.name.size() + 1);
    for (const Column& column : table.columns) add(hash, column);
  }
  return hash.hex();
}

namespace {

std::string block(const std::string& sum) {
  std::string text = std::string(kResultOpening) + sum + "\n";
  text.resize(kSealBlockSize, '\0');
  return text;
}

// The beginning of an HDF5 file with addresses of 8 bytes, little-endian (HDF5 File Format Specification,
// II.A).
struct Superblock {
  static constexpr std::size_t kBase = 24, kEnd = 40, kSize = 48;
  std::string bytes;

  bool is_of_version_0() const { return bytes.starts_with("\x89HDF\r\n\x1a\n") && bytes[8] == 0; }
  std::uint64_t at(std::size_t place) const {
    std::uint64_t address = 0;
    std::memcpy(&address, bytes.data() + place, sizeof address);
    return address;
  }
  // Makes an address count from the start of the HDF5 part, as in an image without a user block.
  void move(std::size_t place) {
    const std::uint64_t address = at(place) - kSealBlockSize;
    std::memcpy(bytes.data() + place, &address, sizeof address);
  }
};

// Copies the bytes from an offset on. Returns 0, or the errno of the call that failed.
int copy_from(int from, off_t at, int to) {
  std::vector<char> buffer(1 << 20);
  std::size_t done = 0;
  for (;; at += static_cast<off_t>(done)) {
    const ssize_t size = read_all(from, buffer.data(), buffer.size(), at);
    if (size <= 0) return size < 0 ? errno : 0;
    if (const int error = write_all(to, buffer.data(), static_cast<std::size_t>(size), done); error != 0)
      return error;
  }
}

}  // namespace

std::vector<char> with_seal(const std::vector<char>& image) {
  Sha256 hash;
  hash.add(image.data(), image.size());
  const std::string text = block(hash.hex());
  std::vector<char> sealed;
  sealed.reserve(text.size() + image.size());
  sealed.insert(sealed.end(), text.begin(), text.end());
  sealed.insert(sealed.end(), image.begin(), image.end());
  return sealed;
}

void write_sealed_copy(const std::filesystem::path& image, const std::filesystem::path& sealed) {
  constexpr std::size_t kOpenMark = 20, kOpenMarkSize = 4;  // bytes of a superblock of version 0
  std::string opening = opening_of(image, kOpenMark + kOpenMarkSize);
  opening.replace(kOpenMark, kOpenMarkSize, kOpenMarkSize, '\0');
  const std::string head = block(sha256_of_file(image, opening.size(), opening)) + opening;
  const int from = ::open(image.c_str(), O_RDONLY | O_CLOEXEC);
  const int to = ::open(sealed.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  std::size_t done = 0;
  int error = from < 0 || to < 0 ? errno : write_all(to, head.data(), head.size(), done);
  if (error == 0) error = copy_from(from, static_cast<off_t>(opening.size()), to);
  if (from >= 0) ::close(from);
  if (to >= 0 && ::close(to) != 0 && error == 0) error = errno;
  if (error != 0) throw std::runtime_error(std::strerror(error));
}

void write_seal(const std::filesystem::path& file) {
  const std::string text = block(sha256_of_file(file, kSealBlockSize));
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  int error = descriptor < 0 ? errno : 0;
  if (error == 0) {
    const ssize_t written = ::pwrite(descriptor, text.data(), text.size(), 0);
    if (written != static_cast<ssize_t>(text.size())) error = written < 0 ? errno : ENOSPC;
    if (::close(descriptor) != 0 && error == 0) error = errno;
  }
  if (error != 0) throw std::runtime_error(std::strerror(error));
}

std::string opening_of(const std::filesystem::path& file, std::size_t size) {
  std::string opening(size, '\0');
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return opening;
  read_all(descriptor, opening.data(), size, 0);
  ::close(descriptor);
  return opening;
}

bool has_result_header(const std::filesystem::path& file) {
  std::error_code unreachable;  // reading a pipe would remove its data
  if (!std::filesystem::is_regular_file(file, unreachable)) return false;
  return opening_of(file, kResultOpening.size()) == kResultOpening;
}

SealState seal_state_of(const std::filesystem::path& file) {
  const std::string found = opening_of(file, kSealBlockSize);
  if (!found.starts_with(kResultOpening)) return SealState::absent;
  const bool is_as_written =
      found == block(sha256_of_file(file, kSealBlockSize)) || was_opened_for_writing(file);
  return is_as_written ? SealState::valid : SealState::broken;
}

bool was_opened_for_writing(const std::filesystem::path& file) {
  const std::string opening = opening_of(file, kSealBlockSize + Superblock::kSize);
  Superblock first{opening.substr(kSealBlockSize)};
  std::error_code unreachable;
  if (!first.is_of_version_0() || first.at(Superblock::kBase) != kSealBlockSize ||
      first.at(Superblock::kEnd) != std::filesystem::file_size(file, unreachable))
    return false;
  first.move(Superblock::kBase), first.move(Superblock::kEnd);
  const std::string sum = sha256_of_file(file, kSealBlockSize + Superblock::kSize, first.bytes);
  return opening.substr(0, kSealBlockSize) == block(sum);
}

}  // namespace remote_touch
