// What a run leaves behind: one row for each haptic tick.
#pragma once

#include <optional>
#include <vector>

#include "analysis/columns/column.h"
#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// Of a simulated hand, beside the device that it moves: what it wanted, and what it felt.
struct HandState {
  Vec3 intended_W = Vec3::Zero();
  Eigen::Quaterniond intended_orientation_W = Eigen::Quaterniond::Identity();
  Vec3 force_N = Vec3::Zero(), torque_Nm = Vec3::Zero();  // exerted by the device on the hand
};

struct Trace {
  std::vector<double> time_s;
  std::vector<double> hip_position_m, proxy_position_m, force_N, normal, frame_correction_m,
      slave_command_m;  // three numbers a row
  std::vector<std::int32_t> state, proxy_steps, converged, contact_count, frame_index, status;
  std::vector<double> surface_velocity_m_per_s, nearest_distance_m, signed_distance_m, slave_distance_m;
  std::vector<std::uint64_t> frame_hash;
  // Of a 6-DOF tool; empty for a 3-DOF renderer. Orientations are w, x, y, z.
  std::vector<double> hip_orientation, tool_orientation, torque_Nm, tool_penetration_m;
  std::vector<std::int32_t> active_constraints, contact_clusters, detections, budget_exhausted,
      disabled_points;
  // With guidance or a sequence; else empty.
  std::vector<double> guidance_force_N, guidance_torque_Nm, guidance_goal_m, guidance_orientation,
      sequence_distance_m, sequence_angle_rad;
  std::vector<std::int32_t> guidance_active, sequence_step, sequence_running, sequence_missed;
  // With a simulated operator or device; else empty.
  std::vector<double> intended_position_m, intended_orientation, device_force_N, device_torque_Nm;
  std::vector<std::int32_t> buttons;

  std::size_t length() const { return time_s.size(); }
  void reserve(std::size_t ticks);
  // What is true about a tick, beside what the renderer answered.
  struct Truth {
    double proxy_distance_m = 0;   // to the true surface, of the proxy
    double slave_distance_m = 0;   // and of the slave's command
    std::uint64_t frame_hash = 0;  // fingerprint of the newest frame delivered, 0 where it was not made
  };
  void append(double time, const DeviceState& device, const RenderOutput& out, const Truth& truth,
              const std::optional<HandState>& hand = {});

  Vec3 hip(std::size_t i) const { return row(hip_position_m, i); }
  Vec3 proxy(std::size_t i) const { return row(proxy_position_m, i); }
  Vec3 force(std::size_t i) const { return row(force_N, i); }
  Vec3 normal_at(std::size_t i) const { return row(normal, i); }
  Vec3 frame_correction(std::size_t i) const { return row(frame_correction_m, i); }
  Vec3 slave(std::size_t i) const { return row(slave_command_m, i); }
  bool has_tool() const { return !tool_orientation.empty(); }
  bool has_guidance() const { return !guidance_goal_m.empty(); }
  bool has_hand() const { return !intended_position_m.empty(); }
  Vec3 guidance_force(std::size_t i) const { return row(guidance_force_N, i); }
  Vec3 guidance_torque(std::size_t i) const { return row(guidance_torque_Nm, i); }
  Vec3 goal(std::size_t i) const { return row(guidance_goal_m, i); }
  Eigen::Quaterniond goal_orientation_at(std::size_t i) const { return quaternion(guidance_orientation, i); }
  Vec3 intended(std::size_t i) const { return row(intended_position_m, i); }
  Vec3 device_force(std::size_t i) const { return row(device_force_N, i); }
  Vec3 device_torque(std::size_t i) const { return row(device_torque_Nm, i); }
  Eigen::Quaterniond hip_orientation_at(std::size_t i) const { return quaternion(hip_orientation, i); }
  Eigen::Quaterniond tool_orientation_at(std::size_t i) const { return quaternion(tool_orientation, i); }
  Vec3 torque(std::size_t i) const { return row(torque_Nm, i); }
  // A new frame came in with tick i.
  bool frame_update(std::size_t i) const { return i > 0 && frame_index[i] != frame_index[i - 1]; }

  // Copies, with units, in the order they are stored and hashed; the last is the running hash of the others.
  std::vector<Column> columns() const;

 private:
  static Vec3 row(const std::vector<double>& v, std::size_t i) {
    return {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
  }
  static Eigen::Quaterniond quaternion(const std::vector<double>& v, std::size_t i) {
    return {v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]};
  }
  void append_tool(const DeviceState& device, const ToolOutput& tool);
  void append_guidance(const GuidanceOutput& guidance);
  void append_hand(const DeviceState& device, const HandState& hand);
  std::vector<Column> tool_columns() const;
  std::vector<Column> guidance_columns() const;
  std::vector<Column> hand_columns() const;
};

}  // namespace remote_touch
