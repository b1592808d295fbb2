#include "runners/sweep/cell_text.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <optional>
#include <vector>

#include "core/parameters/input_error.h"
#include "runners/experiment/settings/stored_configuration.h"

namespace remote_touch {

namespace {

[[noreturn]] void refuse_cell(const NamedCell& cell, const std::string& expected) {
  throw InputError(cell.option + " " + cell.text, "expected " + expected);
}

std::vector<std::string> items_of(const std::string& text) {
  std::vector<std::string> items;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    items.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return items;
}

std::string six_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// Returns the value of a row as the user writes it.
std::string value_text(const Column& axis, std::size_t row) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&axis.values))
    return six_digits((*numbers)[row]);
  const auto number = std::get<std::vector<std::int32_t>>(axis.values)[row];
  return axis.value_names.empty() ? std::to_string(number)
                                  : axis.value_names[static_cast<std::size_t>(number)];
}

std::string values_text(const Column& axis) {
  constexpr std::size_t kMax = 12;
  std::string text;
  for (std::size_t row = 0; row < std::min(kMax, axis.length()); ++row)
    text.append(row == 0 ? "" : ", ").append(value_text(axis, row));
  if (axis.length() > kMax) text += " ... " + value_text(axis, axis.length() - 1);
  return text;
}

std::optional<double> number_of(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

// Returns the row whose value is exactly this number, if the axis has numbers with a fraction.
std::optional<std::size_t> exact_row_of(const Column& axis, double number) {
  const auto* const numbers = std::get_if<std::vector<double>>(&axis.values);
  if (!numbers) return {};
  const auto same = std::find(numbers->begin(), numbers->end(), number);
  if (same == numbers->end()) return {};
  return static_cast<std::size_t>(same - numbers->begin());
}

// Returns the rows that have this text.
std::vector<std::size_t> rows_with(const Column& axis, const std::string& text) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < axis.length(); ++row)
    if (value_text(axis, row) == text) rows.push_back(row);
  return rows;
}

// Returns the rows that the text may name: one, unless no value or several values fit.
std::vector<std::size_t> rows_of(const Column& axis, const std::string& value) {
  const std::optional<double> number = number_of(value);
  if (!number) return rows_with(axis, value);
  if (const std::optional<std::size_t> row = exact_row_of(axis, *number)) return {*row};
  const std::vector<std::size_t> same_text = rows_with(axis, value);
  return same_text.empty() ? rows_with(axis, six_digits(*number)) : same_text;
}

// Returns the end of a refusal of a value that was renamed; nothing for other values.
std::string value_hint(const Column& axis, const std::string& value) {
  std::optional<std::string> renamed = new_value(axis.name, value, axis.value_names);
  if (!renamed) renamed = new_value(axis.long_name, value, axis.value_names);  // of scenario.name
  return renamed ? "; " + value + " is now " + *renamed : "";
}

std::size_t row_of(const NamedCell& cell, const Column& axis, const std::string& value) {
  const std::vector<std::size_t> rows = rows_of(axis, value);
  if (rows.empty())
    refuse_cell(cell, "for " + axis.name + " one of " + values_text(axis) + value_hint(axis, value));
  if (rows.size() > 1)
    refuse_cell(cell, "for " + axis.name + " a number with more digits, or the indices on the axes: " +
                          std::to_string(rows.size()) + " values are " + value_text(axis, rows.front()) +
                          " with six digits");
  return rows.front();
}

// Returns the present name of the axis that the item "NAME=VALUE" gives by an earlier name.
std::optional<std::string> present_axis(const std::string& item, const std::vector<Column>& axes) {
  const std::size_t equals = item.find('=');
  if (equals == std::string::npos) return {};
  return new_name(item.substr(0, equals), names_of(axes));
}

// Returns the end of a refusal with the present names of axes that have earlier names in the text.
std::string axes_hint(const std::string& text, const std::vector<Column>& axes) {
  std::string hint;
  for (const std::string& item : items_of(text))
    if (const std::optional<std::string> renamed = present_axis(item, axes))
      hint.append("; ").append(item, 0, item.find('=')).append(" is now ").append(*renamed);
  return hint;
}

// Splits "NAME=VALUE,NAME=VALUE" at the commas before the name of an axis. Other commas belong to a value:
// that of an axis of objects is JSON.
std::vector<std::string> assignments_of(const std::string& text, const std::vector<Column>& axes) {
  std::vector<std::string> assignments;
  for (const std::string& item : items_of(text)) {
    const bool begins = std::any_of(axes.begin(), axes.end(),
                                    [&](const Column& axis) { return item.starts_with(axis.name + "="); });
    if (begins || assignments.empty() || present_axis(item, axes))
      assignments.push_back(item);
    else
      assignments.back() += "," + item;
  }
  return assignments;
}

// Returns the cell of a text with NAME=VALUE for each axis, in any order.
std::size_t cell_by_values(const NamedCell& cell, const SweepResult& result) {
  std::vector<std::optional<std::size_t>> indices(result.axes.size());
  bool are_known = true;
  for (const std::string& item : assignments_of(cell.text, result.axes)) {
    const std::size_t equals = std::min(item.find('='), item.size());
    const std::string name = item.substr(0, equals), value = item.substr(std::min(equals + 1, item.size()));
    const auto axis = std::find_if(result.axes.begin(), result.axes.end(),
                                   [&](const Column& each) { return each.name == name; });
    const auto i = static_cast<std::size_t>(axis - result.axes.begin());
    are_known = axis != result.axes.end() && !indices[i];
    if (!are_known) break;
    indices[i] = row_of(cell, *axis, value);
  }
  std::string names;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    names.append(names.empty() ? "" : ",").append(result.axes[i].name + "=VALUE");
    if (indices[i]) found.push_back(*indices[i]);
  }
  if (!are_known || found.size() != indices.size())
    refuse_cell(cell, names + axes_hint(cell.text, result.axes));
  return result.cell_at(found);
}

}  // namespace

std::string cell_text(const SweepResult& result, std::size_t cell) {
  std::string text;
  for (const std::size_t at : result.axis_indices(cell))
    text.append(text.empty() ? "" : ",").append(std::to_string(at));
  return text;
}

std::size_t cell_of(const NamedCell& cell, const SweepResult& result) {
  if (cell.text.find('=') != std::string::npos) return cell_by_values(cell, result);
  std::string allowed;
  for (const Column& axis : result.axes)
    allowed.append(allowed.empty() ? "0.." : ",0..").append(std::to_string(axis.length() - 1));
  std::vector<std::size_t> indices;
  for (const std::string& item : items_of(cell.text)) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), number);
    if (error != std::errc() || end != item.data() + item.size() || indices.size() == result.axes.size() ||
        number >= result.axes[indices.size()].length())
      refuse_cell(cell, allowed);
    indices.push_back(number);
  }
  if (indices.size() != result.axes.size()) refuse_cell(cell, allowed);
  return result.cell_at(indices);
}

}  // namespace remote_touch
