// Messages of ROS 2: their definitions, and their bytes as DDS sends them (CDR, little-endian). There are
// only the messages that an export contains.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// name: "geometry_msgs/msg/PoseStamped". definition: also contains the definitions of all messages that are
// parts of it, as the schema encoding `ros2msg` of MCAP demands.
struct RosSchema {
  const char* name;
  const char* definition;
};
const RosSchema& pose_schema();
const RosSchema& wrench_schema();
const RosSchema& point_cloud_schema();

// All messages are in the frame `world`, in metres, newtons and newton metres; time in nanoseconds since the
// start.
std::string pose_message(std::uint64_t time_ns, const Vec3& position_W,
                         const Eigen::Quaterniond& orientation_W);
std::string wrench_message(std::uint64_t time_ns, const Vec3& force_N, const Vec3& torque_Nm);

struct RosField {
  std::string name;
  std::uint8_t type;  // type number of sensor_msgs/PointField
};
inline constexpr std::uint8_t kRosFloat32 = 7;
// fields: four bytes each, one after the other in a point. data: the fields of all points.
std::string point_cloud_message(std::uint64_t time_ns, const std::vector<RosField>& fields,
                                const std::string& data);

}  // namespace remote_touch
