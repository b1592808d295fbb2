#include "scenarios/files/input_files.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

namespace remote_touch {
namespace {

class OpenFile {
 public:
  // Does not wait for another process to open a pipe for writing: a signal would not end that wait.
  explicit OpenFile(const std::filesystem::path& file)
      : file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (file_ >= 0) ::close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  // Waits for data and reads up to size bytes. Returns the number of bytes, 0 at the end, or -1 with errno
  // set if the file cannot be read.
  ssize_t read(char* to, std::size_t size) const {
    if (file_ < 0) return -1;
    pollfd wait{file_, POLLIN, 0};
    if (::poll(&wait, 1, -1) < 0) return -1;
    return ::read(file_, to, size);
  }

 private:
  int file_;
};

// Checks every value and key while the text is parsed.
class Watch {
 public:
  explicit Watch(const std::string& label) : label_(label) {}

  void see(int depth, Json::parse_event_t event, const Json& parsed) {
    if (depth > kMaxJsonDepth) refuse(label_, "nested too deep: expected at most ", kMaxJsonDepth, " levels");
    if (event == Json::parse_event_t::object_start) keys_.emplace_back();
    if (event == Json::parse_event_t::object_end) keys_.pop_back();
    if (event == Json::parse_event_t::key && !keys_.back().insert(parsed.get<std::string>()).second)
      refuse(label_, "the key ", shown(parsed), " appears twice in one object: expected each key once");
  }

 private:
  const std::string& label_;
  std::vector<std::set<std::string>> keys_;  // keys so far of each open object
};

// Throws Json::exception if the text is not JSON. The library takes the byte 0 as the end of the text, so the
// callers refuse it.
Json parse_watched(const std::string& text, const std::string& label) {
  Watch watch(label);
  return Json::parse(text, [&](int depth, Json::parse_event_t event, Json& parsed) {
    watch.see(depth, event, parsed);
    return true;
  });
}

struct NamedUnit {
  ColumnQuantity::Unit of;
  std::string_view name;
  double in_si;
};
constexpr NamedUnit kUnits[] = {
    {ColumnQuantity::Unit::time, "s", 1},     {ColumnQuantity::Unit::time, "ms", 1e-3},
    {ColumnQuantity::Unit::time, "us", 1e-6}, {ColumnQuantity::Unit::time, "ns", 1e-9},
    {ColumnQuantity::Unit::length, "m", 1},   {ColumnQuantity::Unit::length, "mm", 1e-3},
    {ColumnQuantity::Unit::force, "n", 1},
};

constexpr NamedUnit kNoUnit = {ColumnQuantity::Unit::none, "", 1};

// Returns the unit in which a column of this name, in small letters, has the quantity. Returns null if the
// name is that of something else.
const NamedUnit* unit_of(const ColumnQuantity& quantity, std::string_view name) {
  for (const std::string_view base : quantity.names) {
    if (name == base) return &kNoUnit;
    if (!name.starts_with(base) || name[base.size()] != '_') continue;
    const std::string_view suffix = name.substr(base.size() + 1);
    if (suffix.empty()) return &kNoUnit;
    for (const NamedUnit& unit : kUnits)
      if (unit.of == quantity.unit && unit.name == suffix) return &unit;
  }
  return nullptr;
}

template <class Number>
std::optional<Number> whole_word(std::string_view word) {
  const bool has_plus = word.size() > 1 && word[0] == '+' && word[1] != '-';  // refused by from_chars()
  const char *const begin = word.data() + (has_plus ? 1 : 0), *const end = word.data() + word.size();
  Number value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

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

std::string read_text_file(const std::filesystem::path& file, const std::string& expected) {
  const OpenFile open(file);
  std::string text;
  std::array<char, 65536> piece;
  for (;;) {
    const ssize_t size = open.read(piece.data(), piece.size());
    if (size < 0) refuse(file.string(), "cannot be read (", std::strerror(errno), "): ", expected);
    if (size == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(size));
    if (text.size() > kMaxTextBytes)
      refuse(file.string(), "is longer than ", kMaxTextBytes >> 20, " MiB: ", expected);
  }
}

void require_file_or_folder(const std::filesystem::path& path) {
  std::error_code unreachable;
  const std::filesystem::file_status status = std::filesystem::status(path, unreachable);
  if (std::filesystem::exists(status) && std::filesystem::is_other(status))
    refuse(path.string(), "cannot be read (a pipe or a device): expected a file");
}

void require_file(const std::filesystem::path& file) {
  require_file_or_folder(file);
  std::error_code unreachable;
  if (std::filesystem::is_directory(file, unreachable))
    refuse(file.string(), "cannot be read (a folder): expected a file");
}

std::string read_input_text(const std::filesystem::path& file, const std::string& expected) {
  require_file(file);
  return read_text_file(file, expected);
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

Json parse_json(const std::string& text, const std::string& label) {
  if (const std::size_t at = text.find('\0'); at != std::string::npos)
    refuse(label, "has the byte 0 at byte ", at, ": expected JSON, which is text");
  try {
    return parse_watched(text, label);
  } catch (const Json::exception& error) {
    // "[json.exception...] parse error at line 3, column 4: ..." without the library's own prefix
    std::string what = error.what();
    if (const auto end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
    refuse(label, what, ": expected JSON with finite numbers");
  }
}

std::optional<Json> json_or_none(const std::string& text, const std::string& label) {
  if (text.find('\0') != std::string::npos) return {};
  try {
    return parse_watched(text, label);
  } catch (const Json::exception&) {
    return {};
  }
}

Json json_in_file(const std::filesystem::path& file) {
  try {
    return json_or_none(read_text_file(file, ""), file.string()).value_or(nullptr);
  } catch (const InputError&) {
    return nullptr;
  }
}

void require_object(const std::string& subject, const std::string& where, const Json& value) {
  if (!value.is_object()) refuse(subject, where, "is of type ", value.type_name(), ": expected object");
}

void require_keys(const std::string& subject, const std::string& where, const Json& value, const Json& keys) {
  require_object(subject, where, value);
  for (const auto& item : value.items()) {
    const std::string& key = item.key();
    const auto is_key = [&key](const Json& name) { return name.get_ref<const std::string&>() == key; };
    if (std::none_of(keys.begin(), keys.end(), is_key))
      refuse(subject, where, "key ", shown(key), ": expected ", keys.dump());
  }
}

std::string shown(const Json& value) {
  constexpr std::size_t kMaxLength = 160;
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > kMaxLength) text.replace(kMaxLength, std::string::npos, "...");
  return text;
}

std::vector<std::string_view> words_of_line(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(separators); at != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(separators, end);
  }
  return words;
}

std::optional<double> number_of_word(std::string_view word) {
  return whole_word<double>(word);
}

std::optional<std::int64_t> integer_of_word(std::string_view word) {
  return whole_word<std::int64_t>(word);
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

NumberColumns::NumberColumns(const std::string& where, std::vector<std::string> names,
                             std::span<const ColumnQuantity> quantities)
    : names_(std::move(names)), columns_(quantities.size()) {
  for (std::size_t column = 0; column < names_.size(); ++column) {
    const std::string name = in_small_letters(names_[column]);
    bool is_used = false;
    for (std::size_t i = 0; i < quantities.size() && !is_used; ++i) {
      const NamedUnit* unit = unit_of(quantities[i], name);
      if (!unit) continue;
      if (columns_[i])
        refuse(where, "column ", names_[column], ": expected one column of ",
               std::string(quantities[i].names.front()));
      columns_[i] = Column{column, unit->in_si, unit != &kNoUnit}, is_used = true;
    }
    if (!is_used) unused_.push_back(names_[column]);
  }
}

double NumberColumns::value(const std::string& where, std::span<const std::string_view> words,
                            std::size_t quantity) const {
  const Column& column = *columns_[quantity];
  const std::optional<double> number = number_of_word(words[column.index]);
  if (!number) refuse_number(where, words, quantity);
  return column.unit * *number;
}

void NumberColumns::refuse_number(const std::string& where, std::span<const std::string_view> words,
                                  std::size_t quantity) const {
  const std::size_t column = columns_[quantity]->index;
  refuse(where, "'", std::string(words[column].substr(0, 32)), "' in column ", names_[column],
         ": expected a number");
}

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
