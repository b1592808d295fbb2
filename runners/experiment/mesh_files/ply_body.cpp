#include "runners/experiment/mesh_files/ply_body.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "runners/experiment/mesh_files/mesh_words.h"
#include "runners/experiment/mesh_files/ply_header.h"

namespace remote_touch {

namespace {

bool is_float(std::string_view type) {
  return type == "float" || type == "float32" || type == "double" || type == "float64";
}

// True if the word is a value of this type.
bool is_value(std::string_view word, std::string_view type) {
  return is_float(type) ? is_number(word) : integer_of(word).has_value();
}

void require_known(const PlyHeader& header) {
  if (!header.is_ascii() && header.format != "binary_little_endian" && header.format != "binary_big_endian")
    throw std::runtime_error("format " + in_quotes(header.format) + ": expected ascii or a binary one");
  for (const PlyElement& element : header.elements)
    for (const PlyProperty& property : element.properties)
      if (size_of_ply(property.type) == 0 ||
          (property.is_list() && (size_of_ply(property.count) == 0 || is_float(property.count))))
        throw std::runtime_error("property " + in_quotes(property.name) + " of element " +
                                 in_quotes(element.name) + " has a type that is unknown");
}

[[noreturn]] void refuse_end(const PlyElement& element, std::uint64_t found) {
  throw std::runtime_error("it ends after " + std::to_string(found) + " of " + std::to_string(element.count) +
                           " elements " + in_quotes(element.name));
}

// Reads the data of an ASCII file line by line, and writes them without empty lines.
class TextRows {
 public:
  TextRows(const std::string& ply, std::size_t at) : ply_(ply), at_(at) {}

  // Returns the data of one element.
  std::string pass(const PlyElement& element) {
    std::string data;
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
      const std::vector<std::string_view> words = next_line();
      if (words.empty()) refuse_end(element, i);
      require_row(element, words);
      for (const std::string_view word : words) data.append(word) += ' ';
      data.back() = '\n';
    }
    return data;
  }

  void finish() {
    if (!next_line().empty()) refuse_line(ply_, line_at_, "more than the elements that the header counts");
  }

 private:
  // Returns the words of the next line that is not empty; none at the end.
  std::vector<std::string_view> next_line() {
    while (at_ < ply_.size()) {
      line_at_ = at_;
      const std::size_t end = std::min(ply_.find_first_of("\r\n", at_), ply_.size());
      at_ = std::min(end + 1, ply_.size());
      std::vector<std::string_view> words = words_of(std::string_view(ply_).substr(line_at_, end - line_at_));
      if (!words.empty()) return words;
    }
    return {};
  }

  void require_row(const PlyElement& element, const std::vector<std::string_view>& words) const {
    std::size_t used = 0;
    const auto take = [&](const std::string& type) {
      if (used == words.size())
        refuse_line(ply_, line_at_,
                    "an element " + in_quotes(element.name) + " has only " + std::to_string(words.size()) +
                        " values");
      if (!is_value(words[used], type))
        refuse_line(ply_, line_at_, in_quotes(words[used]) + ": expected a number of type " + type);
      return words[used++];
    };
    for (const PlyProperty& property : element.properties) {
      std::int64_t values = 1;
      if (property.is_list()) values = integer_of(take(property.count)).value_or(0);
      if (values < 0) refuse_line(ply_, line_at_, "a list has " + std::to_string(values) + " values");
      for (std::int64_t i = 0; i < values; ++i) take(property.type);
    }
    if (used != words.size())
      refuse_line(ply_, line_at_,
                  "an element " + in_quotes(element.name) + " has " + std::to_string(words.size()) +
                      " values: expected " + std::to_string(used));
  }

  const std::string& ply_;
  std::size_t at_, line_at_ = 0;
};

// Copies the data of a binary file, element by element.
class BinaryRows {
 public:
  BinaryRows(const std::string& ply, std::size_t at, bool is_big_endian)
      : ply_(ply), at_(at), is_big_endian_(is_big_endian) {}

  std::string pass(const PlyElement& element) {
    const std::size_t begin = at_;
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const PlyProperty& property : element.properties) {
        std::uint64_t values = 1;
        if (property.is_list()) values = count(property.count, element, i);
        const std::uint64_t size = size_of_ply(property.type);
        if (values > (ply_.size() - at_) / size) refuse_end(element, i);
        at_ += values * size;
      }
    return ply_.substr(begin, at_ - begin);
  }

  // Accepts line feeds and blanks after the last element, and nothing else.
  void finish() const {
    if (ply_.find_first_not_of(" \t\r\n\v\f", at_) == std::string::npos) return;
    throw std::runtime_error("it has " + std::to_string(ply_.size() - at_) + " bytes after the last element");
  }

 private:
  // Reads the length of a list, of this type. Throws std::runtime_error if it is negative.
  std::uint64_t count(const std::string& type, const PlyElement& element, std::uint64_t done) {
    const std::size_t size = size_of_ply(type);
    if (size > ply_.size() - at_) refuse_end(element, done);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t byte = is_big_endian_ ? i : size - 1 - i;
      value = value << 8 | static_cast<unsigned char>(ply_[at_ + byte]);
    }
    at_ += size;
    if (!type.starts_with('u') && value >> (8 * size - 1) != 0)
      throw std::runtime_error("element " + in_quotes(element.name) + " " + std::to_string(done) +
                               " has a list of negative length");
    return value;
  }

  const std::string& ply_;
  std::size_t at_;
  bool is_big_endian_;
};

std::string with_line_feeds(const std::string& lines) {
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i] != '\r')
      text += lines[i];
    else if (lines.compare(i, 2, "\r\n") != 0)
      text += '\n';
  return text;
}

bool is_vertex(const PlyElement& element) {
  return element.name == "vertex";
}

// Returns the file with the vertices first.
template <class Rows>
std::string in_order(const PlyHeader& header, Rows rows) {
  std::string vertex_lines, lines, vertex_data, data;
  for (const PlyElement& element : header.elements) {
    (is_vertex(element) ? vertex_lines : lines) += element.lines;
    (is_vertex(element) ? vertex_data : data) += rows.pass(element);
  }
  rows.finish();
  const std::string body = vertex_data + data;
  // The library counts a line feed at the beginning of binary data as a part of the header. A second one is
  // therefore added.
  const char* const kept = !header.is_ascii() && body.starts_with('\n') ? "\n" : "";
  return with_line_feeds(header.opening + vertex_lines + lines) + "end_header\n" + kept + body;
}

}  // namespace

std::string with_vertices_first(const std::string& ply) {
  const PlyHeader header = ply_header_in(ply);
  require_known(header);
  if (header.is_ascii()) return in_order(header, TextRows(ply, header.size));
  return in_order(header, BinaryRows(ply, header.size, header.format == "binary_big_endian"));
}

}  // namespace remote_touch
