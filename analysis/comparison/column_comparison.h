// Deviations of the values of one column from those of another.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/trace/column.h"
#include "analysis/trace/tolerance.h"

namespace remote_touch {

// A row is a number or a vector. Its deviation is the length of the difference, in the column's units. The
// row is inside the tolerance if the deviation is at most absolute + relative * |row of the baseline|.
//
// Numbers are compared as in tolerance.h. Names (enumerations), texts and hashes are outside unless they are
// equal. Different types, widths, units, value names or lengths are a problem. Columns of different types or
// widths are not compared further; otherwise the rows that both have are compared nevertheless. Two columns
// without rows are the same.
struct ColumnComparison {
  std::string name, units;
  Tolerance tolerance;
  std::string problem = {};  // empty: none
  std::size_t baseline_rows = 0, candidate_rows = 0;
  std::size_t rows = 0;         // rows compared
  std::size_t outside = 0;      // rows outside the tolerance
  std::size_t not_numbers = 0;  // rows outside because of a NaN, an infinity or a difference that overflows
  double max = 0, rms = 0;      // largest and rms finite deviation, in units; 0 for names, texts and hashes
  std::optional<std::size_t> first_difference = {}, first_outside = {};

  bool is_same() const { return problem.empty() && outside == 0; }
};

ColumnComparison compare_columns(const Column& baseline, const Column& candidate, const Tolerance& tolerance);

// Returns the deviation of every row that both have; none if their types or widths differ. NaN if one has a
// NaN or an infinity and the other does not, or if the difference overflows. For names, texts and hashes it
// is 0 if they are equal, else 1.
std::vector<double> deviations(const Column& baseline, const Column& candidate);

}  // namespace remote_touch
