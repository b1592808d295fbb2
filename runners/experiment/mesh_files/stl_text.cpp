#include "runners/experiment/mesh_files/stl_text.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "runners/experiment/mesh_files/mesh_words.h"

namespace remote_touch {

namespace {

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
      if (!is_number(number))
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
