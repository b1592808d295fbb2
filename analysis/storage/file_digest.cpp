#include "analysis/storage/file_digest.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "analysis/storage/sha256.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

std::string block(const std::string& sum) {
  std::string text = std::string(kResultOpening) + sum + "\n";
  text.resize(kDigestBlockSize, '\0');
  return text;
}

}  // namespace

std::vector<char> with_file_digest(const std::vector<char>& image) {
  Sha256 hash;
  hash.add(image.data(), image.size());
  const std::string text = block(hash.hex());
  std::vector<char> sealed;
  sealed.reserve(text.size() + image.size());
  sealed.insert(sealed.end(), text.begin(), text.end());
  sealed.insert(sealed.end(), image.begin(), image.end());
  return sealed;
}

void write_file_digest(const std::filesystem::path& file) {
  const std::string text = block(sha256_of_file(file, kDigestBlockSize));
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
  std::size_t found = 0;
  while (descriptor >= 0 && found < size) {
    const ssize_t part = ::read(descriptor, opening.data() + found, size - found);
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) break;
    found += static_cast<std::size_t>(part);
  }
  if (descriptor >= 0) ::close(descriptor);
  return opening;
}

bool has_result_header(const std::filesystem::path& file) {
  std::error_code unreachable;  // a pipe would lose what is read of it
  if (!std::filesystem::is_regular_file(file, unreachable)) return false;
  return opening_of(file, kResultOpening.size()) == kResultOpening;
}

FileDigest file_digest_of(const std::filesystem::path& file) {
  const std::string found = opening_of(file, kDigestBlockSize);
  if (!found.starts_with(kResultOpening)) return FileDigest::absent;
  return found == block(sha256_of_file(file, kDigestBlockSize)) ? FileDigest::valid : FileDigest::broken;
}

}  // namespace remote_touch
