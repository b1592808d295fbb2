#include "runners/sweep/answer_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/parameters/input_error.h"
#include "runners/sweep/answer_panels.h"

namespace remote_touch {

namespace {

constexpr std::size_t kMostRows = 60;

std::string number_text(double value) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

// True for the columns before the answer itself: the axes, whose values must not look alike.
bool is_axis(const Table& table, const Column& column) {
  const auto named = [&](const char* name) {
    return std::find_if(table.columns.begin(), table.columns.end(),
                        [&](const Column& each) { return each.name == name; });
  };
  const auto renamed = named("value_of_answer");  // an axis is called "value"
  return &column < &*(renamed == table.columns.end() ? named("value") : renamed);
}

// Returns the texts of a column: its name, its unit and the values.
std::vector<std::string> texts_of(const Table& table, const Column& column, std::size_t rows) {
  std::vector<std::string> texts = {column.name, column.units == "1" ? "" : column.units};
  const auto* const numbers = std::get_if<std::vector<double>>(&column.values);
  const bool is_answer = numbers && !is_axis(table, column);
  if (const auto* const words = std::get_if<std::vector<std::string>>(&column.values)) {
    for (std::size_t row = 0; row < rows; ++row)
      texts.push_back((*words)[row].empty() ? "-" : printable((*words)[row]));
    return texts;
  }
  for (std::size_t row = 0; row < rows; ++row)
    texts.push_back(is_answer ? number_text((*numbers)[row]) : printable(axis_text(column, row)));
  return texts;
}

std::string table_text(const Table& table) {
  const std::size_t all = table.columns.front().length(), rows = std::min(all, kMostRows);
  std::vector<std::string> lines(rows + 2, "  ");
  for (const Column& column : table.columns) {
    const std::vector<std::string> texts = texts_of(table, column, rows);
    std::size_t width = 0;
    for (const std::string& text : texts) width = std::max(width, text.size());
    for (std::size_t i = 0; i < texts.size(); ++i)
      lines[i].append(texts[i]).append(width + 2 - texts[i].size(), ' ');
  }
  std::string text = table.title + "\n";
  for (std::string& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  if (all > rows) text += "  and " + std::to_string(all - rows) + " more rows: -o FILE.csv writes all\n";
  return text;
}

}  // namespace

std::string answer_text(const Figure& answer, std::size_t done, std::size_t asked) {
  std::string text = answer.caption.empty() ? "" : answer.caption + "\n";
  for (const Table& table : answer.tables)
    if (!is_of_curve(answer, table)) text += table_text(table);
  if (done < asked)
    text += "  note: " + std::to_string(asked - done) + " of " + std::to_string(asked) +
            " runs are not finished and are left out\n";
  return text;
}

}  // namespace remote_touch
