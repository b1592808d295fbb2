// Files that a user names. Text and JSON of unknown origin, read whole, and their refusal; the order of the
// files of a folder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/parameters/parameter.h"

namespace remote_touch {

// Throws InputError about the subject, in one line. The problem is given in parts: texts, and numbers, which
// are written as by std::to_string().
template <class... Parts>
[[noreturn]] void refuse(const std::string& subject, Parts... parts) {
  std::string problem;
  const auto add = [&problem](const auto& part) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(part)>>)
      problem += std::to_string(part);
    else
      problem += part;
  };
  (add(parts), ...);
  throw InputError(subject, problem);
}

// A file of text, such as JSON or a list, read whole.

inline constexpr std::size_t kMaxTextBytes = 16 << 20;

// Reads a file, a pipe or a device, up to kMaxTextBytes. Throws InputError, naming the file and what is
// expected there, if it cannot be read, is longer than that, or a signal interrupts the wait for data.
std::string read_text_file(const std::filesystem::path& file, const std::string& expected);

// Throws InputError if the path leads to something else than a file: a folder, a pipe or a device, also by a
// link. Every input of a run is read twice or more, for its digest and for its content. A pipe can be read
// only once and may never be written to, and a device may never end. A path that leads nowhere is accepted;
// the reader refuses it.
void require_file(const std::filesystem::path& file);
// The same, but accepts a folder.
void require_file_or_folder(const std::filesystem::path& path);

// The same as read_text_file(), but refuses what require_file() refuses.
std::string read_input_text(const std::filesystem::path& file, const std::string& expected);

// Returns the text without a byte order mark, which some editors write in front of UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

// Reads JSON of unknown origin safely.

using Json = nlohmann::ordered_json;

inline constexpr int kMaxJsonDepth = 64;  // deeper values would exhaust the stack when they are printed

// Throws InputError, about the label, for text that is not JSON, nests deeper than kMaxJsonDepth, or has a
// key twice in one object.
Json parse_json(const std::string& text, const std::string& label);
// Returns none for text that is not JSON. Otherwise returns or throws as parse_json().
std::optional<Json> json_or_none(const std::string& text, const std::string& label);

// Returns the content of a file, or null if the file cannot be read or parse_json() would refuse it.
Json json_in_file(const std::filesystem::path& file);

// Returns the value as JSON, for a message: shortened, and always safe to print.
std::string shown(const Json& value);

// Throws InputError about the subject unless the value is an object. where: its place in the file, such as
// "objects[0]: ", or empty.
void require_object(const std::string& subject, const std::string& where, const Json& value);
// Throws it also if the object has other keys than these.
void require_keys(const std::string& subject, const std::string& where, const Json& value, const Json& keys);

// Text files of numbers in columns: their lines, their words, and the columns whose names and units are
// stated.

// Returns the words of a line, which blanks and tabs separate. A carriage return counts as a blank.
std::vector<std::string_view> words_of_line(std::string_view line, std::string_view separators = " \t\r\v\f");

// Calls use(number, line) for each line of a text, without its end. The first line has the number 1.
template <class Use>
void for_each_line(std::string_view text, Use&& use) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    use(number, text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// Returns a number in the decimal notation of C, whatever the locale, or nothing if the word is anything
// else. nan and inf are numbers.
std::optional<double> number_of_word(std::string_view word);
// The same for a decimal integer.
std::optional<std::int64_t> integer_of_word(std::string_view word);

std::string in_small_letters(std::string_view text);

// A quantity that a column may have. A name is one of `names`, in small or capital letters, and may end in
// "_" and a unit: s, ms, us, ns of a time; m, mm of a length; n of a force. Without a unit, or with an empty
// one ("tx_"), the numbers are seconds, metres, newtons, or have no unit.
struct ColumnQuantity {
  enum class Unit { none, time, length, force };
  std::vector<std::string_view> names;  // the first one is used in messages
  Unit unit = Unit::none;
};

class NumberColumns {
 public:
  NumberColumns() = default;
  // names: of all columns, in order. Throws InputError about `where` if two columns have one quantity.
  NumberColumns(const std::string& where, std::vector<std::string> names,
                std::span<const ColumnQuantity> quantities);

  std::size_t count() const { return names_.size(); }
  bool has(std::size_t quantity) const { return columns_[quantity].has_value(); }
  // True if the name of the column states the unit.
  bool states_unit(std::size_t quantity) const { return columns_[quantity]->states_unit; }
  // Names of the columns that have none of the quantities.
  const std::vector<std::string>& unused() const { return unused_; }
  // Returns the value of a quantity in a line, in its SI unit. Throws InputError about `where` if it is not a
  // number. Pre: has(quantity), count() words or more.
  double value(const std::string& where, std::span<const std::string_view> words, std::size_t quantity) const;
  // Throws InputError about the word of a quantity, which should be another number.
  [[noreturn]] void refuse_number(const std::string& where, std::span<const std::string_view> words,
                                  std::size_t quantity) const;

 private:
  struct Column {
    std::size_t index = 0;
    double unit = 1;  // in SI units
    bool states_unit = false;
  };
  std::vector<std::string> names_, unused_;
  std::vector<std::optional<Column>> columns_;  // one for each quantity
};

// Tests of file names that decide which files of a folder belong to a recording.

// Returns true if the file's extension is the ending (lower case, with its dot), in small or capital letters:
// .png and .PNG.
inline bool has_ending(const std::filesystem::path& file, std::string_view ending) {
  const std::string extension = file.extension().string();
  const auto same = [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  };
  return std::equal(extension.begin(), extension.end(), ending.begin(), ending.end(), same);
}

// Returns true if the name begins with a dot. Such files are not part of a recording: other systems write
// ._0001.png beside 0001.png.
inline bool is_hidden(const std::filesystem::path& file) {
  return file.filename().string().starts_with('.');
}

// Sorts files by name. Numbers in names are compared as numbers: frame_9, frame_10, frame_0100. The digits
// after the point of a clock time (nine digits or more) are decimals: 1305031102.16 is before 1305031102.5.
// If the numbers are equal, as 01 and 1, the texts are compared.
void sort_by_name(std::vector<std::filesystem::path>& files);

// Returns all numbers in a name, without leading zeros: 2 and 7 for img_2_0007, 0 for 000.
std::vector<std::string> numbers_in_name(const std::string& name);

// Returns the index of each name by the numbers in it, without its ending. Names without a number count as
// their indices. Throws InputError about the subject if two names have the same numbers.
std::map<std::vector<std::string>, std::size_t> frames_by_numbers(const std::filesystem::path& subject,
                                                                  const std::vector<std::string>& names);

// Returns one line about files whose names differ in nothing but leading zeros and the ending, such as
// frame_1.pcd and frame_01.pcd: probably one of them is a copy. Empty if there are none. Pre: the files are
// in the order of sort_by_name().
std::string equal_numbers(const std::vector<std::filesystem::path>& files);

}  // namespace remote_touch
