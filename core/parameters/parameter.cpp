#include "core/parameters/parameter.h"

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

double scheduled(const std::vector<double>& rows, double time_s) {
  if (rows.empty()) return 1;
  std::size_t next = 0;  // index of the first row after time_s
  while (next < rows.size() && rows[next] <= time_s) next += 2;
  if (next == 0) return rows[1];
  const double before_s = rows[next - 2], before = rows[next - 1];
  if (next == rows.size()) return before;
  return before + (time_s - before_s) / (rows[next] - before_s) * (rows[next + 1] - before);
}

std::string validate_schedule(const std::vector<double>& rows, const std::string& name,
                              const std::string& what) {
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    if (rows[i + 1] > 1) return name + ": " + what + " " + std::to_string(rows[i + 1]) + ": expected 0 to 1";
    if (i > 0 && rows[i] < rows[i - 2])
      return name + ": time " + std::to_string(rows[i]) + ": expected no earlier than the row before";
  }
  return {};
}

}  // namespace remote_touch
