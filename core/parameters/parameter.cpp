#include "core/parameters/parameter.h"

#include <algorithm>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace remote_touch {

namespace {

constexpr Unit kUnits[] = {
    {"_m_per_s2", "m/s^2", {1, -2, 0}},
    {"_m_per_s", "m/s", {1, -1, 0}},
    {"_N_per_m3", "N/m^3", {-3, 0, 1}},
    {"_N_per_m", "N/m", {-1, 0, 1}},
    {"_Ns_per_m", "N s/m", {-1, 1, 1}},
    {"_N_per_s", "N/s", {0, -1, 1}},
    {"_Nm_per_rad", "N m/rad", {1, 0, 1}},
    {"_Nms_per_rad", "N m s/rad", {1, 1, 1}},
    {"_deg_per_s", "deg/s", {0, -1, 0}},
    {"_per_min", "1/min", {0, -1, 0}},
    {"_per_m", "1/m", {-1, 0, 0}},
    {"_per_s", "1/s", {0, -1, 0}},
    {"_m", "m", {1, 0, 0}},
    {"_s", "s", {0, 1, 0}},
    {"_hz", "Hz", {0, -1, 0}},
    {"_Nm", "N m", {1, 0, 1}},
    {"_N", "N", {0, 0, 1}},
    {"_Ns", "N s", {0, 1, 1}},
    {"_kg_m2", "kg m^2", {1, 2, 1}},
    {"_kg", "kg", {-1, 2, 1}},
    {"_deg", "deg", {}},
    {"_rad", "rad", {}},
    {"_px", "px", {}},
    {"_fraction", "1", {}},
    {"_ratio", "1", {}},
    {"_probability", "1", {}},
    {"_direction", "1", {}},
};

}  // namespace

std::span<const Unit> known_units() {
  return kUnits;
}

const Unit* unit_of(const std::string& name) {
  const auto* const found =
      std::ranges::find_if(kUnits, [&](const Unit& unit) { return name.ends_with(unit.ending); });
  return found == std::end(kUnits) ? nullptr : found;
}

double scheduled(const std::vector<double>& rows, double time_s) {
  if (rows.empty()) return 1;
  std::size_t next = 0;  // index of the first row after time_s
  while (next < rows.size() && rows[next] <= time_s) next += 2;
  if (next == 0) return rows[1];
  const double before_s = rows[next - 2], before = rows[next - 1];
  if (next == rows.size()) return before;
  return before + (time_s - before_s) / (rows[next] - before_s) * (rows[next + 1] - before);
}

std::string validate_schedule(const std::vector<double>& rows, const std::string& name,
                              const std::string& what) {
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    if (rows[i + 1] > 1) return name + ": " + what + " " + std::to_string(rows[i + 1]) + ": expected 0 to 1";
    if (i > 0 && rows[i] < rows[i - 2])
      return name + ": time " + std::to_string(rows[i]) + ": expected no earlier than the row before";
  }
  return {};
}

namespace {

// Returns the number of bytes of the character at a position, 0 if the bytes there are not valid UTF-8 (RFC
// 3629: no surrogates, no encoding longer than necessary).
std::size_t character_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0;
  };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t size = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const std::uint32_t second = byte(1);
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
      (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F))
    return 0;
  return size;
}

// Returns true if the UTF-8 character controls a terminal or ends a line: ASCII control characters, those
// from U+0080 to U+009F, and the separators U+2028 and U+2029.
bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0) < 0x20 || byte(0) == 0x7F;
  if (character.size() == 2) return byte(0) == 0xC2 && byte(1) < 0xA0;
  return character == "\xE2\x80\xA8" || character == "\xE2\x80\xA9";
}

// Returns the position of the first byte of the UTF-8 character that contains byte `at`.
std::size_t character_before(const std::string& line, std::size_t at) {
  while (at > 0 && (static_cast<unsigned char>(line[at]) & 0xC0) == 0x80) --at;
  return at;
}

// Returns the first and the last bytes of a text with "..." between them. No character is cut.
std::string ends_of(const std::string& text, std::size_t first_bytes, std::size_t last_bytes) {
  const std::size_t first = character_before(text, first_bytes);
  const std::size_t last = character_before(text, text.size() - last_bytes);
  return text.substr(0, first) + "..." + text.substr(last);
}

// Shortens long words, because a number with many digits or an endless key is not worth a full line. Few file
// names are longer than the limit.
std::string with_short_words(const std::string& line) {
  constexpr std::size_t kMaxWord = 400, kBegin = 200, kEnd = 100;
  std::string shorter;
  for (std::size_t at = 0, end = 0; at < line.size(); at = end) {
    end = std::min(line.find(' ', at + 1), line.size());
    const std::string word = line.substr(at, end - at);
    shorter += word.size() <= kMaxWord ? word : ends_of(word, kBegin, kEnd);
  }
  return shorter;
}

// The limit leaves room for two long paths and a list of all expected names: these lists have up to 300
// bytes. The line begins with subject and problem, and ends with what is expected.
std::string with_short_middle(const std::string& line) {
  constexpr std::size_t kMaxLine = 1000, kBegin = 500, kEnd = 490;
  return line.size() <= kMaxLine ? line : ends_of(line, kBegin, kEnd);
}

}  // namespace

std::string printable(const std::string& text) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_at(text, at);
    const char c = text[at];
    if (c == '\n' || c == '\t' || c == '\r') {
      line += ' ', ++at;
    } else if (size == 0 || is_control(std::string_view(text).substr(at, size))) {
      for (const std::size_t end = at + std::max<std::size_t>(size, 1); at < end; ++at) {
        const auto byte = static_cast<unsigned char>(text[at]);
        line.append("\\x") += kDigits[byte >> 4];
        line += kDigits[byte & 15];
      }
    } else {
      line.append(text, at, size), at += size;
    }
  }
  return with_short_middle(with_short_words(line));
}

// The compiler's own function: core does not include what prints.
std::string formatted(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  std::string text(static_cast<std::size_t>(__builtin_vsnprintf(nullptr, 0, format, values)), '\0');
  __builtin_vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(values), va_end(again);
  return text;
}

}  // namespace remote_touch
