#include "runners/presentation/export_formats.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/storage/hdf5_file.h"
#include "core/points/point_cloud.h"

namespace remote_touch {
namespace {

enum class Record : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f
};

constexpr std::size_t kChunkSize = 1 << 20;
const std::string kMagic("\x89MCAP0\r\n", 8);

std::uint32_t crc_after(std::uint32_t before, const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

// Returns numbers, and texts after their lengths, as the content of a record.
template <class... Values>
std::string content(const Values&... values) {
  std::string bytes;
  const auto add = [&bytes]<class Value>(const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>)
      put(bytes, value);
    else
      put(bytes, static_cast<std::uint32_t>(value.size())), bytes += value;
  };
  (add(values), ...);
  return bytes;
}

std::string record(Record kind, const std::string& content) {
  std::string bytes;
  put(bytes, static_cast<std::uint8_t>(kind), std::uint64_t{content.size()});
  return bytes + content;
}

// Returns the entries of a map, whose content is that of a text.
template <class Map>
std::string entries(const Map& map) {
  std::string all;
  for (const auto& [key, value] : map) all += content(key, value);
  return all;
}

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

std::uint64_t nanoseconds(double time_s) {
  return static_cast<std::uint64_t>(std::llround(std::max(time_s, 0.0) * 1e9));
}

// Numbers have 32 bits, because readers of ROS 2 expect that. The rounding error is at most 0.06 micrometres
// at a distance of 1 m.
std::string cloud_message(const ExportedFrame& frame) {
  const PointCloud& cloud = frame.points;
  std::vector<std::string> fields{"x", "y", "z"};
  if (!cloud.colour.empty()) fields.push_back("rgb");  // the bits of 0x00RRGGBB
  if (cloud.has_normals()) fields.insert(fields.end(), {"normal_x", "normal_y", "normal_z"});
  if (!cloud.fixture_radius_m.empty()) fields.push_back("fixture_radius");
  constexpr std::uint32_t kNan = 0x7FC00000;  // NaN of 32 bits
  const auto single = [](double number) { return static_cast<float>(number); };
  std::string data;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    put(data, single(cloud.x[i]), single(cloud.y[i]), single(cloud.z[i]));
    if (!cloud.colour.empty()) put(data, cloud.colour[i] == kNoColour ? kNan : cloud.colour[i]);
    if (cloud.has_normals()) put(data, single(cloud.nx[i]), single(cloud.ny[i]), single(cloud.nz[i]));
    if (!cloud.fixture_radius_m.empty()) put(data, single(cloud.fixture_radius_m[i]));
  }
  return point_cloud_message(nanoseconds(frame.captured_s), fields, data);
}

class RunMessages {
 public:
  RunMessages(const ExportJob& job, const ExportedRun& run, McapWriter& mcap)
      : job_(job),
        run_(run),
        mcap_(mcap),
        cloud_(mcap.add_topic("/cloud", kPointCloud)),
        hip_(mcap.add_topic("/hip", kPose)),
        proxy_(mcap.add_topic("/proxy", kPose)),
        force_(mcap.add_topic("/force", kWrench)) {
    if (run.tool) tool_ = mcap.add_topic("/tool", kPose);
  }

  void add(const ExportedFrame& frame) {
    add_ticks_before(frame.arrives_s);
    mcap_.message(cloud_, nanoseconds(frame.arrives_s), nanoseconds(frame.captured_s), cloud_message(frame));
  }
  // Adds the messages of the remaining ticks before time_s, in the order of time.
  void add_ticks_before(double time_s) {
    for (; tick_ < run_.ticks() && run_.time_s[tick_] < time_s; ++tick_) {
      if (!job_.keeps(tick_, run_.ticks())) continue;
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
  const ExportJob& job_;
  const ExportedRun& run_;
  McapWriter& mcap_;
  const std::uint16_t cloud_, hip_, proxy_, force_;
  std::optional<std::uint16_t> tool_;
  std::size_t tick_ = 0;
};

}  // namespace

void McapWriter::Times::add(std::uint64_t time_ns) {
  first = is_empty ? time_ns : std::min(first, time_ns);
  last = is_empty ? time_ns : std::max(last, time_ns);
  is_empty = false;
}

std::string McapWriter::opening() {
  return kMagic + record(Record::header, content(std::string("ros2"), std::string("remote-touch export")));
}

McapWriter::McapWriter(std::function<void(const std::string&)> write) : write_(std::move(write)) {
  emit(opening());
}

void McapWriter::emit(const std::string& bytes) {
  write_(bytes);
  crc_ = crc_after(crc_, bytes);
  size_ += bytes.size();
}

std::uint16_t McapWriter::add_topic(const std::string& name, const RosSchema& schema) {
  const auto [known, is_new] =
      schemas_.try_emplace(schema.name, static_cast<std::uint16_t>(schemas_.size() + 1));  // 0: no schema
  if (is_new) {
    const std::string definition =
        record(Record::schema,
               content(known->second, known->first, std::string("ros2msg"), std::string(schema.definition)));
    schema_records_ += definition, chunk_.records += definition;
  }
  const auto number = static_cast<std::uint16_t>(messages_.size());
  const std::string channel =
      record(Record::channel, content(number, known->second, name, std::string("cdr"), std::string()));
  channel_records_ += channel, chunk_.records += channel;
  messages_[number] = 0;
  return number;
}

void McapWriter::add_metadata(const std::string& name, const TextAttributes& texts) {
  const std::string whole = record(Record::metadata, content(name, entries(texts)));
  metadata_indexes_ += record(Record::metadata_index, content(size_, std::uint64_t{whole.size()}, name));
  ++metadata_;
  emit(whole);
}

void McapWriter::message(std::uint16_t channel, std::uint64_t log_ns, std::uint64_t publish_ns,
                         const std::string& data) {
  put(chunk_.index[channel], log_ns, std::uint64_t{chunk_.records.size()});
  const auto number = static_cast<std::uint32_t>(messages_[channel]++);
  chunk_.records += record(Record::message, content(channel, number, log_ns, publish_ns) + data);
  chunk_.times.add(log_ns);
  times_.add(log_ns);
  if (chunk_.records.size() >= kChunkSize) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.records.empty()) return;
  const std::string uncompressed;
  const std::uint64_t start = size_, records = chunk_.records.size();
  const std::uint64_t first = chunk_.times.first, last = chunk_.times.last;
  emit(record(
      Record::chunk,
      content(first, last, records, crc_after(0, chunk_.records), uncompressed, records) + chunk_.records));
  const std::uint64_t length = size_ - start;
  std::string indexes;
  std::map<std::uint16_t, std::uint64_t> places;
  for (const auto& [channel, of_channel] : chunk_.index) {
    places[channel] = size_ + indexes.size();
    indexes += record(Record::message_index, content(channel, of_channel));
  }
  emit(indexes);
  chunk_indexes_ +=
      record(Record::chunk_index, content(first, last, start, length, entries(places),
                                          std::uint64_t{indexes.size()}, uncompressed, records, records));
  ++chunks_;
  chunk_ = {};
}

std::string McapWriter::statistics() const {
  constexpr std::uint32_t kAttachments = 0;
  std::uint64_t all = 0;
  for (const auto& [channel, count] : messages_) all += count;
  return record(
      Record::statistics,
      content(all, static_cast<std::uint16_t>(schemas_.size()), static_cast<std::uint32_t>(messages_.size()),
              kAttachments, metadata_, chunks_, times_.first, times_.last, entries(messages_)));
}

void McapWriter::finish() {
  close_chunk();
  emit(record(Record::data_end, content(crc_)));
  const std::uint64_t start = size_;
  std::string summary, offsets;
  const auto add = [&](Record kind, const std::string& records) {
    if (records.empty()) return;
    offsets += record(Record::summary_offset, content(static_cast<std::uint8_t>(kind), start + summary.size(),
                                                      std::uint64_t{records.size()}));
    summary += records;
  };
  add(Record::schema, schema_records_);
  add(Record::channel, channel_records_);
  add(Record::statistics, statistics());
  add(Record::chunk_index, chunk_indexes_);
  add(Record::metadata_index, metadata_indexes_);
  // The CRC covers everything from the start of the summary to the footer's own field for it.
  std::string footer = record(Record::footer, content(start, start + summary.size(), std::uint32_t{0}));
  footer.resize(footer.size() - sizeof(std::uint32_t));
  const std::string checked = summary + offsets + footer;
  emit(checked + content(crc_after(0, checked)) + kMagic);
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

std::string point_cloud_message(std::uint64_t time_ns, const std::vector<std::string>& fields,
                                const std::string& data) {
  constexpr std::uint32_t kFieldSize = 4;
  constexpr std::uint8_t kFloat32 = 7;  // in sensor_msgs/PointField
  const auto step = static_cast<std::uint32_t>(kFieldSize * fields.size());
  CdrMessage message(time_ns);
  message.number(std::uint32_t{1});                                // height
  message.number(static_cast<std::uint32_t>(data.size() / step));  // width
  message.number(static_cast<std::uint32_t>(fields.size()));
  for (std::uint32_t i = 0; i < fields.size(); ++i) {
    message.text(fields[i]);
    message.number(kFieldSize * i);  // offset
    message.number(kFloat32);
    message.number(std::uint32_t{1});  // count
  }
  message.number(std::uint8_t{0});  // is_bigendian
  message.number(step);
  message.number(static_cast<std::uint32_t>(data.size()));  // row_step
  message.bytes(data);
  message.number(std::uint8_t{1});  // is_dense: every point was measured
  return message.whole();
}

void write_mcap(const ExportJob& job) {
  const ExportedRun run = exported_run(job);
  job.begin(job.output, McapWriter::opening());
  McapWriter mcap([&](const std::string& bytes) { job.files.append(bytes); });
  RunMessages messages(job, run, mcap);
  TextAttributes attributes = job.result.attributes();
  if (job.every > 1)
    attributes.emplace_back("ticks", "one in " + std::to_string(job.every) + " is kept, and the last one");
  mcap.add_metadata("remote-touch", attributes);
  for_each_frame(job, run, [&](const ExportedFrame& frame) { messages.add(frame); });
  messages.add_ticks_before(std::numeric_limits<double>::infinity());
  mcap.finish();
}

}  // namespace remote_touch
