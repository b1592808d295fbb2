#include "analysis/trace/trace.h"

#include <utility>

#include "analysis/columns/hash64.h"

namespace remote_touch {

namespace {
void push(std::vector<double>& column, const Vec3& v) {
  column.insert(column.end(), {v.x(), v.y(), v.z()});
}
void push(std::vector<double>& column, const Eigen::Quaterniond& q) {
  column.insert(column.end(), {q.w(), q.x(), q.y(), q.z()});
}
}  // namespace

void Trace::reserve(std::size_t ticks) {
  for (auto* column :
       {&time_s, &surface_velocity_m_per_s, &nearest_distance_m, &signed_distance_m, &slave_distance_m})
    column->reserve(ticks);
  for (auto* column :
       {&hip_position_m, &proxy_position_m, &force_N, &normal, &frame_correction_m, &slave_command_m})
    column->reserve(3 * ticks);
  for (auto* column : {&state, &proxy_steps, &converged, &contact_count, &frame_index, &status})
    column->reserve(ticks);
  frame_hash.reserve(ticks);
}

void Trace::append(double time, const DeviceState& device, const RenderOutput& out, const Truth& truth,
                   const std::optional<HandState>& hand) {
  time_s.push_back(time);
  push(hip_position_m, device.position_W), push(proxy_position_m, out.proxy_W), push(force_N, out.force_N),
      push(normal, out.normal_W), push(frame_correction_m, out.frame_correction_m),
      push(slave_command_m, out.slave_W);
  state.push_back(static_cast<std::int32_t>(out.state));
  proxy_steps.push_back(out.steps);
  converged.push_back(out.converged ? 1 : 0);
  contact_count.push_back(out.contact_count);
  frame_index.push_back(out.frame_index);
  status.push_back(static_cast<std::int32_t>(out.status));
  surface_velocity_m_per_s.push_back(out.surface_velocity_m_per_s);
  nearest_distance_m.push_back(out.nearest_distance_m);
  signed_distance_m.push_back(truth.proxy_distance_m);
  slave_distance_m.push_back(truth.slave_distance_m);
  frame_hash.push_back(truth.frame_hash);
  if (out.tool) append_tool(device, *out.tool);
  if (out.guidance) append_guidance(*out.guidance);
  if (hand) append_hand(device, *hand);
}

void Trace::append_guidance(const GuidanceOutput& guidance) {
  guidance_active.push_back(guidance.active ? 1 : 0);
  push(guidance_force_N, guidance.force_N), push(guidance_torque_Nm, guidance.torque_Nm);
  push(guidance_goal_m, guidance.goal_W), push(guidance_orientation, guidance.goal_orientation_W);
  sequence_step.push_back(guidance.sequence_step);
  sequence_running.push_back(guidance.sequence_running ? 1 : 0);
  sequence_missed.push_back(guidance.sequence_missed);
  sequence_distance_m.push_back(guidance.sequence_distance_m),
      sequence_angle_rad.push_back(guidance.sequence_angle_rad);
}

void Trace::append_hand(const DeviceState& device, const HandState& hand) {
  push(intended_position_m, hand.intended_W), push(intended_orientation, hand.intended_orientation_W);
  push(device_force_N, hand.force_N), push(device_torque_Nm, hand.torque_Nm);
  buttons.push_back(static_cast<std::int32_t>(device.buttons));
}

void Trace::append_tool(const DeviceState& device, const ToolOutput& tool) {
  push(hip_orientation, device.orientation_W), push(tool_orientation, tool.orientation_W);
  push(torque_Nm, tool.torque_Nm);
  tool_penetration_m.push_back(tool.tool_penetration_m);
  active_constraints.push_back(tool.active_constraints);
  contact_clusters.push_back(tool.contact_clusters);
  detections.push_back(tool.detections);
  budget_exhausted.push_back(tool.budget_exhausted ? 1 : 0);
  disabled_points.push_back(tool.disabled_points);
}

std::vector<Column> Trace::columns() const {
  std::vector<Column> list = {
      {"time", "s", "simulated time", time_s, 1, {}},
      {"hip_position", "m", "haptic interface point, world frame", hip_position_m, 3, {}},
      {"proxy_position",
       "m",
       has_tool() ? "centre of mass of the tool, world frame" : "centre of the proxy, world frame",
       proxy_position_m,
       3,
       {}},
      {"force", "N", "force on the hand, world frame", force_N, 3, {}},
      {"state", "1", "state of the proxy", state, 1, {"free", "contact", "entrenched"}},
      {"normal", "1", "estimated surface normal, unit vector", normal, 3, {}},
      {"surface_velocity",
       "m/s",
       "estimated point cloud velocity along the normal",
       surface_velocity_m_per_s,
       1,
       {}},
      {"frame_correction",
       "m",
       "displacement of the proxy by frame updates since the last tick, (4.3)",
       frame_correction_m,
       3,
       {}},
      {"proxy_steps", "1", "proxy steps made in the tick", proxy_steps, 1, {}},
      {"converged", "1", "the proxy converged in the tick", converged, 1, {"no", "yes"}},
      {"contact_count", "1", "points within r2 of the proxy", contact_count, 1, {}},
      {"nearest_distance",
       "m",
       "distance of the proxy's centre to the nearest region",
       nearest_distance_m,
       1,
       {}},
      {"frame_index", "1", "newest frame in use, -1 before the first", frame_index, 1, {}},
      {"signed_distance",
       "m",
       "distance of the proxy's centre to the true surface",
       signed_distance_m,
       1,
       {}},
      {"slave_command", "m", "commanded position of the slave robot, world frame", slave_command_m, 3, {}},
      {"slave_distance", "m", "distance of the slave's command to the true surface", slave_distance_m, 1, {}},
      {"status",
       "1",
       "status of the output",
       status,
       1,
       {"ok", "stale_frame_dropped", "degenerate_normal", "no_frame", "device_not_finite"}},
      {"frame_hash",
       "1",
       "64-bit hash of the newest frame that arrived: its points and time of capture",
       frame_hash,
       1,
       {}},
  };
  const auto add = [&](std::vector<Column> more) {
    for (Column& column : more) list.push_back(std::move(column));
  };
  if (has_tool()) add(tool_columns());
  if (has_guidance()) add(guidance_columns());
  if (has_hand()) add(hand_columns());
  list.push_back(
      {kRunningHash, "1", "64-bit hash of all columns up to this tick", running_hash(list), 1, {}});
  return list;
}

std::vector<Column> Trace::tool_columns() const {
  return {
      {"hip_orientation", "1", "orientation of the device, quaternion w x y z", hip_orientation, 4, {}},
      {"tool_orientation", "1", "orientation of the tool, quaternion w x y z", tool_orientation, 4, {}},
      {"torque", "N m", "torque on the hand about the HIP, world frame", torque_Nm, 3, {}},
      {"active_constraints", "1", "active constraints of (6.5)", active_constraints, 1, {}},
      {"contact_clusters", "1", "groups of touching points, 10 mm cells", contact_clusters, 1, {}},
      {"tool_penetration",
       "m",
       "depth of the deepest point of the newest frame in the tool",
       tool_penetration_m,
       1,
       {}},
      {"detections", "1", "collision detections made in the tick", detections, 1, {}},
      {"budget_exhausted",
       "1",
       "the tick ended before the tool had converged",
       budget_exhausted,
       1,
       {"no", "yes"}},
      {"disabled_points", "1", "points of the newest frame without a normal", disabled_points, 1, {}},
  };
}

std::vector<Column> Trace::guidance_columns() const {
  return {
      {"guidance_active",
       "1",
       "a guidance fixture is active and its target is visible",
       guidance_active,
       1,
       {"no", "yes"}},
      {"guidance_force", "N", "force of guidance on the hand, part of force", guidance_force_N, 3, {}},
      {"guidance_torque", "N m", "torque of guidance on the hand, part of torque", guidance_torque_Nm, 3, {}},
      {"guidance_goal", "m", "goal of the guidance fixture, world frame", guidance_goal_m, 3, {}},
      {"guidance_orientation",
       "1",
       "orientation of the goal, quaternion w x y z",
       guidance_orientation,
       4,
       {}},
      {"sequence_step", "1", "current step of the task, from 0", sequence_step, 1, {}},
      {"sequence_running", "1", "the step has begun", sequence_running, 1, {"no", "yes"}},
      {"sequence_missed", "1", "number of steps that missed their deadline so far", sequence_missed, 1, {}},
      {"sequence_distance",
       "m",
       "distance of the tool from the goal when a step ended, else NaN",
       sequence_distance_m,
       1,
       {}},
      {"sequence_angle",
       "rad",
       "angle between tool and goal when a step ended, else NaN",
       sequence_angle_rad,
       1,
       {}},
  };
}

std::vector<Column> Trace::hand_columns() const {
  return {
      {"intended_position",
       "m",
       "intended position of the operator, world frame",
       intended_position_m,
       3,
       {}},
      {"intended_orientation",
       "1",
       "intended orientation of the operator, quaternion w x y z",
       intended_orientation,
       4,
       {}},
      {"device_force", "N", "force that the device exerts on the hand", device_force_N, 3, {}},
      {"device_torque", "N m", "torque that the device exerts on the hand", device_torque_Nm, 3, {}},
      {"buttons", "1", "pressed buttons of the device, one bit each", buttons, 1, {}},
  };
}

}  // namespace remote_touch
