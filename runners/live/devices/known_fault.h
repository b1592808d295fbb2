// Texts for vendors' error codes. They are valid for the whole run of the program; the vendors' own texts may
// not be.
#pragma once

#include <span>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

struct KnownFault {
  int code;
  const char* what;
};

// Returns the fault of this code with its known text. what: the text for an unknown code.
inline DeviceFault fault_of(std::span<const KnownFault> known, int code, const char* what) {
  for (const KnownFault& fault : known)
    if (fault.code == code) what = fault.what;
  return {what, code};
}

inline constexpr DeviceFault kNoRotation{"the device reports an orientation that is not a rotation", 0};

}  // namespace remote_touch
