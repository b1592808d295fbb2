#include "runners/sweep/sweep_cells.h"

#include <algorithm>

namespace remote_touch {

std::vector<std::size_t> checked_cells(const SweepResult& grid) {
  const std::size_t all = grid.cell_count(), spread = std::min(all, kMaxChecked);
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < spread; ++i)
    cells.push_back(static_cast<std::size_t>(static_cast<unsigned __int128>(i) * all / spread));
  if (spread == all) return cells;
  cells.push_back(all - 1);
  for (std::size_t axis = 0; axis < grid.axes.size(); ++axis)
    for (std::size_t i = 1; i < std::min(grid.axes[axis].length(), kMaxChecked); ++i) {
      std::vector<std::size_t> indices(grid.axes.size(), 0);
      indices[axis] = i;
      cells.push_back(grid.cell_at(indices));
    }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::size_t FirstRound::count() const {
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) count *= nodes(axis);
  return count;
}

std::size_t FirstRound::cell(std::size_t number) const {
  std::vector<std::size_t> indices(axes_.size());
  for (std::size_t axis = axes_.size(); axis-- > 0; number /= nodes(axis))
    indices[axis] = number % nodes(axis) * axes_[axis].stride;
  return grid_.cell_at(indices);
}

}  // namespace remote_touch
