#include "runners/live/devices/json_reader.h"

#include <charconv>
#include <cmath>

namespace remote_touch {

namespace {

constexpr int kDeepest = 64;  // greatest nesting that is read; more would only fill the stack

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

char JsonReader::next() {
  while (at_ < end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\n' || *at_ == '\r')) ++at_;
  return at_ < end_ ? *at_ : '\0';
}

bool JsonReader::take(char c) {
  if (next() != c) return false;
  ++at_;
  return true;
}

bool JsonReader::at_end() {
  return next() == '\0' && at_ == end_;
}

bool JsonReader::word(std::string_view text) {
  next();
  if (std::string_view(at_, static_cast<std::size_t>(end_ - at_)).substr(0, text.size()) != text)
    return false;
  at_ += text.size();
  return true;
}

bool JsonReader::number(double& value) {
  const char first = next();
  // The first character is checked, because from_chars also reads "nan" and "inf" as numbers.
  const char* digits = first == '-' ? at_ + 1 : at_;
  if (digits >= end_ || !is_digit(*digits)) return false;
  const auto [end, error] = std::from_chars(at_, end_, value);
  if (error != std::errc() || !std::isfinite(value)) return false;
  at_ = end;
  return true;
}

bool JsonReader::boolean(bool& value) {
  value = next() == 't';
  return word(value ? "true" : "false");
}

bool JsonReader::string(std::string_view& value) {
  if (!take('"')) return false;
  const char* begin = at_;
  for (; at_ < end_; ++at_) {
    if (*at_ == '"') {
      value = std::string_view(begin, static_cast<std::size_t>(at_++ - begin));
      return true;
    }
    if (*at_ == '\\' && ++at_ == end_) return false;
    if (static_cast<unsigned char>(*at_) < ' ') return false;
  }
  return false;
}

bool JsonReader::skip(int depth) {
  if (depth > kDeepest) return false;
  std::string_view text;
  bool flag = false;
  double value = 0;
  const auto inner = [&] { return skip(depth + 1); };
  switch (next()) {
    case '{':
      return object([&](std::string_view) { return inner(); });
    case '[':
      return array(inner);
    case '"':
      return string(text);
    case 't':
    case 'f':
      return boolean(flag);
    case 'n':
      return word("null");
    default:
      return number(value);
  }
}

}  // namespace remote_touch
