// SHA-256, for digests of results, of stored files and of input files.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace remote_touch {

class Sha256 {
 public:
  Sha256();
  void add(const void* data, std::size_t size);
  std::string hex();  // 64 hexadecimal digits; call once, at the end

 private:
  std::shared_ptr<void> state_;
};

// Reads bytes from an offset of an open file on, as many as there are, up to `size`. Returns their number, or
// -1 with errno set if the file cannot be read.
ssize_t read_all(int descriptor, void* to, std::size_t size, off_t from);
// Throws the InputError of a file that cannot be read. error: the errno of the call that failed.
[[noreturn]] void refuse_reading(const std::filesystem::path& file, int error);

// SHA-256 of `before`, followed by the bytes of a file from the offset `from` on. Throws InputError if the
// file cannot be read.
std::string sha256_of_file(const std::filesystem::path& file, std::size_t from = 0,
                           std::string_view before = {});

}  // namespace remote_touch
