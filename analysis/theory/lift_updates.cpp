#include "analysis/theory/lift_updates.h"

#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

double plane_height(const Trace& trace, std::size_t i, const Vec3& normal) {
  return trace.proxy_position_m[i].dot(normal) - trace.signed_distance_m[i];
}

// Returns the normal that (4.3) used. If (4.3) moved nothing, it is the normal with which the tick before
// ended.
Vec3 normal_of_update(const Trace& trace, std::size_t first_tick) {
  const Vec3 frame_correction = trace.frame_correction_m[first_tick];
  return frame_correction.isZero(0) ? trace.normal[first_tick - 1] : Vec3(frame_correction.normalized());
}

}  // namespace

std::vector<LiftUpdate> lift_updates(const Trace& trace, const Vec3& normal, double r1_m,
                                     double frame_rate_hz) {
  std::vector<LiftUpdate> updates;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (!trace.frame_update(i)) continue;
    if (!updates.empty()) updates.back().above_after = trace.signed_distance_m[i - 1] > 0;
    LiftUpdate update;
    update.frame = trace.frame_index[i];
    update.velocity_m_per_s =
        (plane_height(trace, i, normal) - plane_height(trace, i - 1, normal)) * frame_rate_hz;
    update.estimate_m_per_s = trace.surface_velocity_m_per_s[i - 1];
    update.thickness_m = trace.signed_distance_m[i - 1] - r1_m;
    update.normal_error = 1 - normal.dot(normal_of_update(trace, i));
    update.frame_correction_m = trace.frame_correction_m[i].dot(normal);
    update.above_before = trace.signed_distance_m[i - 1] > 0;
    updates.push_back(update);
  }
  if (!updates.empty()) updates.back().above_after = trace.signed_distance_m.back() > 0;
  return updates;
}

}  // namespace remote_touch
