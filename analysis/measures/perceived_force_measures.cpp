#include "analysis/measures/perceived_force_measures.h"

#include "analysis/measures/no_value.h"
#include "analysis/statistics/mean.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

bool is_felt(const Vec3& before_N, const Vec3& after_N, double weber) {
  return (after_N - before_N).norm() > weber * before_N.norm();
}

}  // namespace

double felt_jump_fraction(const Trace& trace, double weber) {
  const std::vector<Vec3>& force_N = trace.force_N;
  return mean_where(
      trace.length(),
      [&](std::size_t i) {
        return trace.frame_update(i) && !(force_N[i - 1].isZero(0) && force_N[i].isZero(0));
      },
      [&](std::size_t i) {
        const bool is_known = force_N[i - 1].allFinite() && force_N[i].allFinite();
        return is_known ? is_felt(force_N[i - 1], force_N[i], weber) : kNoValue;
      });
}

// The last tick has no successor, so its duration is assumed to be the mean of the others.
double deadband_packets_per_s(const Trace& trace, double weber) {
  if (trace.length() < 2) return kNoValue;
  const double intervals = static_cast<double>(trace.length() - 1);
  const double duration_s = (trace.time_s.back() - trace.time_s.front()) * (intervals + 1) / intervals;
  double packets = 1;
  Vec3 sent_N = trace.force_N.front();
  for (const Vec3& force_N : trace.force_N) {
    if (!force_N.allFinite()) return kNoValue;
    if (is_felt(sent_N, force_N, weber)) sent_N = force_N, ++packets;
  }
  return packets / duration_s;
}

}  // namespace remote_touch
