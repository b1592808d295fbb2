#include "runners/regression/verification/output_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

double difference(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;  // two infinities too
  const double d = std::abs(a - b);
  return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

double difference(const Vec3& a, const Vec3& b) {
  // Squares of the smallest numbers would vanish.
  return std::hypot(difference(a.x(), b.x()), difference(a.y(), b.y()), difference(a.z(), b.z()));
}

bool others_agree(const RenderOutput& a, const RenderOutput& b, bool rounded) {
  return a.state == b.state && a.converged == b.converged && a.contact_count == b.contact_count &&
         a.frame_index == b.frame_index && a.status == b.status && (rounded || a.steps == b.steps);
}

constexpr std::size_t kQuantities = 6;

std::array<double, kQuantities> differences(const RenderOutput& a, const RenderOutput& b, bool rounded) {
  // Far from the points the weights of a normal are as small as their own rounding.
  const bool normal_counts = !rounded || a.state != ContactState::free;
  return {std::max({difference(a.proxy_W, b.proxy_W), difference(a.frame_correction_m, b.frame_correction_m),
                    difference(a.slave_W, b.slave_W)}),
          difference(a.nearest_distance_m, b.nearest_distance_m),
          difference(a.force_N, b.force_N),
          difference(a.surface_velocity_m_per_s, b.surface_velocity_m_per_s),
          normal_counts ? difference(a.normal_W, b.normal_W) : 0,
          others_agree(a, b, rounded) ? 0.0 : 1.0};
}

std::vector<Deviation> none_yet(const std::vector<RenderOutput>& expected, const OutputTolerance& tolerance) {
  double max_force_N = 0;
  for (const RenderOutput& out : expected) max_force_N = std::max(max_force_N, out.force_N.norm());
  return {{"position", "m", tolerance.position_m},
          {"nearest", "m", tolerance.position_m},
          {"force", "N", tolerance.force_fraction * max_force_N},
          {"velocity", "m/s", tolerance.velocity_m_per_s},
          {"normal", "1", tolerance.normal},
          {"other", "1", 0}};
}

}  // namespace

Comparison compare(const std::vector<RenderOutput>& expected, const std::vector<RenderOutput>& outputs,
                   const OutputTolerance& tolerance, bool until_velocity) {
  Comparison result{.deviations = none_yet(expected, tolerance)};
  for (std::size_t tick = 0; tick < outputs.size(); ++tick) {
    const RenderOutput &a = expected[tick], &b = outputs[tick];
    if (until_velocity && (a.surface_velocity_m_per_s != 0 || b.surface_velocity_m_per_s != 0)) break;
    result.ticks = static_cast<int>(tick) + 1;
    const auto now = differences(a, b, tolerance.rounded);
    for (std::size_t i = 0; i < kQuantities; ++i) {
      Deviation& deviation = result.deviations[i];
      deviation.max = std::max(deviation.max, now[i]);
      if (now[i] > deviation.tolerance && result.first_violation < 0)
        result.first_violation = static_cast<int>(tick);
    }
  }
  return result;
}

}  // namespace remote_touch
