#include "runners/experiment/mesh_files/mesh_words.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace remote_touch {

namespace {

// std::from_chars does not accept a plus sign.
std::string_view without_plus(std::string_view word) {
  const bool has_one = word.size() > 1 && word[0] == '+' && word[1] != '-';
  return has_one ? word.substr(1) : word;
}

}  // namespace

std::vector<std::string_view> words_of(std::string_view text, std::string_view also) {
  const std::string separators = std::string(" \t\r\n\v\f").append(also);
  std::vector<std::string_view> words;
  for (std::size_t end = 0;;) {
    const std::size_t begin = text.find_first_not_of(separators, end);
    if (begin == std::string_view::npos) return words;
    end = std::min(text.find_first_of(separators, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
  }
}

bool is_number(std::string_view word) {
  word = without_plus(word);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

std::optional<std::int64_t> integer_of(std::string_view word) {
  word = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

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

}  // namespace remote_touch
