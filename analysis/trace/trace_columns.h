// The columns of a trace: one entry each, in the order in which they are stored and hashed. A new column is a
// new entry. This file is included several times, each time with another TRACE_COLUMN, so it has no include
// guard. An entry is
//   TRACE_COLUMN(member of Trace, type of a row, name in files, SI unit, which runs have it, value of a tick,
//                meaning, names of its values if it is an enumeration)
// The type of a row is double, std::int32_t, std::uint64_t, Vec3 or Eigen::Quaterniond. TracePart defines
// which runs have it. The value of a tick is an expression of t, a TraceTick. proxy_or_tool(A, B) means A in
// a run without a tool and B in a run with a tool.
TRACE_COLUMN(time_s, double, "time", "s", always, t.time_s, "simulated time")
TRACE_COLUMN(hip_position_m, Vec3, "hip_position", "m", always, t.device.position_W,
             "haptic interface point, world frame")
TRACE_COLUMN(proxy_position_m, Vec3, "proxy_position", "m", always, t.out.proxy_W,
             proxy_or_tool("centre of the proxy, world frame", "centre of mass of the tool, world frame"))
TRACE_COLUMN(force_N, Vec3, "force", "N", always, t.out.force_N, "force of the renderer, world frame")
TRACE_COLUMN(state, std::int32_t, "state", "1", always, t.out.state,
             proxy_or_tool("state of the proxy", "state of the tool"), names("free", "contact", "entrenched"))
TRACE_COLUMN(normal, Vec3, "normal", "1", always, t.out.normal_W,
             proxy_or_tool("estimated surface normal, unit vector",
                           "direction in which contact pushes the tool, unit vector"))
TRACE_COLUMN(surface_velocity_m_per_s, double, "surface_velocity", "m/s", always,
             t.out.surface_velocity_m_per_s, "estimated point cloud velocity along the normal")
TRACE_COLUMN(frame_correction_m, Vec3, "frame_correction", "m", always, t.out.frame_correction_m,
             proxy_or_tool("displacement of the proxy by frame updates since the last tick, (4.3)",
                           "displacement of the tool by frame updates since the last tick, (4.3)"))
TRACE_COLUMN(proxy_steps, std::int32_t, "proxy_steps", "1", always, t.out.steps,
             proxy_or_tool("proxy steps made in the tick", "steps of the tool made in the tick"))
TRACE_COLUMN(converged, std::int32_t, "converged", "1", always, t.out.converged,
             proxy_or_tool("the proxy converged in the tick", "the tool converged in the tick"),
             names("no", "yes"))
TRACE_COLUMN(contact_count, std::int32_t, "contact_count", "1", always, t.out.contact_count,
             proxy_or_tool("points within r2 of the proxy",
                           "points that touch the tool, or pairs of a sphere of the tool and a region"))
TRACE_COLUMN(nearest_distance_m, double, "nearest_distance", "m", always, t.out.nearest_distance_m,
             proxy_or_tool("distance of the proxy's centre to the nearest region",
                           "gap between the tool and the nearest point or region, negative inside the tool"))
TRACE_COLUMN(frame_index, std::int32_t, "frame_index", "1", always, t.out.frame_index,
             "newest frame in use, -1 before the first")
TRACE_COLUMN(signed_distance_m, double, "signed_distance", "m", always, t.truth.proxy_distance_m,
             proxy_or_tool("distance of the proxy's centre to the true surface",
                           "distance of the tool's centre of mass to the true surface"))
TRACE_COLUMN(slave_command_m, Vec3, "slave_command", "m", always, t.out.slave_W,
             "commanded position of the slave robot, world frame")
TRACE_COLUMN(slave_distance_m, double, "slave_distance", "m", always, t.truth.slave_distance_m,
             "distance of the slave's command to the true surface")
TRACE_COLUMN(status, std::int32_t, "status", "1", always, t.out.status, "status of the output",
             names("ok", "stale_frame_dropped", "degenerate_normal", "no_frame", "device_not_finite"))
TRACE_COLUMN(frame_hash, std::uint64_t, "frame_hash", "1", always, t.truth.frame_hash,
             "64-bit hash of the newest frame that arrived: its points and time of capture")

TRACE_COLUMN(hip_orientation, Eigen::Quaterniond, "hip_orientation", "1", tool, t.device.orientation_W,
             "orientation of the device, quaternion w x y z")
TRACE_COLUMN(tool_orientation, Eigen::Quaterniond, "tool_orientation", "1", tool, t.out.tool->orientation_W,
             "orientation of the tool, quaternion w x y z")
TRACE_COLUMN(torque_Nm, Vec3, "torque", "N m", tool, t.out.tool->torque_Nm,
             "torque on the hand about the HIP, world frame")
TRACE_COLUMN(active_constraints, std::int32_t, "active_constraints", "1", tool,
             t.out.tool->active_constraints, "active constraints of (6.5)")
TRACE_COLUMN(contact_clusters, std::int32_t, "contact_clusters", "1", tool, t.out.tool->contact_clusters,
             "groups of touching points, 10 mm cells")
TRACE_COLUMN(tool_penetration_m, double, "tool_penetration", "m", tool, t.out.tool->tool_penetration_m,
             "depth of the deepest point of the newest frame in the tool")
TRACE_COLUMN(detections, std::int32_t, "detections", "1", tool, t.out.tool->detections,
             "collision detections made in the tick")
TRACE_COLUMN(budget_exhausted, std::int32_t, "budget_exhausted", "1", tool, t.out.tool->budget_exhausted,
             "the tick ended before the tool had converged", names("no", "yes"))
TRACE_COLUMN(disabled_points, std::int32_t, "disabled_points", "1", tool, t.out.tool->disabled_points,
             "points of the newest frame without a normal")

TRACE_COLUMN(guidance_active, std::int32_t, "guidance_active", "1", guidance, t.out.guidance->active,
             "a guidance fixture is active and its target is visible", names("no", "yes"))
TRACE_COLUMN(guidance_force_N, Vec3, "guidance_force", "N", guidance, t.out.guidance->force_N,
             "force of guidance on the hand, part of force")
TRACE_COLUMN(guidance_torque_Nm, Vec3, "guidance_torque", "N m", guidance, t.out.guidance->torque_Nm,
             "torque of guidance on the hand, part of torque")
TRACE_COLUMN(guidance_goal_m, Vec3, "guidance_goal", "m", guidance, t.out.guidance->goal_W,
             "goal of the guidance fixture, world frame")
TRACE_COLUMN(guidance_orientation, Eigen::Quaterniond, "guidance_orientation", "1", guidance,
             t.out.guidance->goal_orientation_W, "orientation of the goal, quaternion w x y z")
TRACE_COLUMN(sequence_step, std::int32_t, "sequence_step", "1", guidance, t.out.guidance->sequence_step,
             "current step of the task, from 0")
TRACE_COLUMN(sequence_running, std::int32_t, "sequence_running", "1", guidance,
             t.out.guidance->sequence_running, "the step has begun", names("no", "yes"))
TRACE_COLUMN(sequence_missed, std::int32_t, "sequence_missed", "1", guidance, t.out.guidance->sequence_missed,
             "number of steps that missed their deadline so far")
TRACE_COLUMN(sequence_distance_m, double, "sequence_distance", "m", guidance,
             t.out.guidance->sequence_distance_m,
             "distance of the tool from the goal when a step ended, else NaN")
TRACE_COLUMN(sequence_angle_rad, double, "sequence_angle", "rad", guidance,
             t.out.guidance->sequence_angle_rad, "angle between tool and goal when a step ended, else NaN")

TRACE_COLUMN(intended_position_m, Vec3, "intended_position", "m", hand, t.hand->intended_W,
             "intended position of the operator, world frame")
TRACE_COLUMN(intended_orientation, Eigen::Quaterniond, "intended_orientation", "1", hand,
             t.hand->intended_orientation_W, "intended orientation of the operator, quaternion w x y z")
TRACE_COLUMN(device_force_N, Vec3, "device_force", "N", hand, t.hand->force_N,
             "force that the device exerts on the hand")
TRACE_COLUMN(device_torque_Nm, Vec3, "device_torque", "N m", hand, t.hand->torque_Nm,
             "torque that the device exerts on the hand")
TRACE_COLUMN(buttons, std::int32_t, "buttons", "1", hand, t.device.buttons,
             "pressed buttons of the device, one bit each")

TRACE_COLUMN(expected_force_N, Vec3, "expected_force", "N", replay, *t.truth.expected_force_N,
             "force that an ideal renderer would exert on the hand, world frame; NaN: not known")

TRACE_COLUMN(measured_distance_m, double, "measured_distance", "m", measured_surface,
             *t.truth.measured_distance_m,
             proxy_or_tool("distance of the proxy's centre to the surface that the camera measured",
                           "distance of the tool's centre of mass to the surface that the camera measured"))

TRACE_COLUMN(hand_position_m, Vec3, "hand_position", "m", rounded_hand, t.hand->true_pose->position_W,
             "position of the hand, which the device measures as hip_position")
TRACE_COLUMN(hand_orientation, Eigen::Quaterniond, "hand_orientation", "1", rounded_hand,
             t.hand->true_pose->orientation_W, "orientation of the hand, quaternion w x y z")

TRACE_COLUMN(received_command_m, Vec3, "received_command", "m", slave, t.slave->command_W,
             "where the command that the slave has received last sends it, world frame")
TRACE_COLUMN(slave_position_m, Vec3, "slave_position", "m", slave, t.slave->position_W,
             proxy_or_tool("centre of the slave's ball, world frame",
                           "centre of mass of the slave's tool, world frame"))
TRACE_COLUMN(slave_force_N, Vec3, "slave_force", "N", slave, t.slave->force_N,
             "mean force of the scene on the slave in the last tick, world frame")
TRACE_COLUMN(slave_peak_force_N, double, "slave_peak_force", "N", slave, t.slave->peak_force_N,
             "largest magnitude of this force in the last tick")
TRACE_COLUMN(slave_clearance_m, double, "slave_clearance", "m", slave, t.slave->clearance_m,
             proxy_or_tool("distance of the slave's ball from the true surface, negative in contact",
                           "distance of the slave's tool from the true surface, negative behind it"))
TRACE_COLUMN(command_packets, std::int32_t, "command_packets", "1", slave, t.slave->command_packets,
             "number of commands that were sent to the slave so far")
TRACE_COLUMN(force_packets, std::int32_t, "force_packets", "1", slave, t.slave->force_packets,
             "number of forces that the slave has sent so far")
TRACE_COLUMN(frame_packets, std::int32_t, "frame_packets", "1", slave, t.slave->frame_packets,
             "number of frames that have arrived from the camera of the slave so far")
TRACE_COLUMN(hand_energy_in_J, double, "hand_energy_in", "J", channel_energy, t.slave->energy->hand_in_J,
             "energy that has entered the channel to the slave at the hand so far")
TRACE_COLUMN(hand_energy_out_J, double, "hand_energy_out", "J", channel_energy, t.slave->energy->hand_out_J,
             "energy that has left this channel at the hand so far")
TRACE_COLUMN(slave_energy_in_J, double, "slave_energy_in", "J", channel_energy, t.slave->energy->slave_in_J,
             "energy that has entered this channel at the slave so far")
TRACE_COLUMN(slave_energy_out_J, double, "slave_energy_out", "J", channel_energy,
             t.slave->energy->slave_out_J, "energy that has left this channel at the slave so far")
TRACE_COLUMN(dissipated_energy_J, double, "dissipated_energy", "J", channel_energy,
             t.slave->energy->dissipated_J,
             "energy that passivity control has kept from leaving this channel so far")
TRACE_COLUMN(slave_orientation, Eigen::Quaterniond, "slave_orientation", "1", slave_tool,
             t.slave->tool->orientation_W, "orientation of the slave's tool, quaternion w x y z")
TRACE_COLUMN(slave_torque_Nm, Vec3, "slave_torque", "N m", slave_tool, t.slave->tool->torque_Nm,
             "mean torque of the scene on the slave's tool about its centre of mass, in the last tick")
