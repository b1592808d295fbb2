// Reduces the number of contacts if there are more than the motion needs.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dissertation/tool/dynamics/motion_program.h"

namespace remote_touch {

// Sorts contacts by the cell of the tool frame and the octant of directions that they belong to. Allocates on
// construction only.
class ContactThinning {
 public:
  // Limit of the number of cells, far more than a tool of a hand's size has within reach of a surface.
  // Further cells get kNoCell.
  static constexpr std::size_t kMaxCells = 4096;  // a power of two
  static constexpr std::size_t kNoCell = ~std::size_t{0};

  ContactThinning() : slots_(kMaxCells) {}

  void begin();
  // Returns the number of a cell: 0, 1, 2 ... in the order in which they are met after begin(), or kNoCell if
  // the table is crowded.
  std::size_t cell(std::uint64_t cell_and_octant) {
    const Slot& first = slots_[first_slot(cell_and_octant)];
    return first.stamp == stamp_ && first.key == cell_and_octant ? first.cell : find_cell(cell_and_octant);
  }

  // Keeps the deepest contact of every cell, in place, until there are no more than `max` contacts. The cells
  // have the size kCell_m at first: a step rotates the tool so little that two points 4 mm apart require the
  // same motion within a tenth of a millimetre, and the next detection finds the dropped points. Then the
  // cells become larger, because contacts must stay spread over the tool.
  static constexpr double kCell_m = 4e-3;
  static constexpr auto kMaxCount = static_cast<std::size_t>(MotionProgram::kMaxContacts);
  void thin(std::vector<ToolContact>& contacts, std::size_t max = kMaxCount);

 private:
  void thin_in_cells(std::vector<ToolContact>& contacts, double cell_m);
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t cell = 0;
    std::uint32_t stamp = 0;  // number of the begin() that the slot belongs to
  };
  static std::size_t first_slot(std::uint64_t key) { return (key * 0x9e3779b97f4a7c15u) >> 52; }
  Slot* slot_of(std::uint64_t key);
  std::size_t find_cell(std::uint64_t key);

  std::vector<Slot> slots_;
  std::uint32_t stamp_ = 0, cells_ = 0;
};

// Returns the number of the cube of a grid over the tool frame in which a position lies.
std::uint64_t cell_number(const Vec3& p_T, double cells_per_m);
// Returns the same number, combined with the signs of a direction's coordinates.
std::uint64_t cell_and_octant(const Vec3& p_T, const Vec3& direction_T, double cells_per_m);

}  // namespace remote_touch
