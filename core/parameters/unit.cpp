#include "core/parameters/unit.h"

#include <algorithm>

namespace remote_touch {

namespace {

constexpr Unit kUnits[] = {
    {"_m_per_s2", "m/s^2", {1, -2, 0}},
    {"_m_per_s", "m/s", {1, -1, 0}},
    {"_N_per_m3", "N/m^3", {-3, 0, 1}},
    {"_N_per_m", "N/m", {-1, 0, 1}},
    {"_Ns_per_m", "N s/m", {-1, 1, 1}},
    {"_N_per_s", "N/s", {0, -1, 1}},
    {"_Nm_per_rad", "N m/rad", {1, 0, 1}},
    {"_Nms_per_rad", "N m s/rad", {1, 1, 1}},
    {"_deg_per_s", "deg/s", {0, -1, 0}},
    {"_per_min", "1/min", {0, -1, 0}},
    {"_per_m", "1/m", {-1, 0, 0}},
    {"_per_s", "1/s", {0, -1, 0}},
    {"_m", "m", {1, 0, 0}},
    {"_s", "s", {0, 1, 0}},
    {"_hz", "Hz", {0, -1, 0}},
    {"_Nm", "N m", {1, 0, 1}},
    {"_N", "N", {0, 0, 1}},
    {"_Ns", "N s", {0, 1, 1}},
    {"_kg_m2", "kg m^2", {1, 2, 1}},
    {"_kg", "kg", {-1, 2, 1}},
    {"_deg", "deg", {}},
    {"_rad", "rad", {}},
    {"_px", "px", {}},
    {"_fraction", "1", {}},
    {"_ratio", "1", {}},
    {"_probability", "1", {}},
    {"_direction", "1", {}},
};

}  // namespace

std::span<const Unit> known_units() {
  return kUnits;
}

const Unit* unit_of(const std::string& name) {
  const auto* const found =
      std::ranges::find_if(kUnits, [&](const Unit& unit) { return name.ends_with(unit.ending); });
  return found == std::end(kUnits) ? nullptr : found;
}

}  // namespace remote_touch
