#include "analysis/measures/lateral_force_measures.h"

#include <cmath>
#include <vector>

#include "analysis/measures/no_value.h"
#include "analysis/statistics/mean.h"
#include "analysis/trace/trace.h"
#include "core/numeric/order_statistic.h"

namespace remote_touch {

namespace {

// The force of a tick along the true normal, and its magnitude along the surface.
struct Parts {
  double along_normal_N = 0, lateral_N = 0;
};

std::vector<Parts> parts_in_contact(const Trace& trace) {
  std::vector<Parts> list;
  for (std::size_t i = 0; i < trace.true_normal.size(); ++i) {
    const Vec3& normal = trace.true_normal[i];
    const Vec3 force_N =
        trace.has_guidance() ? Vec3(trace.force_N[i] - trace.guidance_force_N[i]) : trace.force_N[i];
    const bool touches = trace.state[i] != static_cast<std::int32_t>(ContactState::free);
    if (!touches || !normal.allFinite() || !force_N.allFinite() || force_N.isZero(0)) continue;
    const double along_normal_N = force_N.dot(normal);
    list.push_back({along_normal_N, (force_N - along_normal_N * normal).norm()});
  }
  return list;
}

// The ratios of the ticks in which the force pushes out of the surface.
std::vector<double> lateral_ratios(const Trace& trace) {
  std::vector<double> ratios;
  for (const Parts& parts : parts_in_contact(trace)) {
    const double ratio = parts.lateral_N / parts.along_normal_N;
    if (parts.along_normal_N > 0 && std::isfinite(ratio)) ratios.push_back(ratio);
  }
  return ratios;
}

}  // namespace

double mean_lateral_force(const Trace& trace) {
  return mean(lateral_ratios(trace));
}

double lateral_force_95(const Trace& trace) {
  std::vector<double> ratios = lateral_ratios(trace);
  return ratios.empty() ? kNoValue : quantile_in_place(ratios, 0.95);
}

double mean_force_angle_rad(const Trace& trace) {
  std::vector<double> angles_rad;
  for (const Parts& parts : parts_in_contact(trace))
    angles_rad.push_back(std::atan2(parts.lateral_N, parts.along_normal_N));
  return mean(angles_rad);
}

}  // namespace remote_touch
