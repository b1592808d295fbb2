// The force of contact on the hand in a tick.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// Returns the force on the hand without the part of guidance, which may pull in any direction, N, world
// frame.
inline Vec3 contact_force_N(const Trace& trace, std::size_t i) {
  return trace.has_guidance() ? Vec3(trace.force_N[i] - trace.guidance_force_N[i]) : trace.force_N[i];
}

}  // namespace remote_touch
