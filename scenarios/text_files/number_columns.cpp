#include "scenarios/text_files/number_columns.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "scenarios/text_files/text_file.h"

namespace remote_touch {
namespace {

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

}  // namespace

std::vector<std::string_view> words_of_line(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::optional<double> number_of_word(std::string_view word) {
  const bool has_plus =
      word.size() > 1 && word[0] == '+' && word[1] != '-';  // a plus is refused by from_chars()
  const std::string_view digits = has_plus ? word.substr(1) : word;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return {};
  return value;
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

}  // namespace remote_touch
