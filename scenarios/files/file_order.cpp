#include "scenarios/files/file_order.h"

#include "scenarios/files/text_file.h"

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

// Compares names, numbers as numbers. Returns a value below 0, 0 or above 0.
int compare_names(const std::string& x, const std::string& y) {
  constexpr std::size_t kClockDigits = 9;  // seconds since 1970, from 1973 on
  std::string_view a = x, b = y;
  bool decimals = false;
  while (!a.empty() && !b.empty()) {
    const std::string_view m = digits_of(a), n = digits_of(b);
    if (m.empty() || n.empty()) {
      if (a.front() != b.front())
        return static_cast<unsigned char>(a.front()) < static_cast<unsigned char>(b.front()) ? -1 : 1;
      decimals = decimals && a.front() == '.';
      a.remove_prefix(1), b.remove_prefix(1);
      continue;
    }
    const int order = decimals ? m.compare(n) : compare_numbers(m, n);
    if (order != 0) return order;
    decimals = !decimals && without_zeros(m).size() >= kClockDigits;
    a.remove_prefix(m.size()), b.remove_prefix(n.size());
  }
  return static_cast<int>(!a.empty()) - static_cast<int>(!b.empty());
}

}  // namespace

void sort_by_name(std::vector<std::filesystem::path>& files) {
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    const std::string x = a.filename().string(), y = b.filename().string();
    const int order = compare_names(x, y);
    return order != 0 ? order < 0 : x < y;
  });
}

std::string equal_numbers(const std::vector<std::filesystem::path>& files) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = 1; i < files.size(); ++i)
    if (compare_names(files[i - 1].stem().string(), files[i].stem().string()) == 0 && count++ == 0) first = i;
  if (count == 0) return {};
  return files[first - 1].filename().string() + " and " + files[first].filename().string() +
         " have equal numbers" +
         (count > 1 ? ", and so have " + std::to_string(count - 1) + " more pair(s)" : "") +
         ": all are frames";
}

std::vector<std::string> numbers_in_name(const std::string& name) {
  std::vector<std::string> numbers;
  for (std::string_view rest = name; !rest.empty();) {
    const std::string_view digits = digits_of(rest);
    if (!digits.empty()) {
      const std::string_view number = without_zeros(digits);
      numbers.emplace_back(number.empty() ? "0" : number);
    }
    rest.remove_prefix(std::max<std::size_t>(digits.size(), 1));
  }
  return numbers;
}

std::map<std::vector<std::string>, std::size_t> frames_by_numbers(const std::filesystem::path& subject,
                                                                  const std::vector<std::string>& names) {
  std::map<std::vector<std::string>, std::size_t> index;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<std::string> numbers = numbers_in_name(std::filesystem::path(names[i]).stem().string());
    if (numbers.empty()) numbers = {std::to_string(i)};
    const auto [found, is_new] = index.emplace(std::move(numbers), i);
    if (!is_new)
      refuse(subject, "it is not clear which of its files belong to ", names[found->second], " and which to ",
             names[i], ": expected frames with different numbers in their names");
  }
  return index;
}

}  // namespace remote_touch
