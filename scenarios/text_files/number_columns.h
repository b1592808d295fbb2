// Text files of numbers in columns: their lines, their words, and the columns whose names and units are
// stated.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace remote_touch {

// Returns the words of a line, which blanks and tabs separate. A carriage return counts as a blank.
std::vector<std::string_view> words_of_line(std::string_view line);

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

}  // namespace remote_touch
