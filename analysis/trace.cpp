#include "analysis/trace.h"

#include <utility>

#include "analysis/fingerprint.h"

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
  for (auto* column : {&time_s, &surface_velocity_m_per_s, &nearest_m, &signed_distance_m, &slave_distance_m})
    column->reserve(ticks);
  for (auto* column : {&hip_m, &proxy_m, &force_N, &normal, &carried_m, &slave_m}) column->reserve(3 * ticks);
  for (auto* column : {&state, &proxy_steps, &converged, &contact_count, &frame_index, &status})
    column->reserve(ticks);
  frame_hash.reserve(ticks);
}

void Trace::append(double time, const DeviceState& device, const RenderOutput& out, const Truth& truth) {
  time_s.push_back(time);
  push(hip_m, device.position_W), push(proxy_m, out.proxy_W), push(force_N, out.force_N),
      push(normal, out.normal_W), push(carried_m, out.carried_m), push(slave_m, out.slave_W);
  state.push_back(static_cast<std::int32_t>(out.state));
  proxy_steps.push_back(out.steps);
  converged.push_back(out.converged ? 1 : 0);
  contact_count.push_back(out.contact_count);
  frame_index.push_back(out.frame_index);
  status.push_back(static_cast<std::int32_t>(out.status));
  surface_velocity_m_per_s.push_back(out.surface_velocity_m_per_s);
  nearest_m.push_back(out.nearest_m);
  signed_distance_m.push_back(truth.proxy_distance_m);
  slave_distance_m.push_back(truth.slave_distance_m);
  frame_hash.push_back(truth.frame_hash);
  if (out.tool) append_tool(device, *out.tool);
}

void Trace::append_tool(const DeviceState& device, const ToolOutput& tool) {
  push(hip_orientation, device.orientation_W), push(tool_orientation, tool.orientation_W);
  push(torque_Nm, tool.torque_Nm);
  penetration_m.push_back(tool.penetration_m);
  active_constraints.push_back(tool.active_constraints);
  contact_clusters.push_back(tool.contact_clusters);
  detections.push_back(tool.detections);
  budget_exhausted.push_back(tool.budget_exhausted ? 1 : 0);
  disabled_points.push_back(tool.disabled_points);
}

std::vector<Column> Trace::columns() const {
  std::vector<Column> list = {
      {"time", "s", "simulated time", time_s, 1, {}},
      {"hip_position", "m", "haptic interface point, world frame", hip_m, 3, {}},
      {"proxy_position",
       "m",
       has_tool() ? "centre of mass of the tool, world frame" : "centre of the proxy, world frame",
       proxy_m,
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
       "what frame updates moved the proxy by before the tick, (4.3)",
       carried_m,
       3,
       {}},
      {"proxy_steps", "1", "proxy steps made in the tick", proxy_steps, 1, {}},
      {"converged", "1", "the proxy converged in the tick", converged, 1, {"no", "yes"}},
      {"contact_count", "1", "points within r2 of the proxy", contact_count, 1, {}},
      {"nearest_distance", "m", "distance of the proxy's centre to the nearest region", nearest_m, 1, {}},
      {"frame_index", "1", "newest frame in use, -1 before the first", frame_index, 1, {}},
      {"signed_distance",
       "m",
       "distance of the proxy's centre to the true surface",
       signed_distance_m,
       1,
       {}},
      {"slave_command", "m", "where the slave robot is sent, world frame", slave_m, 3, {}},
      {"slave_distance", "m", "distance of the slave's command to the true surface", slave_distance_m, 1, {}},
      {"status",
       "1",
       "why the output is not an ordinary one",
       status,
       1,
       {"ok", "stale_frame_dropped", "degenerate_normal", "no_frame", "device_not_finite"}},
      {"frame_hash",
       "1",
       "fingerprint of the newest frame that was delivered: its points and time of capture",
       frame_hash,
       1,
       {}},
  };
  if (has_tool())
    for (Column& column : tool_columns()) list.push_back(std::move(column));
  list.push_back(
      {kRunningHash, "1", "fingerprint of all columns up to this tick", running_hash(list), 1, {}});
  return list;
}

std::vector<Column> Trace::tool_columns() const {
  return {
      {"hip_orientation", "1", "orientation of the device, quaternion w x y z", hip_orientation, 4, {}},
      {"tool_orientation", "1", "orientation of the tool, quaternion w x y z", tool_orientation, 4, {}},
      {"torque", "N m", "torque on the hand about the HIP, world frame", torque_Nm, 3, {}},
      {"active_constraints", "1", "rows of (6.5) that hold the tool", active_constraints, 1, {}},
      {"contact_clusters", "1", "groups of touching points, 10 mm cells", contact_clusters, 1, {}},
      {"penetration", "m", "of the deepest point of the newest frame into the tool", penetration_m, 1, {}},
      {"detections", "1", "collision detections made in the tick", detections, 1, {}},
      {"budget_exhausted",
       "1",
       "the tick ended before the tool came to rest",
       budget_exhausted,
       1,
       {"no", "yes"}},
      {"disabled_points", "1", "points of the newest frame without a normal", disabled_points, 1, {}},
  };
}

}  // namespace remote_touch
