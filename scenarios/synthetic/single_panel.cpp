#include "scenarios/synthetic/single_panel.h"

namespace remote_touch {

Parameters parameters(SinglePanel::Settings& s) {
  return {
      {"centre_m", &s.centre_m, -100, 100, "middle of the panel"},
      {"normal", &s.normal, -1, 1, "towards the side that the sensor sees; any length"},
      {"width_m", &s.width_m, 1e-3, 10,
       "size along the horizontal direction of the panel; x where it lies flat"},
      {"height_m", &s.height_m, 1e-3, 10, "size along the other direction of the panel"},
      {"spacing_m", &s.spacing_m, 1e-4, 1, "distance between neighbouring points"},
  };
}

std::vector<FlatPanel> SinglePanel::panels(double) const {
  const Vec3 normal = settings_.normal.normalized(), level = Vec3::UnitY().cross(normal);
  const Vec3 u =
      level.norm() > 1e-6 ? Vec3(level.normalized()) : (Vec3::UnitX() - normal.x() * normal).normalized();
  return {{settings_.centre_m, normal, u, 0.5 * settings_.width_m, 0.5 * settings_.height_m}};
}

}  // namespace remote_touch
