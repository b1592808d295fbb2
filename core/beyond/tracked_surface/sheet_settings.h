// Settings of the search for a sheet, and of the noise reduction of its points.
#pragma once

#include <string>

#include "core/parameters/parameter.h"

namespace remote_touch {

struct SheetSettings {
  double gate_m = 0.015, initial_gate_m = 0.035, max_gate_m = 0.075;
  int max_missed_frames = 1;
  bool denoise = true;
};

Parameters parameters(SheetSettings& s);
std::string validate(const SheetSettings& s);

}  // namespace remote_touch
