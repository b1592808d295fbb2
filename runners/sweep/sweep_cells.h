// Cells of a sweep's grid: those that are checked before the first run, and those of the first round.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "runners/sweep/sweep_axis.h"

namespace remote_touch {

inline constexpr std::size_t kMaxChecked = 20000;

// Returns all cells of a grid that has at most kMaxChecked. Of a larger one it returns kMaxChecked cells that
// are spread over the grid, and each cell with one value of an axis and the first values of the others (the
// first kMaxChecked values of an axis). Increasing.
std::vector<std::size_t> checked_cells(const SweepResult& grid);

// The cells of the first round: all, or with refinement each stride-th along each axis. They are counted from
// 0 in the order of their numbers.
class FirstRound {
 public:
  // Both must exist as long as this object.
  FirstRound(const SweepResult& grid, const std::vector<SweepAxis>& axes) : grid_(grid), axes_(axes) {}
  std::size_t count() const;
  std::size_t cell(std::size_t number) const;  // the number of the cell in the grid

 private:
  std::size_t nodes(std::size_t axis) const { return (axes_[axis].length() - 1) / axes_[axis].stride + 1; }
  const SweepResult& grid_;
  const std::vector<SweepAxis>& axes_;
};

}  // namespace remote_touch
