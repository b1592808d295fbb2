#include "runners/experiment/mesh_files/obj_text.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "runners/experiment/mesh_files/mesh_words.h"

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

// Returns false for mtllib, and for "vt", "vn" and "vp", which begin with the letter of a vertex.
bool is_used(std::string_view line) {
  return !line.starts_with("mtllib") && !(line.size() > 1 && line[0] == 'v' && !is_blank(line[1]));
}

bool has_corners(std::string_view line) {
  return line.size() > 1 && (line[0] == 'f' || line[0] == 'l' || line[0] == 'p') && is_blank(line[1]);
}

// Returns the words of a line and its continuations, up to a comment.
std::vector<std::string_view> words_before_comment(std::string_view line) {
  return words_of(line.substr(0, line.find('#')), "\\");
}

// Copies the lines that describe the shape, one by one.
class ShapeLines {
 public:
  explicit ShapeLines(const std::string& obj) : obj_(obj) { text_.reserve(obj.size()); }

  void add(std::size_t at, std::string_view line) {
    at_ = at;
    if (has_corners(line))
      add_corners(line);
    else if (line.size() > 1 && line[0] == 'v' && is_blank(line[1]))
      add_position(line);
    else if (is_used(line))
      text_ += line;
  }

  // Returns the copied text. The numbers of the vertices are checked only here, because faces may come before
  // their vertices. Throws std::runtime_error for a vertex that does not exist.
  std::string take() {
    if (farthest_ > vertices_)
      refuse_line(obj_, farthest_at_,
                  "vertex " + std::to_string(farthest_) + ": expected 1 to " + std::to_string(vertices_));
    return std::move(text_);
  }

 private:
  // Keeps only the vertex of a corner such as "3/1/2".
  void add_corners(std::string_view line) {
    text_ += line[0];
    for (const std::string_view corner : words_before_comment(line.substr(1))) {
      const std::string_view vertex = corner.substr(0, corner.find('/'));
      const std::optional<std::int64_t> number = integer_of(vertex);
      if (!number || *number == 0 || *number < -vertices_)
        refuse_line(obj_, at_, "corner " + in_quotes(corner) + ": expected the number of a vertex");
      if (*number > farthest_) farthest_ = *number, farthest_at_ = at_;
      text_.append(" ").append(std::to_string(*number));  // without a plus and zeros before it
    }
    text_ += '\n';
  }

  // Drops the colour, because the library skips vertices whose colour does not have three numbers, and the
  // weight w, by which it would divide: w belongs to rational curves and surfaces. Puts a digit before a
  // leading point, because the library skips vertices with such a number.
  void add_position(std::string_view line) {
    const std::vector<std::string_view> numbers = words_before_comment(line.substr(1));
    if (numbers.size() < 3) refuse_line(obj_, at_, "a vertex has fewer than three coordinates");
    if (numbers.size() == 5 || numbers.size() > 7)
      refuse_line(obj_, at_,
                  "a vertex has " + std::to_string(numbers.size()) +
                      " numbers: expected x y z, then w, or a colour of 3 or 4");
    for (const std::string_view number : numbers)
      if (!is_number(number)) refuse_line(obj_, at_, in_quotes(number) + " in a vertex: expected a number");
    text_ += 'v';
    for (std::size_t i = 0; i < 3; ++i) text_.append(numbers[i][0] == '.' ? " 0" : " ").append(numbers[i]);
    text_ += '\n';
    ++vertices_;
  }

  const std::string& obj_;
  std::string text_;
  std::size_t at_ = 0;  // position of the line in the file
  std::int64_t vertices_ = 0, farthest_ = 0;
  std::size_t farthest_at_ = 0;
};

}  // namespace

std::string only_shape(const std::string& obj) {
  ShapeLines shape(obj);
  for (std::size_t at = 0, end = 0; at < obj.size(); at = end) {
    end = end_of_line(obj, at);
    std::string_view line(obj.data() + at, end - at);
    line.remove_prefix(
        static_cast<std::size_t>(std::find_if_not(line.begin(), line.end(), is_blank) - line.begin()));
    shape.add(at, line);
  }
  return shape.take();
}

}  // namespace remote_touch
