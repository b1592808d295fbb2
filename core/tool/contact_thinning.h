// Fewer contacts where there are more than the motion needs.
#pragma once

#include <cstdint>
#include <vector>

#include "core/tool/motion_program.h"

namespace remote_touch {

// Keeps the deepest contact of every cell of the tool frame and octant of directions. Allocates on
// construction only.
class ContactThinning {
 public:
  // Far more cells than a tool of a hand's size has within reach of a surface; what comes later is dropped.
  static constexpr std::size_t kMostCells = 4096;  // a power of two
  static constexpr std::size_t kNowhere = ~std::size_t{0};

  ContactThinning() : slots_(kMostCells) {}
  // In place, in the order of the first contact of each cell.
  void thin(std::vector<ToolContact>& contacts, double cell_m);

  // The same one by one, for contacts that need not exist yet: where in the thinned list a contact belongs,
  // behind its end or in the place of one less deep, or kNowhere. Of n_T only the signs count.
  void begin(double cell_m);
  std::size_t place(const Vec3& r_T, const Vec3& n_T, double depth_m);

 private:
  struct Slot {
    std::uint64_t key = 0;
    double depth_m = 0;
    std::uint32_t place = 0;  // in the thinned list
    std::uint32_t stamp = 0;  // of the list that it belongs to
  };
  Slot* slot_of(std::uint64_t key);

  std::vector<Slot> slots_;
  double cell_m_ = 1;
  std::uint32_t stamp_ = 0, kept_ = 0;
};

// Which cube of a grid over the tool frame a place lies in, as one number.
std::uint64_t cell_number(const Vec3& p_T, double cell_m);

}  // namespace remote_touch
