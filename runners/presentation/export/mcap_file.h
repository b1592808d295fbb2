// A trace as messages over time, for Foxglove, rerun and programs of ROS 2.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "core/points/vector.h"
#include "runners/presentation/export/exported_run.h"

namespace remote_touch {

// Messages of ROS 2: their definitions, and their bytes as DDS sends them (CDR, little-endian). There are
// only the messages that an export contains.

// name: "geometry_msgs/msg/PoseStamped". definition: also contains the definitions of all messages that are
// parts of it, as the schema encoding `ros2msg` of MCAP demands.
struct RosSchema {
  const char* name;
  const char* definition;
};

// All messages are in the frame `world`, in metres, newtons and newton metres; time in nanoseconds since the
// start.
std::string pose_message(std::uint64_t time_ns, const Vec3& position_W,
                         const Eigen::Quaterniond& orientation_W);
std::string wrench_message(std::uint64_t time_ns, const Vec3& force_N, const Vec3& torque_Nm);
// fields: their names; each is a float of 32 bits, one after the other in a point. data: those of all points.
std::string point_cloud_message(std::uint64_t time_ns, const std::vector<std::string>& fields,
                                const std::string& data);

// Files of time-stamped messages of ROS 2: MCAP, https://mcap.dev/spec, with chunks that are not compressed.
// Passes the bytes of the file to `write` as it grows. All topics are added before the first message.
class McapWriter {
 public:
  explicit McapWriter(std::function<void(const std::string&)> write);
  // Topics whose schemas have the same name share the schema. Returns the number of the topic's channel.
  std::uint16_t add_topic(const std::string& name, const RosSchema& schema);
  void add_metadata(const std::string& name, const TextAttributes& texts);
  void message(std::uint16_t channel, std::uint64_t log_ns, std::uint64_t publish_ns,
               const std::string& data);
  void finish();

  // Returns the bytes with which every file begins.
  static std::string opening();

 private:
  struct Times {
    std::uint64_t first = 0, last = 0;
    bool is_empty = true;
    void add(std::uint64_t time_ns);
  };
  struct Chunk {
    std::string records;
    Times times;
    std::map<std::uint16_t, std::string> index;  // time and position of each message, by channel
  };
  void emit(const std::string& bytes);
  void close_chunk();
  std::string statistics() const;

  std::function<void(const std::string&)> write_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // CRC-32 of all bytes so far
  Chunk chunk_;
  Times times_;
  std::map<std::string, std::uint16_t> schemas_;
  std::map<std::uint16_t, std::uint64_t> messages_;  // number of messages by channel
  // Records that are repeated at the end.
  std::string schema_records_, channel_records_, chunk_indexes_, metadata_indexes_;
  std::uint32_t chunks_ = 0, metadata_ = 0;
};

// Time is the simulated time, in nanoseconds. Topics:
//   /cloud         sensor_msgs/msg/PointCloud2     each frame in use, at the time of its arrival; its
//                                                  header has the time of capture
//   /hip, /proxy   geometry_msgs/msg/PoseStamped   in each tick
//   /tool          geometry_msgs/msg/PoseStamped   the same, in a run with a tool: its centre of mass
//   /force         geometry_msgs/msg/WrenchStamped force and torque on the hand, in each tick
void write_mcap(const ExportJob& job);

}  // namespace remote_touch
