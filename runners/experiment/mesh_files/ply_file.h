// Checks of PLY files, whose data the library that reads them does not compare with the header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace remote_touch {

// The header of a PLY file. Checks that it ends, and that the file is long enough for its counts.

// The property as written in the file: types may be unknown.
struct PlyProperty {
  std::string name, type;
  std::string count;  // type of a list's length; empty: no list
  bool is_list() const { return !count.empty(); }
};
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::string lines;  // lines of the header that describe it, without comments
};
struct PlyHeader {
  std::string format;   // ascii, binary_little_endian, binary_big_endian
  std::string opening;  // the lines before the first element, without comments
  std::vector<PlyElement> elements;
  std::size_t size = 0;  // number of bytes before the first element's data
  bool ends = false;
  std::optional<std::string> bad_count;  // count of an element if it is not a number
  bool is_ascii() const { return format == "ascii" || format.empty(); }
};
// Returns the header that begins the bytes. Lines end in \n, \r\n or \r. If the header has no end, all lines
// belong to it.
PlyHeader ply_header_in(const std::string& bytes);

// Returns the size in bytes of a value of this type in a binary file; 0 if the type is unknown.
std::size_t size_of_ply(std::string_view type);

// Returns the problem of the header in one line; empty if there is none.
std::string ply_problem(const std::filesystem::path& file);

// The data of a PLY file, which the library that reads it does not compare with the header.

// Returns the file with the vertices first, as the library needs them, and without empty lines. The other
// elements keep their order. pre: ply_problem() finds none. Throws std::runtime_error for a format or a type
// that is unknown, for data that end before the last element, and for anything but blanks after it. Each
// element of a text must be a line with all its values and no others, and with integers if the type is an
// integer type; the message then has the number of the line.
std::string with_vertices_first(const std::string& ply);

}  // namespace remote_touch
