// Uses deprecated functions of OpenSSL, because they allocate no memory. Their replacements load
// configurations and tables in each program (5000 allocations), and crash if one allocation fails.
#define OPENSSL_SUPPRESS_DEPRECATED

#include "analysis/storage/sha256.h"

#include <fcntl.h>
#include <openssl/sha.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// Throws InputError with the error of the system, errno.
[[noreturn]] void refuse_unreadable(const std::filesystem::path& file) {
  throw InputError(file.string(),
                   std::string("cannot be read (") + std::strerror(errno) + "): expected a readable file");
}

class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file) : file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (file_ < 0) refuse_unreadable(file);
  }
  ~OpenFile() { ::close(file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  // Reads up to size bytes from the offset `at` on. Returns their number, 0 at the end, or -1 with errno set
  // if the file cannot be read.
  ssize_t read(char* to, std::size_t size, off_t at) const {
    ssize_t found;
    do {
      found = ::pread(file_, to, size, at);
    } while (found < 0 && errno == EINTR);
    return found;
  }

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

std::string sha256_of_file(const std::filesystem::path& file, std::size_t from, std::string_view before) {
  std::vector<char> part(1 << 18);
  Sha256 hash;
  hash.add(before.data(), before.size());
  const OpenFile open(file);
  for (auto at = static_cast<off_t>(from);;) {
    const ssize_t size = open.read(part.data(), part.size(), at);
    if (size == 0) return hash.hex();
    if (size < 0) refuse_unreadable(file);
    hash.add(part.data(), static_cast<std::size_t>(size));
    at += size;
  }
}

}  // namespace remote_touch
