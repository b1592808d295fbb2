// Traces whose measures are known, made by hand.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "tests/analysis/trace/measure_named.h"

namespace remote_touch::example_traces {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
inline const Vec3 kUnknownVector = Vec3::Constant(kUnknown);

// What the measures use of a tick. Parts without a value are not in the trace.
struct Tick {
  Vec3 force_N = Vec3::Zero();
  int frame = 0;
  Vec3 hip_m = Vec3::Zero();
  Eigen::Quaterniond hip_orientation = Eigen::Quaterniond::Identity();
  ContactState state = ContactState::contact;
  double distance_m = 0.005,
         nearest_m = 0.005;  // from the proxy to the true surface, and to the nearest point
  int contacts = 0, steps = 1;
  bool converged = true;
  std::optional<Vec3> torque_Nm = {};   // a tool has one
  std::optional<Vec3> guidance_N = {};  // the part of the force that is guidance
  std::optional<Vec3> device_N = {};    // exerted on the hand
  std::optional<Trace::TrueContact> contact = {};
  std::optional<Vec3> normal = {}, expected_N = {};
  std::optional<double> measured_m = {};
};

inline Tick pushed(double force_y_N, int frame = 0) {
  return {.force_N = {0, force_y_N, 0}, .frame = frame};
}

inline Trace run_of(const std::vector<Tick>& ticks, double tick_s = 0.001) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = tick.force_N, out.frame_index = tick.frame, out.state = tick.state;
    out.nearest_distance_m = tick.nearest_m, out.contact_count = tick.contacts;
    out.steps = tick.steps, out.converged = tick.converged;
    if (tick.torque_Nm) out.tool.emplace().torque_Nm = *tick.torque_Nm;
    if (tick.guidance_N) out.guidance.emplace().force_N = *tick.guidance_N;
    DeviceState device{tick.hip_m};
    device.orientation_W = tick.hip_orientation;
    std::optional<HandState> hand;
    if (tick.device_N) hand.emplace().force_N = *tick.device_N;
    trace.append(
        tick_s * static_cast<double>(trace.length()), device, out,
        {tick.distance_m, tick.distance_m, 0, tick.contact, tick.normal, tick.expected_N, tick.measured_m},
        hand);
  }
  return trace;
}

inline double value(const std::string& measure, const Trace& trace) {
  return value_of(measure_named(measure), trace);
}

// Checks the values of these measures; NaN: there is none.
inline void expect_values(const Trace& trace, const std::vector<std::pair<const char*, double>>& expected,
                          double tolerance = 1e-15) {
  for (const auto& [name, number] : expected)
    if (std::isnan(number))
      EXPECT_TRUE(std::isnan(value(name, trace))) << name << ": " << value(name, trace);
    else
      EXPECT_NEAR(value(name, trace), number, tolerance) << name;
}
inline void expect_no_values(const Trace& trace, const std::vector<const char*>& measures) {
  for (const char* name : measures) EXPECT_TRUE(std::isnan(value(name, trace))) << name;
}

}  // namespace remote_touch::example_traces
