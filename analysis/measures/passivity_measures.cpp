#include "analysis/measures/passivity_measures.h"

#include <algorithm>
#include <vector>

#include "analysis/measures/no_value.h"
#include "analysis/statistics/extremes.h"
#include "analysis/statistics/mean.h"
#include "analysis/trace/trace.h"
#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

// Work that the device does on the hand from tick i to tick i + 1.
double work_J(const Trace& trace, std::size_t i) {
  const auto& position_m = trace.has_rounded_hand() ? trace.hand_position_m : trace.hip_position_m;
  const Vec3& force_N = trace.has_hand() ? trace.device_force_N[i] : trace.force_N[i];
  const double by_force = force_N.dot(position_m[i + 1] - position_m[i]);
  if (!trace.has_tool()) return by_force;
  const auto& orientation = trace.has_rounded_hand() ? trace.hand_orientation : trace.hip_orientation;
  const Vec3& torque_Nm = trace.has_hand() ? trace.device_torque_Nm[i] : trace.torque_Nm[i];
  return by_force + torque_Nm.dot(rotation_vector(orientation[i + 1] * orientation[i].conjugate()));
}

// True if the hand feels a wrench in tick i. It feels no command for which the device has no motor.
bool has_wrench(const Trace& trace, std::size_t i) {
  if (trace.has_hand())
    return !trace.device_force_N[i].isZero(0) || (trace.has_tool() && !trace.device_torque_Nm[i].isZero(0));
  return !trace.force_N[i].isZero(0) || (trace.has_tool() && !trace.torque_Nm[i].isZero(0));
}

// The work from each frame update to the next one, if the hand feels a force or a torque in between.
std::vector<double> work_between_updates_J(const Trace& trace) {
  std::vector<double> pieces;
  double work = 0;
  bool begun = false, felt = false;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.frame_update(i)) {
      if (begun && felt) pieces.push_back(work);
      work = 0, begun = true, felt = false;
    }
    felt |= has_wrench(trace, i);
    if (i + 1 < trace.length()) work += work_J(trace, i);
  }
  return pieces;
}

}  // namespace

double energy_injected_J(const Trace& trace) {
  double given = 0;
  for (std::size_t i = 0; i + 1 < trace.length(); ++i) given += work_J(trace, i);
  return given;
}

double max_energy_injected_J(const Trace& trace) {
  double given = 0, max = 0;
  for (std::size_t i = 0; i + 1 < trace.length(); ++i) {
    given += work_J(trace, i);
    max = max_or_nan(max, given);
  }
  return max;
}

double mean_energy_per_update_J(const Trace& trace) {
  return mean(work_between_updates_J(trace));
}

double max_energy_per_update_J(const Trace& trace) {
  const std::vector<double> pieces = work_between_updates_J(trace);
  return max_of(pieces);
}

double min_channel_energy_J(const Trace& trace) {
  if (!trace.has_channel_energy()) return kNoValue;
  double lowest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    lowest = min_or_nan(lowest, trace.hand_energy_in_J[i] - trace.hand_energy_out_J[i] +
                                    trace.slave_energy_in_J[i] - trace.slave_energy_out_J[i]);
  return lowest;
}

double dissipated_energy_J(const Trace& trace) {
  return trace.has_channel_energy() ? trace.dissipated_energy_J.back() : kNoValue;
}

}  // namespace remote_touch
