#include "scenarios/synthetic/open_box.h"

namespace remote_touch {

Parameters parameters(OpenBox::Settings& s) {
  return {
      {"size_m", &s.size_m, 0, 10, "inner size along x, y (up) and z; the middle of the box is the origin"},
      {"spacing_m", &s.spacing_m, 1e-4, 1, "distance between neighbouring points"},
      {"floor", &s.floor, 0, 1, "true: four walls and a floor; false: the four walls only"},
  };
}

std::vector<FlatPanel> OpenBox::panels(double) const {
  const Vec3 half = 0.5 * settings_.size_m;
  std::vector<FlatPanel> sides;
  for (const double side : {-1.0, 1.0})
    sides.push_back(
        {side * half.x() * Vec3::UnitX(), -side * Vec3::UnitX(), Vec3::UnitZ(), half.z(), half.y()});
  for (const double side : {-1.0, 1.0})
    sides.push_back(
        {side * half.z() * Vec3::UnitZ(), -side * Vec3::UnitZ(), Vec3::UnitX(), half.x(), half.y()});
  if (settings_.floor)
    sides.push_back({-half.y() * Vec3::UnitY(), Vec3::UnitY(), Vec3::UnitX(), half.x(), half.z()});
  return sides;
}

}  // namespace remote_touch
