#include "runners/presentation/export/mcap_file.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/storage/hdf5_file.h"
#include "core/geometry/colour.h"
#include "runners/presentation/export/exported_run.h"

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

std::string record(Record kind, const std::string& content) {
  std::string bytes;
  put(bytes, static_cast<std::uint8_t>(kind));
  put(bytes, std::uint64_t{content.size()});
  return bytes + content;
}

// Appends the length of the text, then the text.
void put_text(std::string& bytes, const std::string& text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

std::string text_map(const McapWriter::Texts& texts) {
  std::string entries, map;
  for (const auto& [name, value] : texts) put_text(entries, name), put_text(entries, value);
  put_text(map, entries);
  return map;
}

void put_number_map(std::string& bytes, const std::map<std::uint16_t, std::uint64_t>& numbers) {
  std::string entries;
  for (const auto& [channel, number] : numbers) put(entries, channel), put(entries, number);
  put_text(bytes, entries);
}

std::string header_record(const std::string& profile, const std::string& library) {
  std::string content;
  put_text(content, profile), put_text(content, library);
  return record(Record::header, content);
}

}  // namespace

void McapWriter::Times::add(std::uint64_t time_ns) {
  first = is_empty ? time_ns : std::min(first, time_ns);
  last = is_empty ? time_ns : std::max(last, time_ns);
  is_empty = false;
}

std::string McapWriter::opening(const std::string& profile, const std::string& library) {
  return kMagic + header_record(profile, library);
}

McapWriter::McapWriter(const std::string& profile, const std::string& library,
                       std::function<void(const std::string&)> write)
    : write_(std::move(write)) {
  emit(opening(profile, library));
}

void McapWriter::emit(const std::string& bytes) {
  write_(bytes);
  crc_ = crc_after(crc_, bytes);
  size_ += bytes.size();
}

std::uint16_t McapWriter::add_topic(const McapTopic& topic) {
  const auto [known, is_new] =
      schemas_.try_emplace(topic.schema, static_cast<std::uint16_t>(schemas_.size() + 1));  // 0: no schema
  if (is_new) {
    std::string content;
    put(content, known->second);
    put_text(content, topic.schema), put_text(content, topic.schema_encoding);
    put_text(content, topic.schema_text);
    schema_records_ += record(Record::schema, content);
    chunk_.records += record(Record::schema, content);
  }
  const auto channel = static_cast<std::uint16_t>(messages_.size());
  std::string content;
  put(content, channel), put(content, known->second);
  put_text(content, topic.name), put_text(content, topic.message_encoding);
  content += text_map({});
  channel_records_ += record(Record::channel, content);
  chunk_.records += record(Record::channel, content);
  messages_[channel] = 0;
  return channel;
}

void McapWriter::add_metadata(const std::string& name, const Texts& texts) {
  std::string content, index;
  put_text(content, name);
  content += text_map(texts);
  const std::string whole = record(Record::metadata, content);
  put(index, size_), put(index, std::uint64_t{whole.size()});
  put_text(index, name);
  metadata_indexes_ += record(Record::metadata_index, index);
  ++metadata_;
  emit(whole);
}

void McapWriter::message(std::uint16_t channel, std::uint64_t log_ns, std::uint64_t publish_ns,
                         const std::string& data) {
  std::string& index = chunk_.index[channel];
  put(index, log_ns), put(index, std::uint64_t{chunk_.records.size()});
  std::string content;
  put(content, channel), put(content, static_cast<std::uint32_t>(messages_[channel]++));
  put(content, log_ns), put(content, publish_ns);
  chunk_.records += record(Record::message, content + data);
  chunk_.times.add(log_ns);
  times_.add(log_ns);
  if (chunk_.records.size() >= kChunkSize) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.records.empty()) return;
  const std::uint64_t start = size_, records = chunk_.records.size();
  std::string content, indexes, index;
  put(content, chunk_.times.first), put(content, chunk_.times.last);
  put(content, records), put(content, crc_after(0, chunk_.records));
  put_text(content, "");  // not compressed
  put(content, records);
  emit(record(Record::chunk, content + chunk_.records));
  const std::uint64_t length = size_ - start;
  std::map<std::uint16_t, std::uint64_t> places;
  for (const auto& [channel, entries] : chunk_.index) {
    places[channel] = size_ + indexes.size();
    std::string of_channel;
    put(of_channel, channel), put_text(of_channel, entries);
    indexes += record(Record::message_index, of_channel);
  }
  emit(indexes);
  put(index, chunk_.times.first), put(index, chunk_.times.last);
  put(index, start), put(index, length);
  put_number_map(index, places);
  put(index, std::uint64_t{indexes.size()});
  put_text(index, "");
  put(index, records), put(index, records);
  chunk_indexes_ += record(Record::chunk_index, index);
  ++chunks_;
  chunk_ = {};
}

std::string McapWriter::statistics() const {
  std::uint64_t all = 0;
  for (const auto& [channel, count] : messages_) all += count;
  std::string content;
  put(content, all), put(content, static_cast<std::uint16_t>(schemas_.size()));
  put(content, static_cast<std::uint32_t>(messages_.size())), put(content, std::uint32_t{0});  // attachments
  put(content, metadata_), put(content, chunks_);
  put(content, times_.first), put(content, times_.last);
  put_number_map(content, messages_);
  return record(Record::statistics, content);
}

void McapWriter::finish() {
  close_chunk();
  std::string end;
  put(end, crc_);
  emit(record(Record::data_end, end));
  const std::uint64_t start = size_;
  std::string summary, offsets;
  const auto add = [&](Record kind, const std::string& records) {
    if (records.empty()) return;
    std::string offset;
    put(offset, static_cast<std::uint8_t>(kind));
    put(offset, start + summary.size()), put(offset, std::uint64_t{records.size()});
    offsets += record(Record::summary_offset, offset);
    summary += records;
  };
  add(Record::schema, schema_records_);
  add(Record::channel, channel_records_);
  add(Record::statistics, statistics());
  add(Record::chunk_index, chunk_indexes_);
  add(Record::metadata_index, metadata_indexes_);
  // The CRC covers everything from the start of the summary to the footer's own field for it.
  std::string footer;
  put(footer, start), put(footer, start + summary.size());
  put(footer, std::uint32_t{0});
  footer = record(Record::footer, footer);
  footer.resize(footer.size() - sizeof(std::uint32_t));
  const std::string checked = summary + offsets + footer;
  emit(checked);
  std::string sum;
  put(sum, crc_after(0, checked));
  emit(sum + kMagic);
}

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
  mcap.add_metadata("remote-touch", job.result.attributes());
  for_each_frame(job, run, [&](const ExportedFrame& frame) { messages.add(frame); });
  messages.add_ticks_before(std::numeric_limits<double>::infinity());
  mcap.finish();
}

}  // namespace remote_touch
