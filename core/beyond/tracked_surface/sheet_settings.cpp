#include "core/beyond/tracked_surface/sheet_settings.h"

namespace remote_touch {

Parameters parameters(SheetSettings& s) {
  return {
      {"gate_m", &s.gate_m, 1e-4, 1, "search range around the predicted position of the sheet"},
      {"initial_gate_m", &s.initial_gate_m, 1e-4, 1,
       "search range for a new sheet, and for one not found within gate_m"},
      {"max_gate_m", &s.max_gate_m, 1e-4, 1, "maximum search range; a sheet not found within it is lost"},
      {"max_missed_frames", &s.max_missed_frames, 0, 100,
       "maximum number of successive frames without the sheet; after more, a proxy in contact is released"},
      {"denoise", &s.denoise, 0, 1, "remove the noise from the points of the sheet"},
  };
}

std::string validate(const SheetSettings& s) {
  const auto line = [](const char* name, double value, const char* other, double min) {
    return std::string(name) + " = " + std::to_string(value) + ": expected at least " + other + " = " +
           std::to_string(min);
  };
  if (s.initial_gate_m < s.gate_m) return line("initial_gate_m", s.initial_gate_m, "gate_m", s.gate_m);
  if (s.max_gate_m < s.initial_gate_m)
    return line("max_gate_m", s.max_gate_m, "initial_gate_m", s.initial_gate_m);
  return {};
}

}  // namespace remote_touch
