#include "scenarios/text_files/file_order.h"

#include <algorithm>
#include <string>
#include <string_view>

namespace remote_touch {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Returns the digits at the beginning of the text.
std::string_view digits_of(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

std::string_view without_zeros(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

// Compares numbers with any number of digits. Returns a value below 0, 0 or above 0.
int compare_numbers(std::string_view a, std::string_view b) {
  a = without_zeros(a), b = without_zeros(b);
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

bool is_before(const std::string& x, const std::string& y) {
  constexpr std::size_t kClockDigits = 9;  // seconds since 1970, from 1973 on
  std::string_view a = x, b = y;
  bool decimals = false;
  while (!a.empty() && !b.empty()) {
    const std::string_view m = digits_of(a), n = digits_of(b);
    if (m.empty() || n.empty()) {
      if (a.front() != b.front())
        return static_cast<unsigned char>(a.front()) < static_cast<unsigned char>(b.front());
      decimals = decimals && a.front() == '.';
      a.remove_prefix(1), b.remove_prefix(1);
      continue;
    }
    const int order = decimals ? m.compare(n) : compare_numbers(m, n);
    if (order != 0) return order < 0;
    decimals = !decimals && without_zeros(m).size() >= kClockDigits;
    a.remove_prefix(m.size()), b.remove_prefix(n.size());
  }
  return a.empty() == b.empty() ? x < y : a.empty();
}

}  // namespace

void sort_by_name(std::vector<std::filesystem::path>& files) {
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return is_before(a.filename().string(), b.filename().string());
  });
}

}  // namespace remote_touch
