// A file that is read at given positions, so that threads share no current position.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace remote_touch {

class ByteFile {
 public:
  // Throws InputError when it cannot be opened or is no plain file.
  explicit ByteFile(const std::filesystem::path& file);
  ~ByteFile();
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  // Returns `size` bytes from `at` on. Throws InputError if the file ends before that; nothing is allocated
  // then.
  std::string bytes(std::uint64_t at, std::uint64_t size) const;
  void read(std::uint64_t at, char* to, std::size_t size) const;
  std::uint32_t crc(std::uint64_t at, std::uint64_t end) const;  // CRC-32 of the bytes from `at` to `end`
  bool has(std::uint64_t at, std::uint64_t size) const { return at <= size_ && size <= size_ - at; }

 private:
  std::string name_;
  std::uint64_t size_ = 0;
  int descriptor_ = -1;
};

}  // namespace remote_touch
