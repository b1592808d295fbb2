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

}  // namespace remote_touch
