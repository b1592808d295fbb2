// A trace as messages over time, for Foxglove, rerun and programs of ROS 2.
#pragma once

#include "runners/presentation/export/export_job.h"

namespace remote_touch {

// Time is the simulated time, in nanoseconds. Topics:
//   /cloud         sensor_msgs/msg/PointCloud2     each frame in use, at the time of its arrival; its
//                                                  header has the time of capture
//   /hip, /proxy   geometry_msgs/msg/PoseStamped   in each tick
//   /tool          geometry_msgs/msg/PoseStamped   the same, in a run with a tool: its centre of mass
//   /force         geometry_msgs/msg/WrenchStamped force and torque on the hand, in each tick
void write_mcap(const ExportJob& job);

}  // namespace remote_touch
