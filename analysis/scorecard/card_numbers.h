// What is kept of a scorecard: counts of successes and means of judged measures, each with its interval; and
// whether a later card agrees with them.
#pragma once

#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "analysis/scorecard/scorecard.h"

namespace remote_touch {

// Where in a card a number stands. noise_m: NaN for a scene's own noise.
struct CardPlace {
  std::string scene, method;
  double noise_m = 0;
};

struct CardNumbers {
  struct Count {
    CardPlace place;
    Proportion successes;
  };
  struct Mean {
    CardPlace place;
    std::string measure, units;
    MeanDifference value;  // NaN where there is none: no run succeeded, or one run has no interval
  };
  std::vector<Count> counts;
  std::vector<Mean> means;
};

enum class KeptMeasures { judged, all };
CardNumbers numbers_of(const Scorecard& card, KeptMeasures kept);

// A column of that type, as long as the table's first. Throws std::out_of_range.
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

// As two tables, and back. Throws std::out_of_range for a table without one of the columns, or with one of
// another type or length.
Table counts_table(const CardNumbers& numbers);
Table means_table(const CardNumbers& numbers);
CardNumbers numbers_in(const Table& counts, const Table& means);

// A sentence for each number of the new card that does not agree with the stored one: a fraction of successes
// outside of the stored Wilson interval, a mean outside of the stored Student's interval (widened by a
// thousandth of the mean; a single run has no interval but that), a mean that is missing, and a number that
// is not stored at all. What is stored and not in the new card is not looked at. As the seeds are the same,
// equal programs have equal numbers: no difference is chance.
std::vector<std::string> differences(const CardNumbers& stored, const CardNumbers& now);

}  // namespace remote_touch
