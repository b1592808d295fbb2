#include "scenarios/synthetic/slot.h"

namespace remote_touch {

Parameters parameters(Slot::Settings& s) {
  return {
      {"width_m", &s.width_m, 1e-3, 10, "distance between the walls, along z"},
      {"length_m", &s.length_m, 1e-3, 10, "length of the walls, along x"},
      {"height_m", &s.height_m, 1e-3, 10, "height of the walls, along y"},
      {"spacing_m", &s.spacing_m, 1e-4, 1, "distance between neighbouring points"},
      {"phase_m", &s.phase_m, -1, 1, "offset of the points along x"},
  };
}

std::vector<FlatPanel> Slot::panels(double) const {
  std::vector<FlatPanel> walls;
  for (const double side : {-1.0, 1.0})
    walls.push_back({side * 0.5 * settings_.width_m * Vec3::UnitZ(), -side * Vec3::UnitZ(), Vec3::UnitX(),
                     0.5 * settings_.length_m, 0.5 * settings_.height_m});
  return walls;
}

}  // namespace remote_touch
