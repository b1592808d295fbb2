#include "runners/experiment/mesh_files/mesh_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scenarios/files/input_files.h"

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
  return words_of_line(line.substr(0, line.find('#')), " \t\r\n\v\f\\");
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
      const std::optional<std::int64_t> number = integer_of_word(vertex);
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
      if (!number_of_word(number))
        refuse_line(obj_, at_, in_quotes(number) + " in a vertex: expected a number");
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

constexpr std::string_view kStlBlanks = " \t\r\n\v\f";

bool is_keyword(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

// Reads solids word by word, and writes them in the form of plain_stl().
class Solids {
 public:
  explicit Solids(const std::string& text) : text_(text) { plain_.reserve(text.size()); }

  std::string take() {
    while (!word().empty()) read_solid();
    return std::move(plain_);
  }

 private:
  // Returns the next word without passing it; empty at the end of the file.
  std::string_view word() {
    const std::size_t begin = std::min(text_.find_first_not_of(kStlBlanks, at_), text_.size());
    const std::size_t end = std::min(text_.find_first_of(kStlBlanks, begin), text_.size());
    word_at_ = begin;
    return std::string_view(text_).substr(begin, end - begin);
  }
  void pass(std::string_view passed) { at_ = word_at_ + passed.size(); }

  bool next_is(std::string_view keyword) { return is_keyword(word(), keyword); }

  void expect(std::string_view keyword) {
    const std::string_view found = word();
    if (!is_keyword(found, keyword)) {
      const std::string instead = found.empty() ? "the file ends" : in_quotes(found);
      refuse_line(text_, word_at_, instead + ": expected " + std::string(keyword));
    }
    pass(found);
  }

  // Passes the name of a solid, which may have any words, up to the end of its line.
  void pass_name() { at_ = std::min(text_.find_first_of("\r\n", at_), text_.size()); }

  void read_solid() {
    expect("solid");
    pass_name();
    plain_ += "solid s\n";
    while (next_is("facet")) read_facet();
    expect("endsolid");
    pass_name();
    plain_ += "endsolid s\n";
  }

  void read_facet() {
    expect("facet"), expect("normal");
    for (int i = 0; i < 3; ++i) pass(word());  // some programs write words for NaN
    expect("outer"), expect("loop");
    plain_ += "facet normal 0 0 0\nouter loop\n";
    for (int i = 0; i < 3; ++i) {
      if (next_is("endloop")) refuse_line(text_, word_at_, "a facet does not have three vertices");
      read_vertex();
    }
    if (next_is("vertex")) refuse_line(text_, word_at_, "a facet does not have three vertices");
    expect("endloop"), expect("endfacet");
    plain_ += "endloop\nendfacet\n";
  }

  void read_vertex() {
    expect("vertex");
    plain_ += "vertex";
    for (int i = 0; i < 3; ++i) {
      const std::string_view number = word();
      if (!number_of_word(number))
        refuse_line(text_, word_at_, in_quotes(number) + " in a vertex: expected a number");
      pass(number);
      plain_.append(" ").append(number);
    }
    plain_ += '\n';
  }

  const std::string& text_;
  std::string plain_;
  std::size_t at_ = 0, word_at_ = 0;
};

}  // namespace

// Lines end in \n, \r\n or \r.
void refuse_line(std::string_view text, std::size_t at, const std::string& problem) {
  std::size_t line = 1;
  for (std::size_t i = 0; i < std::min(at, text.size()); ++i)
    if (text[i] == '\n' || (text[i] == '\r' && text.substr(i, 2) != "\r\n")) ++line;
  throw std::runtime_error("line " + std::to_string(line) + ": " + problem);
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kMaxShown = 32;
  std::string quoted = "'";
  quoted += word.substr(0, kMaxShown);
  quoted += word.size() > kMaxShown ? "...'" : "'";
  return quoted;
}

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

bool is_stl_text(const std::string& bytes) {
  static_assert(std::endian::native == std::endian::little);
  constexpr std::size_t kHeader = 84, kFacet = 50;
  std::uint32_t facets = 0;
  if (bytes.size() >= kHeader) std::memcpy(&facets, bytes.data() + kHeader - sizeof facets, sizeof facets);
  if (bytes.size() >= kHeader && bytes.size() == kHeader + std::uint64_t{kFacet} * facets) return false;
  if (bytes.find('\0') != std::string::npos)
    return false;  // binary with another length, "solid" in its header
  const std::size_t begin = std::min(bytes.find_first_not_of(kStlBlanks), bytes.size());
  constexpr std::string_view kSolid = "solid";
  return is_keyword(std::string_view(bytes).substr(begin, kSolid.size()), kSolid);
}

std::string plain_stl(const std::string& text) {
  return Solids(text).take();
}

}  // namespace remote_touch
