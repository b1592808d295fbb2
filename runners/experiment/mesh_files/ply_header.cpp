#include "runners/experiment/mesh_files/ply_header.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <sstream>

namespace remote_touch {

namespace {

constexpr std::size_t kMaxHeader = 1 << 20;

// Returns the least number of bytes of an element. Each value of a text is a digit and a separator. A list
// may have no members. An unknown type counts as one byte.
std::uint64_t min_bytes(const PlyElement& element, bool is_ascii) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += is_ascii
                 ? 2
                 : std::max<std::size_t>(1, size_of_ply(property.is_list() ? property.count : property.type));
  return bytes;
}

void take(const std::string& line, PlyHeader& header) {
  std::istringstream words(line);
  words.exceptions(std::ios::badbit);  // throws if memory runs out, which would look like the end
  std::string word;
  words >> word;
  if (word == "format") {
    words >> header.format;
  } else if (word == "element") {
    std::string count;
    PlyElement& added = header.elements.emplace_back();
    words >> added.name >> count;
    const char* end = count.data() + count.size();
    const auto [at, error] = std::from_chars(count.data(), end, added.count);
    if (error != std::errc() || at != end) header.bad_count = count;
  } else if (word == "property" && !header.elements.empty()) {
    PlyProperty& added = header.elements.back().properties.emplace_back();
    words >> added.type;
    if (added.type == "list") words >> added.count >> added.type;
    words >> added.name;
  }
}

}  // namespace

std::size_t size_of_ply(std::string_view type) {
  for (const char* one : {"char", "uchar", "int8", "uint8"})
    if (type == one) return 1;
  for (const char* two : {"short", "ushort", "int16", "uint16"})
    if (type == two) return 2;
  for (const char* four : {"int", "uint", "int32", "uint32", "float", "float32"})
    if (type == four) return 4;
  return type == "double" || type == "float64" ? 8 : 0;
}

PlyHeader ply_header_in(const std::string& bytes) {
  PlyHeader header;
  while (header.size < bytes.size() && !header.ends) {
    const std::size_t begin = header.size, end = bytes.find_first_of("\r\n", begin);
    if (end == std::string::npos) break;
    const std::string line = bytes.substr(begin, end - begin);
    header.size = end + (bytes.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    header.ends = line == "end_header";
    take(line, header);
    // Comments are left out, because the library loses the properties that follow a comment within an
    // element.
    if (header.ends || line.starts_with("comment") || line.starts_with("obj_info")) continue;
    std::string& part = header.elements.empty() ? header.opening : header.elements.back().lines;
    part += bytes.substr(begin, header.size - begin);
  }
  return header;
}

std::string ply_problem(const std::filesystem::path& file) {
  const std::uint64_t whole = std::filesystem::file_size(file);
  std::string bytes(std::min<std::uint64_t>(whole, kMaxHeader), '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  const PlyHeader header = ply_header_in(bytes);
  if (!header.ends) return "its header has no end";
  if (header.bad_count) return "its header has a count that is not a number: " + *header.bad_count;
  const std::uint64_t rest = whole - header.size;
  std::uint64_t claimed = 0, elements = 0;
  for (const PlyElement& element : header.elements) {
    const std::uint64_t bytes_of_one = std::max<std::uint64_t>(1, min_bytes(element, header.is_ascii()));
    std::uint64_t all = 0;
    if (__builtin_mul_overflow(element.count, bytes_of_one, &all) ||
        __builtin_add_overflow(claimed, all, &claimed) ||
        __builtin_add_overflow(elements, element.count, &elements))
      return "its header claims more than any file holds";
  }
  // The last number of a text needs no separator behind it.
  if (claimed > rest + (header.is_ascii() ? 1 : 0))
    return "its header claims " + std::to_string(elements) + " elements, more than its " +
           std::to_string(rest) + " bytes hold";
  return {};
}

}  // namespace remote_touch
