// Curves of the tables of an answer about a sweep.
#pragma once

#include <string>

#include "analysis/figures/figure.h"

namespace remote_touch {

// A table of an answer: first `axes` columns of axes, then a value and the ends of its interval.
struct AnswerTable {
  Table table;
  std::size_t axes = 0;
  std::string value, low, high;  // names of columns
};

// Adds a panel to the figure, with the value over the first axis of numbers, its interval as a band, and a
// curve for each combination of the other axes. Each curve has a table of its own, with the rows that have a
// value. Adds nothing if there is no axis of numbers with two values, if there are more than 8 curves, or if
// no curve has two points.
void add_answer_panel(Figure& figure, const AnswerTable& answer);

// True if the table is that of one curve, whose rows are also in the table of the answer.
bool is_of_curve(const Figure& figure, const Table& table);

// Returns the value of an axis in a row of a table, without a unit: at most ten digits, or its name.
std::string axis_text(const Column& axis, std::size_t row);

}  // namespace remote_touch
