#include "runners/presentation/export/ros_messages.h"

#include "runners/presentation/export/little_endian.h"

namespace remote_touch {

namespace {

constexpr const char* kFrame = "world";

#define PART_OF_MESSAGE \
  "================================================================================\nMSG: "
#define HEADER_PARTS                                                                                  \
  PART_OF_MESSAGE "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" PART_OF_MESSAGE \
                  "builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"

constexpr RosSchema kPose{"geometry_msgs/msg/PoseStamped",
                          "std_msgs/Header header\ngeometry_msgs/Pose pose\n" HEADER_PARTS PART_OF_MESSAGE
                          "geometry_msgs/Pose\ngeometry_msgs/Point position\n"
                          "geometry_msgs/Quaternion orientation\n" PART_OF_MESSAGE
                          "geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" PART_OF_MESSAGE
                          "geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"};
constexpr RosSchema kWrench{
    "geometry_msgs/msg/WrenchStamped",
    "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n" HEADER_PARTS PART_OF_MESSAGE
    "geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\n"
    "geometry_msgs/Vector3 torque\n" PART_OF_MESSAGE
    "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"};
constexpr RosSchema kPointCloud{
    "sensor_msgs/msg/PointCloud2",
    "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
    "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n" HEADER_PARTS
        PART_OF_MESSAGE
    "sensor_msgs/PointField\nuint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\n"
    "uint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\n"
    "uint32 count\n"};

#undef HEADER_PARTS
#undef PART_OF_MESSAGE

// Each number begins at a multiple of its size, counted from the end of the four bytes that name the
// encoding.
class CdrMessage {
 public:
  explicit CdrMessage(std::uint64_t time_ns) {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    number(static_cast<std::int32_t>(time_ns / kSecond));
    number(static_cast<std::uint32_t>(time_ns % kSecond));
    text(kFrame);
  }
  template <class Number>
  void number(Number value) {
    bytes_.resize((bytes_.size() + sizeof value - 1) / sizeof value * sizeof value);
    put(bytes_, value);
  }
  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.append(value.c_str(), value.size() + 1);
  }
  void vector(const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) number(v[axis]);
  }
  void bytes(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
  }
  std::string whole() const { return std::string("\0\1\0\0", 4) + bytes_; }

 private:
  std::string bytes_;
};

}  // namespace

const RosSchema& pose_schema() {
  return kPose;
}
const RosSchema& wrench_schema() {
  return kWrench;
}
const RosSchema& point_cloud_schema() {
  return kPointCloud;
}

std::string pose_message(std::uint64_t time_ns, const Vec3& position_W,
                         const Eigen::Quaterniond& orientation_W) {
  CdrMessage message(time_ns);
  message.vector(position_W);
  message.vector(orientation_W.vec());
  message.number(orientation_W.w());
  return message.whole();
}

std::string wrench_message(std::uint64_t time_ns, const Vec3& force_N, const Vec3& torque_Nm) {
  CdrMessage message(time_ns);
  message.vector(force_N);
  message.vector(torque_Nm);
  return message.whole();
}

std::string point_cloud_message(std::uint64_t time_ns, const std::vector<RosField>& fields,
                                const std::string& data) {
  constexpr std::uint32_t kFieldSize = 4;
  const auto step = static_cast<std::uint32_t>(kFieldSize * fields.size());
  CdrMessage message(time_ns);
  message.number(std::uint32_t{1});                                // height
  message.number(static_cast<std::uint32_t>(data.size() / step));  // width
  message.number(static_cast<std::uint32_t>(fields.size()));
  for (std::uint32_t i = 0; i < fields.size(); ++i) {
    message.text(fields[i].name);
    message.number(kFieldSize * i);  // offset
    message.number(fields[i].type);
    message.number(std::uint32_t{1});  // count
  }
  message.number(std::uint8_t{0});  // is_bigendian
  message.number(step);
  message.number(static_cast<std::uint32_t>(data.size()));  // row_step
  message.bytes(data);
  message.number(std::uint8_t{1});  // is_dense: every point was measured
  return message.whole();
}

}  // namespace remote_touch
