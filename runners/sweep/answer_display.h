// The display of an answer about a sweep: its curves and its text.
#pragma once

#include <string>

#include "analysis/storage/result_file.h"

namespace remote_touch {

// Curves of the tables of an answer about a sweep.

// Adds a panel to the figure for a table of an answer: first `axes` columns of axes, then those of
// add_estimates(). It has the value over the first axis of numbers, its interval as a band, and a curve for
// each combination of the other axes. Each curve has a table of its own, with the rows that have a value.
// Adds nothing if there is no axis of numbers with two values, if there are more than 8 curves, or if no
// curve has two points.
void add_answer_panel(Figure& figure, const Table& table, std::size_t axes);

// Adds a panel for a table of limits along an axis, with their intervals as bars; an open end is an arrow. A
// limit that is not between the values of the axis is a mark at the end of the axis, with a legend entry.
// Without an axis of numbers, the rows stand beside each other and the label names them. Adds nothing if
// there are more than 8 curves, or nothing to draw.
void add_answer_limits(Figure& figure, const Table& table, std::size_t axes, const Column& along);

// True if the table is that of one curve, whose rows are also in the table of the answer.
bool is_of_curve(const Figure& figure, const Table& table);

// Returns the value of an axis in a row of a table, without a unit: at most ten digits, or its name.
std::string axis_text(const Column& axis, std::size_t row);

// An answer about a sweep as text.

// Returns the caption and each table with names, units and at most 60 rows; "-" stands for a value that is
// not known. Tables of single curves, which repeat rows, are left out. A note states how many of the `asked`
// runs are not finished.
std::string answer_text(const Figure& answer, std::size_t done, std::size_t asked);

}  // namespace remote_touch
