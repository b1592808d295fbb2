// The stored numbers of a scorecard: counts of successes and means of judged measures, each with its
// interval. A later card is compared with them.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/scorecard/scorecard.h"

namespace remote_touch {

// The scene, method and noise level that a number of a card belongs to. noise_m: NaN for a scene's own noise.
struct CardCell {
  std::string scene, method;
  double noise_m = 0;
};

struct CardNumbers {
  struct Count {
    CardCell cell;
    Proportion successes;
  };
  struct Mean {
    CardCell cell;
    std::string measure, units;
    Estimate value;  // NaN if no run succeeded; the interval is NaN also for one run
  };
  std::vector<Count> counts;
  std::vector<Mean> means;
};

enum class KeptMeasures { judged, all };
CardNumbers numbers_of(const Scorecard& card, KeptMeasures kept);

// Returns the values of the named column. Throws std::out_of_range if the table has no such column, or if it
// has another type than List or another length than the first column.
template <class List>
const List& values_of(const Table& table, const std::string& name) {
  for (const Column& column : table.columns) {
    if (column.name != name) continue;
    const auto* values = std::get_if<List>(&column.values);
    if (values && values->size() == table.columns.front().length()) return *values;
    break;
  }
  throw std::out_of_range("table " + table.name + " has no usable column " + name);
}

// Adds to the table a column of numbers without unit, counts or texts: value(row) of each row.
template <class Row, class Value>
void add_column(Table& table, const std::vector<Row>& rows, std::string name, std::string meaning,
                Value value) {
  std::vector<std::decay_t<std::invoke_result_t<Value, const Row&>>> values;
  for (const Row& row : rows) values.push_back(std::invoke(value, row));
  table.add(std::move(name), "1", std::move(meaning), std::move(values));
}

// Conversion to two tables and back. numbers_in throws std::out_of_range if a table lacks one of the columns,
// or has one of another type or length.
Table counts_table(const CardNumbers& numbers);
Table means_table(const CardNumbers& numbers);
CardNumbers numbers_in(const Table& counts, const Table& means);

// Returns a sentence for each number of the new card that does not agree with the stored one:
// - another number of successes, or of runs,
// - a mean that differs by more than a thousandth,
// - a mean that is missing, and a number that is not stored at all.
// Stored numbers that the new card lacks are not compared. Both cards use the same seeds, so equal programs
// have equal numbers and no difference is due to chance.
std::vector<std::string> differences(const CardNumbers& stored, const CardNumbers& now);

}  // namespace remote_touch
