// The header of a PLY file: whether it ends, and whether the file is long enough for its counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace remote_touch {

// As written: types may be unknown.
struct PlyProperty {
  std::string name, type;
  std::string count;  // of a list, the type of its length; empty: no list
  bool is_list() const { return !count.empty(); }
};
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::string lines;  // of the header that describe it, without comments
};
struct PlyHeader {
  std::string format;   // ascii, binary_little_endian, binary_big_endian
  std::string opening;  // the lines before the first element, without comments
  std::vector<PlyElement> elements;
  std::size_t size = 0;  // up to the first element's data, in bytes
  bool ends = false;
  std::optional<std::string> bad_count;  // of an element, that is no number
  bool is_ascii() const { return format == "ascii" || format.empty(); }
};
// Lines end in \n, \r\n or \r. Without an end of the header, all is header.
PlyHeader ply_header_in(const std::string& bytes);

// The bytes of a value of this type in a binary file; 0: unknown.
std::size_t size_of_ply(std::string_view type);

// The problem in one line; empty if there is none.
std::string ply_problem(const std::filesystem::path& file);

// The bytes of a file as the library needs them. Where binary data begin with a line feed it takes that byte
// for the end of the header: one more stands before it then.
std::string with_first_byte_kept(std::string ply);

}  // namespace remote_touch
