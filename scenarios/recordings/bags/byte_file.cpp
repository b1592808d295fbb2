#include "scenarios/recordings/bags/byte_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {

ByteFile::ByteFile(const std::filesystem::path& file) : name_(file.string()) {
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor_ >= 0) ::close(descriptor_);
    refuse(name_, "cannot be opened: ", why);
  }
  if (!S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    refuse(name_, "is not a file: expected a bag");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

ByteFile::~ByteFile() {
  ::close(descriptor_);
}

std::string ByteFile::bytes(std::uint64_t at, std::uint64_t size) const {
  if (!has(at, size)) refuse(name_, "ends at byte ", size_, ": expected ", size, " bytes at ", at);
  std::string result(size, '\0');
  read(at, result.data(), result.size());
  return result;
}

void ByteFile::read(std::uint64_t at, char* to, std::size_t size) const {
  while (size > 0) {
    const ssize_t got = ::pread(descriptor_, to, size, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(name_, "cannot be read: ", std::strerror(errno));
    if (got == 0) refuse(name_, "ends while it is read");
    at += static_cast<std::uint64_t>(got), to += got, size -= static_cast<std::size_t>(got);
  }
}

std::uint32_t ByteFile::crc(std::uint64_t at, std::uint64_t end) const {
  uLong crc = 0;
  for (std::string piece; at < end; at += piece.size()) {
    piece = bytes(at, std::min<std::uint64_t>(1u << 20, end - at));
    crc = crc32_z(crc, reinterpret_cast<const unsigned char*>(piece.data()), piece.size());
  }
  return static_cast<std::uint32_t>(crc);
}

}  // namespace remote_touch
