#include "runners/evaluation/verification/output_comparison.h"

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
  // The squares of the smallest numbers would underflow.
  return std::hypot(difference(a.x(), b.x()), difference(a.y(), b.y()), difference(a.z(), b.z()));
}

// Returns the rotation between the two tools, in radians for small angles; 0 without a tool. Infinite if an
// orientation is not finite, or if only one output has a tool.
double rotation_between(const RenderOutput& a, const RenderOutput& b) {
  if (!a.tool && !b.tool) return 0;
  if (!a.tool || !b.tool) return std::numeric_limits<double>::infinity();
  const Eigen::Vector4d &p = a.tool->orientation_W.coeffs(), &q = b.tool->orientation_W.coeffs();
  if (!p.allFinite() || !q.allFinite()) return std::numeric_limits<double>::infinity();
  return 2 * std::min((p - q).norm(), (p + q).norm());  // q and -q are one rotation
}

double penetration_difference(const RenderOutput& a, const RenderOutput& b) {
  return a.tool && b.tool ? difference(a.tool->tool_penetration_m, b.tool->tool_penetration_m) : 0;
}

double torque_difference(const RenderOutput& a, const RenderOutput& b) {
  return a.tool && b.tool ? difference(a.tool->torque_Nm, b.tool->torque_Nm) : 0;
}

bool tools_agree(const RenderOutput& a, const RenderOutput& b, bool rounded) {
  if (!a.tool || !b.tool) return a.tool.has_value() == b.tool.has_value();
  return rounded ||
         (a.tool->active_constraints == b.tool->active_constraints &&
          a.tool->contact_clusters == b.tool->contact_clusters && a.tool->detections == b.tool->detections &&
          a.tool->budget_exhausted == b.tool->budget_exhausted &&
          a.tool->disabled_points == b.tool->disabled_points);
}

bool others_agree(const RenderOutput& a, const RenderOutput& b, bool rounded) {
  if (!tools_agree(a, b, rounded)) return false;
  return a.state == b.state && a.converged == b.converged && a.contact_count == b.contact_count &&
         a.frame_index == b.frame_index && a.status == b.status && (rounded || a.steps == b.steps);
}

constexpr std::size_t kQuantities = 8;

std::array<double, kQuantities> differences(const RenderOutput& a, const RenderOutput& b,
                                            const OutputTolerance& tolerance) {
  const bool rounded = tolerance.rounded;
  // Far from the points the weights of a normal are as small as their own rounding.
  const bool normal_counts =
      !tolerance.without_contact_details && (!rounded || a.state != ContactState::free);
  const double nearest =
      tolerance.without_contact_details ? 0 : difference(a.nearest_distance_m, b.nearest_distance_m);
  return {std::max({difference(a.proxy_W, b.proxy_W), difference(a.frame_correction_m, b.frame_correction_m),
                    difference(a.slave_W, b.slave_W)}),
          std::max(nearest, penetration_difference(a, b)),
          difference(a.force_N, b.force_N),
          difference(a.surface_velocity_m_per_s, b.surface_velocity_m_per_s),
          normal_counts ? difference(a.normal_W, b.normal_W) : 0,
          rotation_between(a, b),
          torque_difference(a, b),
          tolerance.without_contact_details || others_agree(a, b, rounded) ? 0.0 : 1.0};
}

std::vector<Deviation> none_yet(const std::vector<RenderOutput>& expected, const OutputTolerance& tolerance) {
  double max_force_N = 0, max_torque_Nm = 0;
  for (const RenderOutput& out : expected) {
    max_force_N = std::max(max_force_N, out.force_N.norm());
    if (out.tool) max_torque_Nm = std::max(max_torque_Nm, out.tool->torque_Nm.norm());
  }
  return {{"position", "m", tolerance.position_m},
          {"nearest", "m", tolerance.position_m},
          {"force", "N", tolerance.force_fraction * max_force_N},
          {"velocity", "m/s", tolerance.velocity_m_per_s},
          {"normal", "1", tolerance.normal},
          {"rotation", "rad", tolerance.rotation_rad},
          {"torque", "Nm", tolerance.torque_fraction * max_torque_Nm},
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
    const auto now = differences(a, b, tolerance);
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
