// Archives in the format ZIP, whose members are stored as they are.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace remote_touch {

// Passes the bytes of the archive to `write` as it grows. It stores no times, so that equal members give
// equal bytes.
class ZipArchive {
 public:
  explicit ZipArchive(std::function<void(const std::string& bytes)> write) : write_(std::move(write)) {}
  // Throws std::length_error beyond 4 GiB or 65534 members, the limits of a ZIP archive without extensions.
  // Its text says which: "would be larger than 4 GiB".
  void add(const std::string& name, const std::string& content);
  void finish();

  // Returns the bytes with which an archive begins that has this first member.
  static std::string opening(const std::string& name, const std::string& content);

 private:
  struct Member {
    std::string name;
    std::uint32_t crc, size, at;
  };
  std::function<void(const std::string&)> write_;
  std::vector<Member> members_;
  std::uint64_t size_ = 0;
};

}  // namespace remote_touch
