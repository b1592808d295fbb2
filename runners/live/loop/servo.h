// One live tick: reads the device, makes the changes of the user, takes the newest frame, renders, applies
// the safety gate, writes to the device; what passes to the tick and from it; and the feed of the camera.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/rendering/renderer.h"
#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/hand/teleoperation.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/depth_source.h"
#include "runners/live/sensors/sensor_table.h"

namespace remote_touch {

// A lock-free queue of fixed length from one thread to another. One producer, one consumer. Allocates on
// construction only.
template <class T>
class Ring {
 public:
  // min_capacity: rounded up to a power of two.
  explicit Ring(std::size_t min_capacity) : slots_(std::bit_ceil(min_capacity)) {}

  // The slot to write next, or null if the queue is full; push() passes it on.
  T* next_slot() {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - start_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[end & (slots_.size() - 1)];
  }
  void push() { end_.store(end_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  // The oldest value, or null; pop() removes it.
  T* oldest() {
    const std::size_t start = start_.load(std::memory_order_relaxed);
    if (start == end_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[start & (slots_.size() - 1)];
  }
  void pop() { start_.store(start_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> end_ = 0;
  alignas(64) std::atomic<std::size_t> start_ = 0;
};

// A change of a live parameter. parameter: its number in LiveControls::parameters().
struct ParameterChange {
  std::int32_t parameter = 0;
  double value = 0;
};

// Live parameters that change together, on their way to the haptic loop.
struct ParameterChanges {
  static constexpr std::size_t kMax = 4;
  std::array<ParameterChange, kMax> list;
  std::size_t count = 0;
  std::span<const ParameterChange> all() const { return {list.data(), count}; }
};

// Parameters that the user changes during a live run. A change is checked outside the haptic loop, and made
// by the loop between two ticks.
class LiveControls {
 public:
  enum class Camera { simulated, other };
  // Only the renderer's parameters can change if the camera is not the experiment's scenario. An experiment
  // with changes of its own has no live parameters.
  LiveControls(const Experiment& experiment, const Kernels& kernels, Camera camera);

  // The parameters of the renderer, in the order of Renderer::live_parameters(), then those of the scenario.
  const std::vector<LiveParameter>& parameters() const { return parameters_; }

  // Their present values: the loop uses them already, or will in one of its next ticks. Only the thread of
  // change() may call it.
  const std::vector<double>& values() const { return values_; }
  bool has_changed() const;
  // Requests changes. Returns an empty text if the loop will make them together, else the reason why not, in
  // one line. Only one thread may call it.
  std::string change(const ParameterChanges& changes);

  // The run uses the following functions.
  Ring<ParameterChanges>& requested() { return requested_; }
  const std::shared_ptr<ShownScenario>& scenario() const { return shown_; }  // null with another camera
  // Refuses a greater stiffness than at the start from now on. A device with motors needs this limit, because
  // it is not known whether a greater stiffness is stable.
  void limit_stiffness() { has_stiffness_limit_ = true; }

 private:
  Experiment checked(const std::vector<double>& values) const;
  bool is_of_scenario(const ParameterChanges& changes) const;

  const Kernels& kernels_;
  const std::string configuration_;
  const double max_stiffness_N_per_m_;
  std::vector<LiveParameter> parameters_;
  std::size_t of_renderer_ = 0;
  std::vector<double> values_;  // now
  std::shared_ptr<ShownScenario> shown_;
  Ring<ParameterChanges> requested_{64};
  std::atomic<bool> has_stiffness_limit_ = false;
};

// A frame on its way to the servo.
struct LiveFrame {
  Frame frame;
  double sensed_s = 0;  // times of the clock: the sensor's time stamp, and when the frame was ready
  double ready_s = 0;
  std::uint64_t hash = 0;  // frame_hash()
};

// Everything that one tick has read, computed and written.
struct LiveTick {
  std::int64_t number = 0;  // the tick's time since the start is number / haptic rate
  DeviceState device;
  RenderOutput out;
  std::optional<SlaveState> slave;  // present if the experiment has a slave
  Wrench command;                   // wrench that the device was commanded to exert, before the gate
  ParameterChanges changed;         // changes made before this tick
  int taken = -1;          // index of the frame that the renderer received before this tick; -1: none
  std::uint64_t hash = 0;  // hash of the newest frame taken
  Wrench written;          // wrench written to the device, in its axes; zero if the device refused it
  GateState gate = GateState::waiting;
  bool is_limited = false;      // see SafetyGate::is_limiting()
  float step_s = 0;             // time for taking the frame, rendering and the slave
  float since_last_tick_s = 0;  // time from the start of the tick before to the start of this one
  float latency_s = 0;          // if a frame was taken: sensor's time stamp to the write that it affects
  float waited_s = 0;           // if a frame was taken: its time from ready to taken
};

// The place of a slave after a tick, world frame.
struct SlavePlace {
  double time_s = 0;
  Vec3 position_W = Vec3::Zero();
};

// The objects that the servo shares with other parts. All must outlive it.
struct ServoLinks {
  HapticDevice& device;
  Renderer& renderer;
  TripleBuffer<LiveFrame>& frames;
  Ring<LiveTick>& rows;
  const Clock& clock;
  const std::atomic<bool>& stop;
  // A second stop flag, set by the program's signals, and an end time: the loop checks both itself, because
  // the thread that waits for it may be blocked by the terminal that it writes to.
  const std::atomic<bool>* signal = nullptr;
  std::int64_t ends_ns = std::numeric_limits<std::int64_t>::max();  // time of the clock at which the run ends
  // Changes of the experiment, and changes that the user requests while it runs; null: none.
  const std::vector<RendererChange>* scripted = nullptr;
  Ring<ParameterChanges>* requested = nullptr;
  Teleoperation* remote = nullptr;     // null: no slave, so the hand feels the force of the renderer
  Ring<SlavePlace>* places = nullptr;  // where the slave was, for the thread of the camera; null: not needed
};

// The servo allocates nothing, takes no lock, opens no file and reads no clock but the given one, except in
// the device's calls. Ticks are numbered by the clock: a missed one leaves a gap; if the device is faster
// than the rate, each tick still has its own number. The time of a tick is rounded up to a full period. A
// tick is moved to a later number if a frame was captured while the device was read, so that no frame is used
// before it was captured. A slave moves in the ticks that are missing, too, see Teleoperation.
class Servo {
 public:
  // stall_s: longest time without a tick before the heartbeat releases the device.
  Servo(const ServoLinks& links, const DevicePlacement& placement, const SafetyLimits& limits, double rate_hz,
        std::int64_t start_ns, double stall_s);

  bool tick() noexcept;  // a DeviceTick
  static constexpr const char* kNoMemory = "out of memory in the haptic loop";

  // Other threads may call the following functions.
  void rearm() noexcept { gate_.rearm(); }
  // Another thread must call its check() while the loop runs.
  Heartbeat& heartbeat() { return heartbeat_; }
  std::int64_t rows_lost() const { return rows_lost_.load(std::memory_order_relaxed); }
  bool is_latched() const { return latched_.load(std::memory_order_acquire); }
  // Reason of the newest latch or failure.
  const char* trouble() const { return trouble_.load(std::memory_order_acquire); }
  // True if the device or the loop has failed; rearm() does not help then.
  bool has_failed() const { return failed_.load(std::memory_order_acquire); }

 private:
  void one_tick();
  DeviceFault read(DeviceReading& reading) noexcept;
  bool end_for(const DeviceFault& trouble) noexcept;  // returns false
  const char* text_of(const char* reason) noexcept;
  bool is_over() const noexcept;
  std::int64_t next_number(std::int64_t now_ns);
  void move_on_to(double time_s, LiveTick& row);
  void take_frame(LiveTick& row);
  void make_changes(LiveTick& row);
  void note(const DeviceFault& fault, bool of_device) noexcept;

  const ServoLinks links_;
  const DevicePlacement placement_;
  const double rate_hz_;
  const Parameters live_;  // live parameters of the renderer
  RendererChanges scripted_;
  const std::int64_t start_ns_;
  SafetyGate gate_;
  Heartbeat heartbeat_;
  std::int64_t last_number_ = -1;
  std::int32_t frames_taken_ = 0;
  std::optional<double> taken_s_;  // time of the clock at which the newest frame was taken
  std::int64_t last_tick_ns_ = 0;
  std::optional<DeviceReading> last_reading_;  // the newest that succeeded
  LiveTick row_;
  std::atomic<std::int64_t> rows_lost_ = 0;
  std::array<char, 512> exception_text_{};  // text of the exception that ended the loop; written once
  std::atomic<const char*> trouble_ = nullptr;
  std::atomic<bool> failed_ = false, latched_ = false;
};

// Queues a frame to be recorded. Returns false if the recorder's queue is full.
using FrameSink = std::function<bool(const SensorFrame&, const Frame&, std::uint64_t fixtures_off)>;

struct CameraCounts {
  int received = 0;
  int skipped = 0;     // frame numbers that never came: not sent, or a newer frame came first
  int reversed = 0;    // not newer than the frame before; dropped
  int incomplete = 0;  // colours that the sensor's view promises are missing, or the size differs; dropped
  int held_back = 0;   // not sent, because the dead-band of frames did not let them pass
  int overtaken = 0;   // ready, but replaced by a newer one before the servo took them
  int unrecorded = 0;  // dropped, because the recorder's queue was full
  double max_pause_s = 0;
  double processing_s = 0;  // sum over the frames
};

// Returns true if a processed frame has to be sent to the servo.
using FrameChoice = std::function<bool(const Frame&)>;

// Passes frames from the sensor to the servo, processed and prepared, one step at a time.
//
// Frames that the renderer may hold are also held here until nothing else holds them, so that their memory is
// freed by the thread that calls step().
class CameraFeed {
 public:
  static constexpr const char* kEnd = "the recording has ended";
  static constexpr const char* kNoMemory = "out of memory";

  CameraFeed(std::unique_ptr<DepthSource> source, FrameProcessing processing, const Renderer& renderer,
             const RigidTransform& registration, const Clock& clock, std::int64_t start_ns,
             TripleBuffer<LiveFrame>& out, FrameSink sink, std::function<void(const Frame&)> on_frame = {},
             FrameChoice sends = {});

  // Waits at most patience_s for the next frame and passes it on. Returns false if there will be no more. It
  // checks each frame against the needs of the renderer and the rules, as FrameStream does in a simulated
  // run.
  bool step(double patience_s) noexcept;

  // Other threads may call the following functions, except sensed().
  CameraCounts counts() const;  // counts up to the newest frame
  std::string ended() const;    // reason why there are no more frames; empty while there may be more
  // True if an input error has ended the frames: a frame cannot be used, and ended() names it.
  bool has_refused() const { return refused_.load(std::memory_order_acquire); }
  // The time of the clock when the newest frame was ready, sent or not; the start of the run before the first
  // frame.
  double newest_s() const { return newest_s_.load(std::memory_order_relaxed); }
  // True if a frame was sent to the servo.
  bool has_sent() const { return has_sent_.load(std::memory_order_acquire); }
  const SensorView& view() const { return source_->view(); }
  const SensedPoints& sensed() const { return sensed_points_; }  // pre: step() is no longer called

 private:
  void handle(SensorFrame& sensed);
  bool is_newer(const SensorFrame& sensed);
  void send(Frame frame, double sensed_s);
  bool end(std::string_view why) noexcept;  // returns false

  const std::unique_ptr<DepthSource> source_;
  const FrameProcessing processing_;
  const Renderer& renderer_;
  const RigidTransform X_WC_;
  const Clock& clock_;
  const double start_s_;
  TripleBuffer<LiveFrame>& out_;
  const FrameSink sink_;
  const std::function<void(const Frame&)> on_frame_;  // called with every frame that is sent; may be empty
  const FrameChoice sends_;                           // empty: all frames are sent
  SensorFrame sensed_;
  CameraCounts counts_;
  SensedPoints sensed_points_;  // points in the frames that were sent
  mutable std::mutex reported_mutex_;
  CameraCounts reported_;  // copy of counts_, made after the newest frame
  int index_ = 0, last_number_ = -1;
  double last_captured_s_ = 0;
  std::deque<Frame> held_;
  std::atomic<double> newest_s_;
  std::string why_;
  std::atomic<bool> ended_ = false, refused_ = false, has_sent_ = false;
};

}  // namespace remote_touch
