// Reduces the number of contacts if there are more than the motion needs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/motion_program.h"
#include "core/points/vector.h"

namespace remote_touch {

// Groups contacts by the cell of the tool frame in which they lie and by the octant of their normal.
// Allocates on construction only.
class ContactThinning {
 public:
  // Size of the table of cells: far more cells than a hand-sized tool has within reach of a surface. A cell
  // for which the table has no room has the number kNoCell.
  static constexpr std::size_t kSlots = 4096;  // a power of two
  static constexpr std::size_t kNoCell = ~std::size_t{0};

  ContactThinning() : slots_(kSlots) {}

  void begin();
  // Returns the number of a cell. Cells are numbered 0, 1, 2 ... in the order in which they occur after
  // begin(). Returns kNoCell if the table has no room near the slot of the cell.
  std::size_t cell(std::uint64_t cell_and_octant) {
    const Slot& first = slots_[first_slot(cell_and_octant)];
    return first.stamp == stamp_ && first.key == cell_and_octant ? first.cell : find_cell(cell_and_octant);
  }

  // Keeps the deepest contact of every cell, in place, if there are more than `max` contacts, and repeats
  // this with larger cells until there are no more than `max`. The first cells have the size kCell_m. A step
  // rotates the tool so little that two points 4 mm apart require the same motion within a tenth of a
  // millimetre, and the next detection finds the dropped points. Cells are used because contacts must stay
  // spread over the tool.
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

// Returns the number of the cube in which a position lies, in a grid over the tool frame. The numbers repeat
// after 2^20 cubes along an axis.
std::uint64_t cell_number(const Vec3& p_T, double cells_per_m);
// Returns the same number, combined with the signs of a direction's coordinates.
std::uint64_t cell_and_octant(const Vec3& p_T, const Vec3& direction_T, double cells_per_m);

// Merges neighbouring points of a cloud that are so nearly flat that one disk can represent all of them. Not
// in the dissertation.

struct CloudPoint {
  Vec3 p_W, n_W;     // NaN: no normal
  double spacing_m;  // distance to its neighbours; 0: not known
};

// A point of the cloud if extent_m is 0. Otherwise a disk that represents all points in a cube of a grid over
// the world. It lies in their middle and has their mean normal. These conditions hold:
// - none of the points is farther from the middle than extent_m;
// - each of them, and the rim of a disk of one spacing around it, lies within kFlat_m of its plane;
// - the cloud covers it: every square of a grid within extent_m of the middle contains a point of this or a
//   neighbouring cube, so that the disk does not reach beyond an edge or over a hole. The squares are 1.5
//   spacings wide or somewhat wider. Points that would need more than 32 squares along a side are not merged.
struct PointOrDisk {
  Vec3 p_W, n_W;
  double spacing_m, extent_m;
};

inline constexpr double kFlat_m = 5e-6;
// Points are not merged if their median spacing is larger than this.
inline constexpr double kMaxMergedSpacing_m = 6e-4;

// Returns an empty list if merging would not save half of the points.
std::vector<PointOrDisk> merged_points(std::span<const CloudPoint> points, double cube_m);  // pre: above 0

}  // namespace remote_touch
