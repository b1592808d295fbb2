#include "analysis/measures/perceived_force_measures.h"

#include "analysis/measures/no_value.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

bool is_felt(const Vec3& before_N, const Vec3& after_N, double weber) {
  return (after_N - before_N).norm() > weber * before_N.norm();
}

}  // namespace

double felt_jump_fraction(const Trace& trace, double weber) {
  double felt = 0, updates = 0;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    const Vec3 &before_N = trace.force_N[i - 1], &after_N = trace.force_N[i];
    if (!trace.frame_update(i) || (before_N.isZero(0) && after_N.isZero(0))) continue;
    felt += is_felt(before_N, after_N, weber) ? 1 : 0, ++updates;
  }
  return updates == 0 ? kNoValue : felt / updates;
}

// The last tick has no successor, so its duration is assumed to be the mean of the others.
double deadband_packets_per_s(const Trace& trace, double weber) {
  if (trace.length() < 2) return kNoValue;
  const double intervals = static_cast<double>(trace.length() - 1);
  const double duration_s = (trace.time_s.back() - trace.time_s.front()) * (intervals + 1) / intervals;
  double packets = 1;
  Vec3 sent_N = trace.force_N.front();
  for (const Vec3& force_N : trace.force_N)
    if (is_felt(sent_N, force_N, weber)) sent_N = force_N, ++packets;
  return packets / duration_s;
}

}  // namespace remote_touch
