#include "analysis/storage/file_digest.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/sha256.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

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
