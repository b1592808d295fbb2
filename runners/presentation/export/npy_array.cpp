#include "runners/presentation/export/npy_array.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace remote_touch {

namespace {

static_assert(std::endian::native == std::endian::little);

// Returns the header. Its length, including the 10 bytes of the opening, is a multiple of 64, so that the
// values are aligned.
std::string npy_header(const std::string& type, const std::string& shape) {
  constexpr std::size_t kOpening = 10, kAlignment = 64;
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  const std::size_t whole = (kOpening + text.size() + 1 + kAlignment - 1) / kAlignment * kAlignment;
  text.resize(whole - kOpening - 1, ' ');
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

// Returns the number of bytes of a UTF-8 character that begins with this byte; 0 if none does.
std::size_t length_of_character(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

// true: a character of this value has this many bytes in UTF-8. Halves of pairs of UTF-16 and numbers above
// U+10FFFF are no characters.
bool is_character(char32_t character, std::size_t length) {
  if (character >= 0xd800 && character < 0xe000) return false;
  const char32_t least = length == 4 ? 0x10000 : length == 3 ? 0x800 : length == 2 ? 0x80 : 0;
  return character >= least && character <= 0x10ffff;
}

// Decodes UTF-8. Each byte that is not part of a valid character becomes U+FFFD.
std::u32string characters(const std::string& text) {
  std::u32string all;
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t length = length_of_character(first);
    char32_t character = length <= 1 ? first : first & (0x7fu >> length);
    bool is_good = length > 0 && at + length <= text.size();
    for (std::size_t k = 1; is_good && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[at + k]);
      is_good = (next & 0xc0) == 0x80;
      character = character << 6 | (next & 0x3fu);
    }
    is_good = is_good && is_character(character, length);
    all += is_good ? character : U'\xfffd';
    at += is_good ? length : 1;
  }
  return all;
}

std::string fixed_length(const std::vector<std::u32string>& texts, std::size_t length) {
  std::string bytes;
  bytes.reserve(4 * length * texts.size());
  for (std::u32string text : texts) {
    text.resize(length);
    bytes.append(reinterpret_cast<const char*>(text.data()), 4 * text.size());
  }
  return bytes;
}

std::string array_of_texts(const std::vector<std::string>& texts, const std::string& shape) {
  std::vector<std::u32string> all;
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, all.emplace_back(characters(text)).size());
  return npy_header("<U" + std::to_string(length), shape) + fixed_length(all, length);
}

}  // namespace

std::string npy_array(const Column& column) {
  const std::string count = std::to_string(column.length());
  const std::string shape =
      column.width == 1 ? "(" + count + ",)" : "(" + count + ", " + std::to_string(column.width) + ")";
  if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values))
    return array_of_texts(*texts, shape);
  const auto is_of = [&](auto one) {
    return std::holds_alternative<std::vector<decltype(one)>>(column.values);
  };
  const char* const type = is_of(0.0) ? "<f8" : is_of(std::int32_t{}) ? "<i4" : "<u8";
  std::string array = npy_header(type, shape);
  std::visit(
      [&](const auto& values) {
        array.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values.front());
      },
      column.values);
  return array;
}

std::string npy_text(const std::string& text) {
  return array_of_texts({text}, "()");
}

}  // namespace remote_touch
