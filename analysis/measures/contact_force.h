// The force of contact on the hand in a tick, and whether there is one.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// Returns the force on the hand without the part of guidance, which may pull in any direction, N, world
// frame.
inline Vec3 contact_force_N(const Trace& trace, std::size_t i) {
  return trace.has_guidance() ? Vec3(trace.force_N[i] - trace.guidance_force_N[i]) : trace.force_N[i];
}

inline Vec3 contact_torque_Nm(const Trace& trace, std::size_t i) {
  return trace.has_guidance() ? Vec3(trace.torque_Nm[i] - trace.guidance_torque_Nm[i]) : trace.torque_Nm[i];
}

// True if the vector is a force: neither zero nor unknown. An unknown force (NaN) is no force, so that it
// never counts as contact; non_finite_fraction() counts it.
inline bool is_force(const Vec3& force_N) {
  return force_N.allFinite() && !force_N.isZero(0);
}
inline bool has_contact_force(const Trace& trace, std::size_t i) {
  return is_force(contact_force_N(trace, i));
}

}  // namespace remote_touch
