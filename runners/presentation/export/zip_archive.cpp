#include "runners/presentation/export/zip_archive.h"

#include <zlib.h>

#include <limits>
#include <stdexcept>

#include "runners/presentation/export/little_endian.h"

namespace remote_touch {

namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20, kFirstOf1980 = 0x21;

std::uint32_t crc_of(const std::string& bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

// Appends the fields that the header of a member and its entry at the end of the archive have in common: from
// the version that is needed to the length of the extra field.
void put_member(std::string& bytes, std::uint32_t crc, std::uint32_t size, const std::string& name) {
  put(bytes, kVersion);
  for (const int flags_method_time : {0, 0, 0}) put(bytes, static_cast<std::uint16_t>(flags_method_time));
  put(bytes, kFirstOf1980);
  put(bytes, crc);
  put(bytes, size);
  put(bytes, size);
  put(bytes, static_cast<std::uint16_t>(name.size()));
  put(bytes, std::uint16_t{0});  // no extra field
}

std::string local_header(const std::string& name, std::uint32_t crc, std::uint32_t size) {
  std::string header;
  put(header, kLocalHeader);
  put_member(header, crc, size, name);
  return header + name;
}

}  // namespace

std::string ZipArchive::opening(const std::string& name, const std::string& content) {
  return local_header(name, crc_of(content), static_cast<std::uint32_t>(content.size())) + content;
}

void ZipArchive::add(const std::string& name, const std::string& content) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
  constexpr std::size_t kMaxMembers = 65534, kHeader = 30;
  if (members_.size() >= kMaxMembers) throw std::length_error("would have more than 65534 members");
  if (size_ + kHeader + name.size() + content.size() > kMax)
    throw std::length_error("would be larger than 4 GiB");
  const Member member{name, crc_of(content), static_cast<std::uint32_t>(content.size()),
                      static_cast<std::uint32_t>(size_)};
  const std::string header = local_header(name, member.crc, member.size);
  write_(header);
  write_(content);
  size_ += header.size() + content.size();
  members_.push_back(member);
}

void ZipArchive::finish() {
  std::string directory;
  for (const Member& member : members_) {
    put(directory, kCentralHeader);
    put(directory, kVersion);
    put_member(directory, member.crc, member.size, member.name);
    for (int none = 0; none < 3; ++none) put(directory, std::uint16_t{0});  // comment, disk, kind of file
    put(directory, std::uint32_t{0});                                       // rights
    put(directory, member.at);
    directory += member.name;
  }
  const auto directory_size = static_cast<std::uint32_t>(directory.size());
  const auto count = static_cast<std::uint16_t>(members_.size());
  put(directory, kEnd);
  for (const std::uint16_t number : {std::uint16_t{0}, std::uint16_t{0}, count, count})
    put(directory, number);
  put(directory, directory_size);
  put(directory, static_cast<std::uint32_t>(size_));
  put(directory, std::uint16_t{0});  // no comment
  write_(directory);
}

}  // namespace remote_touch
