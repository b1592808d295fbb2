#include "runners/tool_files/obj_text.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace remote_touch {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

// Returns the end of a line, including the lines that continue it after a backslash.
std::size_t end_of_line(const std::string& text, std::size_t at) {
  for (std::size_t from = at;;) {
    const std::size_t end = text.find_first_of("\r\n", from);
    if (end == std::string::npos) return text.size();
    from = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    if (end == at || text[end - 1] != '\\') return from;
  }
}

// "vt", "vn" and "vp" begin with the letter of a vertex.
bool is_used(std::string_view line) {
  return !line.starts_with("mtllib") && !(line.size() > 1 && line[0] == 'v' && !is_blank(line[1]));
}

bool has_corners(std::string_view line) {
  return line.size() > 1 && (line[0] == 'f' || line[0] == 'l' || line[0] == 'p') && is_blank(line[1]);
}

// Keeps only the vertex of a corner such as "3/1/2".
void add_vertices(std::string_view line, std::string& text) {
  bool is_vertex = true;
  for (const char c : line) {
    if (is_blank(c) || c == '\r' || c == '\n' || c == '\\') is_vertex = true;
    if (c == '/') is_vertex = false;
    if (is_vertex) text += c;
  }
}

// Drops the colour, because the library skips vertices whose colour does not have three numbers.
void add_position(std::string_view line, std::string& text) {
  std::vector<std::string_view> numbers;
  for (std::size_t at = 1; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r\n\\", at);
    if (begin == std::string_view::npos || line[begin] == '#') break;
    at = std::min(line.find_first_of(" \t\r\n\\", begin), line.size());
    numbers.push_back(line.substr(begin, at - begin));
  }
  if (numbers.size() < 3) throw std::runtime_error("a vertex has fewer than three coordinates");
  if (numbers.size() > 4) numbers.resize(3);
  text += 'v';
  for (const std::string_view number : numbers) text.append(" ").append(number);
  text += '\n';
}

}  // namespace

std::string only_shape(const std::string& obj) {
  std::string text;
  text.reserve(obj.size());
  for (std::size_t at = 0, end = 0; at < obj.size(); at = end) {
    end = end_of_line(obj, at);
    std::string_view line(obj.data() + at, end - at);
    line.remove_prefix(
        static_cast<std::size_t>(std::find_if_not(line.begin(), line.end(), is_blank) - line.begin()));
    if (has_corners(line))
      add_vertices(line, text);
    else if (line.size() > 1 && line[0] == 'v' && is_blank(line[1]))
      add_position(line, text);
    else if (is_used(line))
      text += line;
  }
  return text;
}

}  // namespace remote_touch
