#include "runners/presentation/export/mcap_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/storage/hdf5_file.h"
#include "core/geometry/colour.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/presentation/export/exported_run.h"
#include "runners/presentation/export/little_endian.h"
#include "runners/presentation/export/mcap_writer.h"
#include "runners/presentation/export/ros_messages.h"

namespace remote_touch {

namespace {

constexpr const char *kProfile = "ros2", *kLibrary = "remote-touch export";

std::uint64_t nanoseconds(double time_s) {
  return static_cast<std::uint64_t>(std::llround(std::max(time_s, 0.0) * 1e9));
}

McapTopic topic(const char* name, const RosSchema& schema) {
  return {name, schema.name, "ros2msg", schema.definition, "cdr"};
}

// Numbers have 32 bits, because readers of ROS 2 expect that. The rounding error is at most 0.06 micrometres
// at a distance of 1 m.
std::string cloud_message(const ExportedFrame& frame) {
  const PointCloud& cloud = frame.points;
  std::vector<RosField> fields{{"x", kRosFloat32}, {"y", kRosFloat32}, {"z", kRosFloat32}};
  if (!cloud.colour.empty()) fields.push_back({"rgb", kRosFloat32});  // the bits of 0x00RRGGBB
  if (cloud.has_normals())
    for (const char* name : {"normal_x", "normal_y", "normal_z"}) fields.push_back({name, kRosFloat32});
  if (!cloud.fixture_radius_m.empty()) fields.push_back({"fixture_radius", kRosFloat32});
  constexpr std::uint32_t kNan = 0x7FC00000;  // NaN of 32 bits
  std::string data;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (const double number : {cloud.x[i], cloud.y[i], cloud.z[i]}) put(data, static_cast<float>(number));
    if (!cloud.colour.empty()) put(data, cloud.colour[i] == kNoColour ? kNan : cloud.colour[i]);
    if (cloud.has_normals())
      for (const double number : {cloud.nx[i], cloud.ny[i], cloud.nz[i]})
        put(data, static_cast<float>(number));
    if (!cloud.fixture_radius_m.empty()) put(data, static_cast<float>(cloud.fixture_radius_m[i]));
  }
  return point_cloud_message(nanoseconds(frame.captured_s), fields, data);
}

class RunMessages {
 public:
  RunMessages(const ExportedRun& run, McapWriter& mcap)
      : run_(run),
        mcap_(mcap),
        cloud_(mcap.add_topic(topic("/cloud", point_cloud_schema()))),
        hip_(mcap.add_topic(topic("/hip", pose_schema()))),
        proxy_(mcap.add_topic(topic("/proxy", pose_schema()))),
        force_(mcap.add_topic(topic("/force", wrench_schema()))) {
    if (run.tool) tool_ = mcap.add_topic(topic("/tool", pose_schema()));
  }

  void add(const ExportedFrame& frame) {
    add_ticks_before(frame.arrives_s);
    mcap_.message(cloud_, nanoseconds(frame.arrives_s), nanoseconds(frame.captured_s), cloud_message(frame));
  }
  // Adds the messages of the remaining ticks before time_s, in the order of time.
  void add_ticks_before(double time_s) {
    for (; tick_ < run_.ticks() && run_.time_s[tick_] < time_s; ++tick_) {
      const std::uint64_t now = nanoseconds(run_.time_s[tick_]);
      const auto add = [&](std::uint16_t channel, const std::string& data) {
        mcap_.message(channel, now, now, data);
      };
      add(hip_, pose_message(now, run_.hip_W[tick_], run_.hip_orientation_W[tick_]));
      add(proxy_, pose_message(now, run_.proxy_W[tick_], run_.tool_orientation_W[tick_]));
      if (tool_) add(*tool_, pose_message(now, run_.proxy_W[tick_], run_.tool_orientation_W[tick_]));
      add(force_, wrench_message(now, run_.force_N[tick_], run_.torque_Nm[tick_]));
    }
  }

 private:
  const ExportedRun& run_;
  McapWriter& mcap_;
  const std::uint16_t cloud_, hip_, proxy_, force_;
  std::optional<std::uint16_t> tool_;
  std::size_t tick_ = 0;
};

}  // namespace

void write_mcap(const ExportJob& job) {
  const ExportedRun run = exported_run(job);
  job.begin(job.output, McapWriter::opening(kProfile, kLibrary));
  McapWriter mcap(kProfile, kLibrary, [&](const std::string& bytes) { job.files.append(bytes); });
  RunMessages messages(run, mcap);
  mcap.add_metadata("remote-touch", present_attributes(job.result.attributes()));
  for_each_frame(job, run, [&](const ExportedFrame& frame) { messages.add(frame); });
  messages.add_ticks_before(std::numeric_limits<double>::infinity());
  mcap.finish();
}

}  // namespace remote_touch
