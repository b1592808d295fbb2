#include "analysis/sweeps/refinement.h"

#include <algorithm>
#include <set>

#include "analysis/statistics/proportion.h"

namespace remote_touch {

namespace {

struct Belief {
  bool known = false;      // some run is done
  bool uncertain = false;  // the interval contains 0.5
  bool likely = false;     // more than half of the runs had the event
};

Belief belief(const SweepResult& result, const RefinementRule& rule, std::size_t cell) {
  const Tally t = tally(result, result.measure(rule.measure), cell, rule.threshold);
  const auto [low, high] = wilson_interval(t.events, t.runs);
  return {t.runs > 0, low < 0.5 && high > 0.5, 2 * t.events > t.runs};
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
