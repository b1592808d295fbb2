#include "analysis/sweeps/refinement.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/statistics/interval_estimates.h"

namespace remote_touch {

namespace {

struct Belief {
  bool known = false;      // the outcome of some run is known
  bool uncertain = false;  // neither "likely" nor its opposite is certain
  bool likely = false;     // more than half of the known runs had the event
};

// A cell is certain if it has more events than n / 2 by 1.96 deviations of n tosses of a fair coin, or as
// many fewer, whatever its unknown outcomes are.
Belief belief(const SweepResult& result, const RefinementRule& rule, std::size_t cell) {
  const EventCounts counts = event_counts(result, result.measure(rule.measure), cell, rule.threshold);
  const auto runs = static_cast<double>(counts.runs());
  const double chance = 0.5 * runs + 0.5 * kTwoSided95 * std::sqrt(runs);
  const bool is_certain = static_cast<double>(std::max(counts.events, counts.without)) >= chance;
  return {counts.known() > 0, !is_certain, counts.events > counts.without};
}

int requested_replicates(const SweepResult& result, std::size_t cell) {
  int count = 0;
  for (int replicate = 0; replicate < result.replicates; ++replicate)
    count += result.state[result.run(cell, replicate)] != RunState::not_sampled ? 1 : 0;
  return count;
}

// Adds the cells half way between this cell and each neighbour if they disagree or one of them is uncertain,
// at every spacing from the first round's down to 2.
void add_between(const SweepResult& result, const std::vector<Belief>& beliefs,
                 const std::vector<std::size_t>& strides, std::size_t cell, std::set<std::size_t>& cells) {
  const std::vector<std::size_t> here = result.axis_indices(cell);
  for (std::size_t axis = 0; axis < here.size(); ++axis)
    for (std::size_t stride = strides[axis]; stride >= 2; stride /= 2) {
      std::vector<std::size_t> there = here;
      there[axis] += stride;
      if (here[axis] % stride != 0 || there[axis] >= result.axes[axis].length()) continue;
      const Belief &a = beliefs[cell], &b = beliefs[result.cell_at(there)];
      if (!a.known || !b.known || !(a.uncertain || b.uncertain || a.likely != b.likely)) continue;
      there[axis] -= stride / 2;
      const std::size_t middle = result.cell_at(there);
      if (requested_replicates(result, middle) == 0) cells.insert(middle);
    }
}

}  // namespace

std::vector<std::size_t> next_round(const SweepResult& result, const RefinementRule& rule) {
  std::vector<Belief> beliefs;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell)
    beliefs.push_back(belief(result, rule, cell));
  std::set<std::size_t> cells;
  for (std::size_t cell = 0; cell < beliefs.size(); ++cell) {
    if (beliefs[cell].known && beliefs[cell].uncertain) cells.insert(cell);
    add_between(result, beliefs, rule.strides, cell, cells);
  }
  std::vector<std::size_t> order(cells.begin(), cells.end());
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return requested_replicates(result, a) < requested_replicates(result, b);
  });

  const auto spent =
      static_cast<std::uint64_t>(std::count_if(result.state.begin(), result.state.end(), [](RunState state) {
        return state != RunState::not_sampled;
      }));
  std::vector<std::size_t> runs;
  for (const std::size_t cell : order) {
    const int from = requested_replicates(result, cell),
              to = std::min(from + rule.first_replicates, result.replicates);
    for (int replicate = from; replicate < to && spent + runs.size() < rule.budget; ++replicate)
      runs.push_back(result.run(cell, replicate));
  }
  std::sort(runs.begin(), runs.end());
  return runs;
}

}  // namespace remote_touch
