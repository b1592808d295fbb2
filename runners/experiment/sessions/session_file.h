// A live session on disk: its file, its recording, and its settings, which are the poses of device and camera
// and the limits of the safety gate.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/storage/block_journal.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"
#include "runners/experiment/sessions/sensor_frame.h"

namespace remote_touch {

// The poses of device and camera in the world, as settings.
struct LiveSettings {
  Vec3 device_position_m = Vec3::Zero();
  Vec3 device_rotation_deg = Vec3::Zero();
  double device_scale = 1;
  Vec3 camera_position_m = Vec3::Zero();
  Vec3 camera_rotation_deg = Vec3::Zero();
};

Parameters parameters(LiveSettings& s);
inline std::string validate(const LiveSettings&) {
  return {};
}

// Registration X_WC of the camera from these settings; applied to the camera pose that its source reports.
RigidTransform camera_registration(const LiveSettings& s);

// The limits of a live run's safety gate, as settings.
struct SafetyLimits {
  double max_force_N = 5;
  double max_torque_Nm = 0.2;
  double force_slew_N_per_s = 1000;
  double torque_slew_Nm_per_s = 40;
  double max_speed_m_per_s = 3;
  double max_angular_speed_rad_per_s = 40;
  double engage_force_N = 0.3;
  double ramp_s = 0.5;
  double max_command_age_s = 0.02;
  double max_frame_age_s = 0;
};

Parameters parameters(SafetyLimits& s);
std::string validate(const SafetyLimits& s);

// A live session on disk, as one HDF5 file: the device's state at every tick, the sensor's frames, and the
// ticks at which the renderer received them.

struct SessionTick {
  std::int64_t number = 0;  // time of the tick times the haptic rate
  DeviceState device;       // state that the renderer received
  int taken = -1;           // the frame that the renderer received before this tick; -1: none
  Wrench written;           // wrench written to the device, in its axes
  int gate = 0;             // 0 waiting, 1 ramping, 2 engaged, 3 latched
};

// The address of the sensor, attribute `depth`, if the experiment's scenario was the camera.
inline constexpr const char* kSimulatedDepth = "sim:";

// The value of the attribute `ended` of a recording that was interrupted and then recovered.
inline constexpr const char* kInterruptedRecording = "interrupted";

// A live parameter that was changed. tick: number of the first tick with the new value. For a parameter of
// the scenario: number of the tick at which the change was requested (frames with the new noise come later).
struct SessionChange {
  std::uint64_t tick = 0;
  std::int32_t parameter = 0;  // its index in the list of names
  double value = 0;
};

// The shape of the frames of a session.
struct SessionLayout {
  std::uint32_t width = 0, height = 0;  // size of the images; 0: clouds
  std::uint32_t numbers_per_point = 0;  // numbers per point of clouds: 3, or 6 with normals; 0: images
  bool has_colour = false;

  bool has_clouds() const { return numbers_per_point > 0; }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }
};
SessionLayout layout_of(const SensorView& view);

// A frame in the form in which a session stores it. Images are rows of deflated_row(). Points and their
// colours are not compressed.
struct StoredFrame {
  std::int32_t number = 0;
  double captured_s = 0;
  std::uint64_t fixtures_off = 0;
  std::uint32_t point_count = 0;
  std::string depth, colour;  // the bytes; for clouds depth holds the points, as float
};
// pre: is_complete(frame, view), and layout is layout_of(view).
StoredFrame stored_frame(const SessionLayout& layout, const SensorFrame& frame, double captured_s,
                         std::uint64_t fixtures_off);

// Returns the attributes of a session: schema, view, provenance, and live_parameters (their names).
// registered: X_WC of the camera, including its registration.
TextAttributes session_attributes(const SensorView& view, const RigidTransform& registered,
                                  const TextAttributes& provenance,
                                  const std::vector<std::string>& live_parameters);

// Writes a session file with these datasets. /ticks: number, position, orientation, buttons (as the renderer
// received them), taken, force and torque as written to the device, gate. /frames: number, captured,
// fixtures_off; also depth and colour of images, or point_count, points and colour of clouds. /changes: tick,
// parameter, value. The root has the attributes of session_attributes() and of finish().
class SessionWriter {
 public:
  SessionWriter(const std::filesystem::path& target, const SessionLayout& layout,
                const TextAttributes& attributes);
  SessionWriter(const std::filesystem::path& target, const SensorView& view, const RigidTransform& registered,
                const TextAttributes& provenance, const std::vector<std::string>& live_parameters = {})
      : SessionWriter(target, layout_of(view),
                      session_attributes(view, registered, provenance, live_parameters)) {}

  void append(const SessionChange& change);
  void append(const SessionTick& tick);  // written to the disk a thousand at a time
  void append(const StoredFrame& frame);
  void append(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off) {
    append(stored_frame(layout_, frame, captured_s, fixtures_off));
  }
  // attributes: further attributes, which are known only at the end.
  void finish(const TextAttributes& attributes = {});

 private:
  void add_cloud_datasets();
  void flush_ticks();

  Hdf5Appender file_;
  const SessionLayout layout_;
  struct {
    std::vector<std::uint64_t> number;
    std::vector<double> position, orientation, force, torque;
    std::vector<std::uint32_t> buttons;
    std::vector<std::int32_t> taken, gate;
  } ticks_;
};

// Throws InputError, which names the file, if it is not a session or is damaged.
class SessionReader {
 public:
  explicit SessionReader(const std::filesystem::path& file) : SessionReader(Hdf5Reader(file)) {}
  explicit SessionReader(Hdf5Reader file);

  std::string config() const;  // the experiment that was run, as JSON
  // Returns the reason why the recording ended. It is kInterruptedRecording if the program did not end the
  // recording, and empty in recordings of earlier versions.
  std::string ended() const;
  // The address of the sensor, such as "sim:"; empty in recordings of earlier versions.
  std::string depth() const;
  double haptic_rate_hz() const { return haptic_rate_hz_; }
  const SensorView& view() const { return view_; }
  std::size_t frame_count() const { return captured_s_.size(); }
  SensorFrame frame(std::size_t i) const;
  double captured_s(std::size_t i) const { return captured_s_[i]; }
  std::uint64_t fixtures_off(std::size_t i) const { return fixtures_off_[i]; }

  // Ticks are in the order in which they came. Their numbers increase, with gaps where ticks were missed.
  std::size_t tick_count() const { return number_.size(); }
  std::uint64_t tick_number(std::size_t i) const { return number_[i]; }
  DeviceState device(std::size_t i) const;
  std::int32_t taken(std::size_t i) const { return taken_[i]; }

  // Returns the changes in the order of their ticks.
  const std::vector<SessionChange>& changes() const { return changes_; }
  const std::string& live_parameter(const SessionChange& change) const {
    return live_parameters_[static_cast<std::size_t>(change.parameter)];
  }

 private:
  void read_view();
  void read_changes();
  void require_order() const;
  void read_point_counts();
  void read_points(std::size_t i, SensorFrame& frame) const;
  struct Rows {
    std::size_t first, count;
  };
  template <class Stored, class Number>
  void read_numbers(const char* dataset, Rows rows, std::size_t expected, std::vector<Number>& numbers) const;

  Hdf5Reader file_;
  SensorView view_;
  double haptic_rate_hz_ = 0;
  std::vector<double> captured_s_, position_, orientation_, buttons_;
  std::vector<std::uint64_t> fixtures_off_, number_;
  std::vector<std::int32_t> frame_number_, taken_;
  std::vector<std::size_t> first_point_;  // index of the first point of each cloud; at the end the total
  std::vector<SessionChange> changes_;
  std::vector<std::string> live_parameters_;
};

// Records a live session so that no failure of the program loses it. While the session runs, the recording is
// a journal beside its file (analysis/storage/block_journal.h). At the end a session file is made of the
// journal. If there is no end, because the program is killed or the disk is full, the journal stays.
//
// Members throw InputError, which names the target, if it cannot be written. Only one thread may use an
// object at a time, except for sync().
class SessionRecorder {
 public:
  // Ticks are written in blocks of at least this many, and are only in memory until then. More ticks wait if
  // they took a frame that is not written yet.
  static constexpr std::size_t kTicksInABlock = 100;

  // Throws InputError if the journal of the target exists already.
  SessionRecorder(const std::filesystem::path& target, const SensorView& view,
                  const RigidTransform& registered, const TextAttributes& provenance,
                  const std::vector<std::string>& live_parameters = {});
  // If finish() has not succeeded, keeps the journal if a tick or a frame was recorded, and removes it
  // otherwise.
  ~SessionRecorder();
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;

  // A change must be appended before the tick that has its number.
  void append(const SessionTick& tick);
  void append(const SessionChange& change) { changes_.push_back(change); }
  void append(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off);
  // Makes everything that was written until now survive a power cut. Another thread may call it.
  void sync() const { journal_.sync(); }
  // Makes the session file, with these attributes added, and then removes the journal. If it throws, the
  // journal stays, with every block that was written. Throws InputError also if a tick took a frame that was
  // not appended, or a change has no tick. attributes: `ended`, why the run ended, and others that
  // are known only at the end.
  void finish(const TextAttributes& attributes);

  // Writes the ticks in memory, if there is room. Returns "FILE keeps N ticks and M frames; ..."; empty if
  // finish() has succeeded or nothing is kept.
  std::string keep() noexcept;

 private:
  void flush(std::size_t at_least);
  void require_nothing_left() const;
  std::size_t ready_ticks() const;

  const std::filesystem::path target_;
  const SessionLayout layout_;
  JournalWriter journal_;
  std::vector<SessionTick> ticks_;
  std::vector<SessionChange> changes_;
  std::uint64_t ticks_written_ = 0, frames_written_ = 0;
  bool finished_ = false;
};

// The content of the journal of a session that was not finished, up to the last whole block. A block of ticks
// is whole only if the frames that these ticks took come before it.
struct UnfinishedSession {
  TextAttributes attributes;  // attributes of the session, without those known only at its end
  std::uint64_t ticks = 0, frames = 0, changes = 0;
  std::int64_t last_tick = -1;       // its number; -1: there are none
  bool has_end = false;              // the last block is there: only the session file was not made
  TextAttributes ending;             // attributes known at that end: `ended`, the reason, and others
  std::uint64_t left_out_bytes = 0;  // number of bytes after the last whole block
  bool is_growing = false;           // its program was recording when the journal was opened
};

// Throws InputError if the file is missing, or if it is no journal of a session with a whole first block.
// Does not decompress images.
UnfinishedSession read_unfinished(const std::filesystem::path& journal);

// Makes a session file of the journal, which stays unchanged. If the recording was interrupted, `ended` is
// kInterruptedRecording, and `notes` states the number of ticks and frames. A block whose images cannot be
// decompressed counts as not whole. Throws InputError as read_unfinished() does. It also throws InputError if
// the journal holds neither ticks nor frames, if its program is still recording, or if the target cannot be
// written.
UnfinishedSession recover_session(const std::filesystem::path& journal, const std::filesystem::path& target);

// The same for the program that recorded the journal, after it has written the last block. The compressed
// images are not checked again. Throws InputError also if a block is not as it was written.
void make_session(const std::filesystem::path& journal, const std::filesystem::path& target);

// The kinds of blocks in the journal, and functions that pack their contents.
enum class SessionBlock : std::uint32_t { start, ticks, frame, end };
std::string packed_start(const SessionLayout& layout, const TextAttributes& attributes);
// changes: those of these ticks, and of ticks that were missed between them.
std::string packed_ticks(std::span<const SessionTick> ticks, std::span<const SessionChange> changes);
std::string packed_frame(const StoredFrame& frame);
std::string packed_end(const TextAttributes& attributes);

}  // namespace remote_touch
