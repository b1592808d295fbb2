// Vendors' codes in words that live as long as the program; their own texts need not.
#pragma once

#include <span>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

struct KnownFault {
  int code;
  const char* what;
};

// With the code; what: where the code is not among those known.
inline DeviceFault fault_of(std::span<const KnownFault> known, int code, const char* what) {
  for (const KnownFault& fault : known)
    if (fault.code == code) what = fault.what;
  return {what, code};
}

inline constexpr DeviceFault kNoRotation{"the device tells of a turn that is no rotation", 0};

}  // namespace remote_touch
