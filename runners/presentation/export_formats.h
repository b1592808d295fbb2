// Results in the formats of other programs. A further format is one source here and one line in the table.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/trace/columns.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/kernels/kernels.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

// The input of every format of an export: the result, the output and the files to write.
struct ExportJob {
  const Hdf5Reader& result;
  std::filesystem::path output;
  NewFiles& files;
  // Throws InputError unless the file may be written: it must be absent, or begin with `opening` as an
  // earlier export does.
  std::function<void(const std::filesystem::path& file, const std::string& opening)> require_allowed;
  const Kernels* kernels = nullptr;         // pre: set
  const std::atomic<bool>* stop = nullptr;  // when set, ends with Interrupted
  int every = 1;                            // one in so many ticks of a trace is kept, and the last one

  bool keeps(std::size_t tick, std::size_t ticks) const {
    return tick % static_cast<std::size_t>(every) == 0 || tick + 1 == ticks;
  }
  void begin(const std::filesystem::path& file, const std::string& opening) const {
    if (require_allowed) require_allowed(file, opening);
    files.begin(file);
  }
  // Throws Interrupted when the user wants the program to end.
  void go_on() const;
};

// Appends the numbers one after another, as files store them: little-endian, without gaps.
template <class... Numbers>
void put(std::string& bytes, Numbers... numbers) {
  static_assert(std::endian::native == std::endian::little && (std::is_arithmetic_v<Numbers> && ...));
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
}

// A stored trace as other programs show it, with a row for each tick. Its frames are made again.
struct ExportedRun {
  Experiment experiment;
  std::vector<double> time_s = {};  // finite, 0 or more
  std::vector<Vec3> hip_W = {}, proxy_W = {}, force_N = {};
  std::vector<Vec3> torque_Nm = {};  // zeros if the trace does not have the column, as without a tool
  // Identity if the trace does not have the column, as without a tool.
  std::vector<Eigen::Quaterniond> hip_orientation_W = {}, tool_orientation_W = {};
  std::vector<std::int32_t> frame = {};        // newest in use
  std::vector<std::uint64_t> frame_hash = {};  // 0: not computed
  std::shared_ptr<const VoxelTool> tool = {};  // null: a proxy

  std::size_t ticks() const { return time_s.size(); }
  ToolPose tool_pose(std::size_t tick) const { return {proxy_W[tick], tool_orientation_W[tick]}; }
};

// Throws InputError for a trace that is damaged, and as experiment_of_run().
ExportedRun exported_run(const ExportJob& job);

struct ExportedFrame {
  double captured_s = 0, arrives_s = 0;
  std::size_t first_tick = 0;  // first tick that used the frame
  PointCloud points;           // the measured ones
};
// Calls use() for every frame that a tick used, in order. Throws InputError if the frames cannot be made
// again or are not those of the run. Throws Interrupted.
void for_each_frame(const ExportJob& job, const ExportedRun& run,
                    const std::function<void(const ExportedFrame&)>& use);

struct ExportFormat {
  const char* ending;  // ending of the output's name, ".csv"
  const char* meaning;
  bool traces_only;
  void (*write)(const ExportJob& job);
};

const std::vector<ExportFormat>& export_formats();
// Returns all formats in one line, for the help of the command.
std::string known_formats();

// Returns the format of the output's ending. Throws InputError, which names the known endings, if there is
// none.
const ExportFormat& export_format(const std::filesystem::path& output);

// Writes all files of the export; they appear when job.files is finished. Throws InputError for a result of a
// kind that the format or job.every does not accept, for one that is damaged, and as job.files does. Throws
// Interrupted.
void export_result(const ExportFormat& format, const ExportJob& job);

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

// Writes a trace as messages over time, for Foxglove, rerun and programs of ROS 2. Time is the simulated
// time, in nanoseconds. Topics:
//   /cloud         sensor_msgs/msg/PointCloud2     each frame in use, at the time of its arrival; its
//                                                  header has the time of capture
//   /hip, /proxy   geometry_msgs/msg/PoseStamped   in each tick
//   /tool          geometry_msgs/msg/PoseStamped   the same, in a run with a tool: its centre of mass
//   /force         geometry_msgs/msg/WrenchStamped force and torque on the hand, in each tick
void write_mcap(const ExportJob& job);

// Returns an array in the file format of NumPy, .npy, version 1.0. Its shape is (n,) or (n, width), its type
// little-endian: <f8, <i4, <u8, or <U for texts.
std::string npy_array(const Column& column);
// One text, of shape ().
std::string npy_text(const std::string& text);

// An archive in the format ZIP, whose members are stored as they are. Passes the bytes of the archive to
// `write` as it grows. It stores no times, so that equal members give equal bytes.
class ZipArchive {
 public:
  explicit ZipArchive(std::function<void(const std::string& bytes)> write) : write_(std::move(write)) {}
  // Throws std::length_error beyond 4 GiB or 65534 members, the limits of a ZIP archive without extensions.
  // Its text says which: "would be larger than 4 GiB".
  void add(const std::string& name, const std::string& content);
  void finish();

  // Returns the bytes with which an archive begins that has this first member.
  static std::string opening(const std::string& name, const std::string& content);

 private:
  struct Member {
    std::string name;
    std::uint32_t crc, size, at;
  };
  std::function<void(const std::string&)> write_;
  std::vector<Member> members_;
  std::uint64_t size_ = 0;
};

// Writes arrays for NumPy, one .npz archive: a member for each column, COLUMN, or TABLE/COLUMN if there are
// several tables. Numbers are as they are stored, vectors have shape (n, 3), enumerations are numbers. Before
// them are `format`, and `about`, a text of JSON: `attributes` of the result, and for each member `unit`,
// `meaning` and `names` of the values of an enumeration. Throws InputError beyond 4 GiB or 65534 arrays.
void write_npz(const ExportJob& job);

// Values of the points or cells of a piece.
struct VtkArray {
  std::string name;
  const char* type;    // "Float64", "Int32", "UInt64", "UInt8", as VTK names them
  int components = 1;  // number of components of each value
  std::string bytes;   // little-endian
};

// Points, lines and triangles in the XML format of VTK: .vtp.
struct VtkPolyData {
  double time_s = 0;
  std::vector<Vec3> points;
  bool has_vertices = false;                       // each point is a cell, so that it is drawn
  std::vector<std::vector<std::int64_t>> lines;    // the point indices of each line
  std::vector<std::array<std::int64_t, 3>> faces;  // triangles
  std::vector<VtkArray> of_points, of_cells;
};

inline constexpr const char* kVtkOpening = "<?xml version=\"1.0\"?>\n<!-- remote-touch export -->\n";

// Returns the whole file. The numbers follow the XML unchanged (appended, raw). Coordinates have 64 bits, so
// that no digit is lost.
std::string vtp_file(const VtkPolyData& data);

// Returns a text as it must be written in XML: in the value of an attribute, or between tags.
std::string xml_escaped(const std::string& text, bool is_quoted = true);

// Writes the scene of a trace for ParaView and VTK:
// x.vtp: the paths of the HIP and of the proxy as two lines, with the columns of the trace at each point.
// x_cloud_0000.vtp ...: the measured points of each frame in use. Points of unknown colour are grey; if there
// are some, has_colour is 0 for them and 1 for the others.
// x_tool_0000.vtp ...: the tool at its pose in the first tick that used the frame.
// x_cloud.vtp.series, x_tool.vtp.series: the names of these files with their times, as ParaView reads them.
// x.pvd: everything over time.
void write_vtp(const ExportJob& job);

// The tables of a stored result, as they are exported.

// "trace", "sweep" or "figure"; the table of a scorecard is a figure. Throws InputError for anything else.
std::string exported_kind(const Hdf5Reader& result);

// Returns the tables. A trace has one table, a row for each tick, with step_duration if it was measured.
// A sweep has one table, a row for each run: its value on each axis, replicate if there are several, state,
// the measures, round with refinement, notes if there are any, and error.
// A figure has its own tables.
// The columns of each table have the same length. Throws InputError for a file that is damaged.
std::vector<Table> result_tables(const Hdf5Reader& result);
// The same with the ticks that the job keeps. If these are not all, the first column is their number, `tick`.
std::vector<Table> result_tables(const ExportJob& job);

// Returns the root attributes of the result, with the names of axes in its tables.
TextAttributes exported_attributes(const Hdf5Reader& result, const std::vector<Table>& tables);

// Returns the names of the numbers in a row: force_x, force_y, force_z. The endings of a quaternion are w, x,
// y, z, and those of another width 0, 1, ... A column of width 1 has its own name.
std::vector<std::string> component_names(const Column& column);

// Writes tables as text, for spreadsheets, R and pandas: x.csv, or x_NAME.csv for each of several tables,
// with one line of names. Also writes x_columns.csv with a line for each of these names: table, column, unit,
// meaning. Lines end with a line feed.
void write_csv(const ExportJob& job);
// The same with these tables instead of those of the result.
void write_csv(const std::vector<Table>& tables, const ExportJob& job);

// Returns the line of names. The names of a vector are name_x, name_y, name_z.
std::string csv_header(const Table& table);
// Returns the rows first .. end - 1. Numbers are the shortest text that is read back as the same bits, or
// nan, inf, -inf. Enumerations have the names of their values. Texts are in quotes if they need them (RFC
// 4180).
std::string csv_rows(const Table& table, std::size_t first, std::size_t end);

}  // namespace remote_touch
