// The record of a live run, the trace and the times and counts of its ticks, and the report about it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/live/devices/clock.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

// Times of a run of any length, in bounded memory. Keeps all samples while there are at most kMax. When
// there are more, it keeps every second one, then every fourth, and so on, evenly over the run. size(),
// least() and greatest() are those of all samples.
class Samples {
 public:
  static constexpr std::size_t kMax = 1 << 20;  // 8 MB; 17 minutes at 1 kHz until the first is left out

  void push_back(double value);
  std::size_t size() const { return count_; }  // number of all samples
  double least() const { return least_; }
  double greatest() const { return greatest_; }
  const std::vector<double>& kept() const { return kept_; }
  double operator[](std::size_t i) const { return kept_[i]; }

 private:
  std::vector<double> kept_;
  std::size_t count_ = 0, stride_ = 1;
  double least_ = std::numeric_limits<double>::quiet_NaN(), greatest_ = least_;
};

// The greatest value of each piece of a run. Any run has at most 2 kPieces pieces, with equal numbers of
// values.
class GreatestOfPieces {
 public:
  static constexpr std::size_t kPieces = 1000;

  void push_back(double time_s, double value);
  const std::vector<double>& begin_s() const { return begin_s_; }
  const std::vector<double>& greatest() const { return greatest_; }

 private:
  void join_pairs();
  std::vector<double> begin_s_, greatest_;
  std::size_t length_ = 1, in_last_ = 0;
};

// The trace of a live run, and the times and counts of its ticks. Its memory is bounded: some hundred MB even
// after hours.
struct LiveLog {
  static constexpr std::size_t kMaxRows = 1'800'000;  // half an hour at 1 kHz: 0.4 GB, more with a tool

  // The first max_rows ticks. With a slave, device_force is the force that was commanded, before the gate.
  Trace trace;
  std::vector<double> row_step_s;  // LiveTick::step_s of each tick of the trace
  std::size_t max_rows = kMaxRows;
  std::int64_t ticks = 0;
  bool is_whole() const { return trace.length() == static_cast<std::size_t>(ticks); }

  Samples step_s;                     // LiveTick::step_s of every tick
  Samples interval_s;                 // time between the starts of ticks
  GreatestOfPieces pieces;            // greatest interval in each piece of the run
  Samples latency_s;                  // sensor's time stamp to the first write it affects, every frame taken
  Samples waited_s;                   // time from ready to taken, every frame taken
  std::int64_t missed_ticks = 0;      // tick numbers that were skipped
  std::int64_t exhausted_ticks = 0;   // ticks that ended before the tool came to rest
  std::int64_t zero_force_ticks = 0;  // ticks in which the gate was waiting or latched
  std::int64_t limited_ticks = 0;     // ticks in which the gate was engaged and limited force or torque
  std::int64_t contact_ticks = 0;     // ticks that touched a point, or with a force of the renderer or slave
  std::int64_t stale_ticks = 0;       // ticks before which no new frame came for stale_s
  std::int64_t reversed_frames = 0;   // frames taken although older than the one before; should be 0
  double max_force_N = 0;             // greatest force written to the device

  static constexpr double kStaleFrame_s = 0.2, kStaleFrames = 2.5;
  // Returns the time without a new frame after which the cloud is stale: 0.2 s, or 2.5 periods of a camera
  // slower than 12.5 Hz.
  static double stale_after_s(double frame_rate_hz) {
    return frame_rate_hz > 0 ? std::max(kStaleFrame_s, kStaleFrames / frame_rate_hz)  // no NaN: above 0
                             : kStaleFrame_s;
  }
  double stale_s = kStaleFrame_s;

  void append(const LiveTick& tick, double haptic_rate_hz);
  std::int64_t end_tick() const { return last_number_ + 1; }  // the number of the last tick plus 1

 private:
  std::int64_t last_number_ = -1, taken_at_ = 0;
  int last_taken_ = -1;
};

// Counts of the other parts of a live run.
struct LiveCounts {
  CameraCounts camera;
  int stalls = 0;
  std::int64_t rows_lost = 0;
};

// Collects the rows of the servo in the log. If a session is recorded, it also writes the rows and the frames
// of the camera to disk.
class LiveLogger {
 public:
  // recorder: null if nothing is recorded. on_tick: receives every row; must not throw; may be empty.
  // stale_after_s: see LiveLog.
  LiveLogger(Ring<LiveTick>& rows, double haptic_rate_hz, std::unique_ptr<SessionRecorder> recorder,
             std::function<void(const LiveTick&)> on_tick = {},
             double stale_after_s = LiveLog::kStaleFrame_s);

  // Processes all rows and frames that have arrived, and calls the function given to ask(). Call it about
  // every kPeriod_s.
  void step() noexcept;
  static constexpr double kPeriod_s = 0.005;
  // Makes everything that was written until now survive a power cut. Call it about every kSyncPeriod_s, from
  // a thread of its own, because a disk may need seconds.
  void sync() noexcept;
  static constexpr double kSyncPeriod_s = 1;
  // Processes all that is left and finishes the file. closing: receives the whole log, and returns the
  // attributes of the file that are known only at the end. It is not called if the log failed. pre: the servo
  // and the camera have stopped, and step() and sync() are no longer called.
  void finish(const std::function<TextAttributes(const LiveLog&)>& closing = {});

  // Writes all that is left of the recording. Call it instead of finish() if an exception ends the run.
  // Returns a line on the file that keeps the recording; empty if nothing was recorded. pre: as for finish().
  std::string keep();

  // Queues a frame of the camera. Returns false if kMaxFrames frames are waiting for the disk.
  bool record(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off);
  // Returns the reason why the recording or the log has failed, and the file that keeps what was recorded;
  // empty if neither has failed. Other threads may call it.
  std::string failure() const;
  LiveLog take() { return std::move(log_); }  // pre: finish() was called
  // Calls the question once, in the next step(), with the log at that time. A question that waits is
  // replaced.
  void ask(std::function<void(const LiveLog&)> question);

 private:
  static constexpr std::size_t kMaxFrames = 90;
  struct Recorded {
    SensorFrame frame;
    double captured_s;
    std::uint64_t fixtures_off;
  };
  void take_all();
  void take_rows();
  void take_frames();
  template <class Write>
  void record(const Write& write);
  void append_to_log(const LiveTick& row);
  void answer();
  void fail(const std::string& why);

  Ring<LiveTick>& rows_;
  const double haptic_rate_hz_;
  const std::unique_ptr<SessionRecorder> recorder_;
  const std::function<void(const LiveTick&)> on_tick_;
  LiveLog log_;
  bool log_failed_ = false, recording_failed_ = false;
  std::mutex question_mutex_;
  std::function<void(const LiveLog&)> question_;
  std::mutex frames_mutex_;
  std::deque<Recorded> frames_;
  std::atomic<bool> failed_ = false, sync_failed_ = false;
  std::string why_, second_failure_;  // the first failure, and the one after it
  std::string why_no_sync_;
};

// The report of a live run: its inputs, its timing as a table and a figure, and notes; and the lateness of
// ticks on this machine.

// Returns the recordings, sessions and meshes that run_live() opens with this device and this sensor, for the
// hashes in its results:
// - the files of --depth and of --device replay:;
// - the recording of the scenario, if the scenario is the sensor (sim:), or if a hand is simulated (sim:,
//   browser:, replay:), because its motion is planned in the scenario. has_view: the page of --view shows
//   where that motion begins, so the recording is read too;
// - the file of the trajectory, if the device is sim: or browser:, or there is a page;
// - the files of all other sections of the experiment.
// Throws InputError for an address without a known scheme.
std::vector<InputPart> live_inputs(const Experiment& experiment, const std::string& device,
                                   const std::string& depth, bool has_view);

// Returns the phases of a live session: those of Experiment::phases(); those of the scene if the sensor is
// simulated (depth "sim:..."); and those of the hand and the operator if the device is simulated (device
// "sim:...").
std::vector<Phase> simulated_phases(const Experiment& experiment, const std::string& device,
                                    const std::string& depth, const Kernels& kernels);

struct LiveFacts {
  std::string depth;  // the address of the sensor, such as "sim:"
  const SensorView& view;
  const SensedPoints& sensed;  // the frames that were sent to the renderer
  const CameraCounts& camera;
  const LiveLog& log;
  double haptic_rate_hz = 0;
  const std::vector<Phase>& phases;  // see simulated_phases()
};

// Returns one input line, on the frames, and these notes: no frame; no contact; frames unused, if more than a
// tenth of all frames were not used; phase not reached.
RunReport report_of(const LiveFacts& facts);

// Timing of a live run: a text table and a figure.
struct LiveReport {
  struct Times {
    const char* name;
    const char* key;             // file-safe
    std::vector<double> sorted;  // seconds; only a part of them after a long run, see Samples
    std::size_t count;           // number of all times
    double least, greatest;      // least and greatest of all times
  };
  struct Count {
    const char* name;
    double value;  // NaN if there was nothing to measure
  };
  std::vector<Times> times;
  std::vector<Count> counts;
  // max_interval_s: longest time from tick to tick in each piece of the run; piece_s: start of the piece.
  std::vector<double> piece_s, max_interval_s;
};

LiveReport live_report(const LiveLog& log, const LiveCounts& counts);

// Returns a text table: least time, p50, p99, p99.9 and greatest time in each row, then the counts. A
// number that could not be measured is "none".
std::string text(const LiveReport& report);

// Returns the tables `times` and `counts` with the same numbers, the distributions of the times, and a curve
// of the longest time from tick to tick over the run.
Figure live_figure(const LiveReport& report);

// Returns the value at this fraction of the sorted values, by the nearest index; NaN if there are no values.
double quantile(const std::vector<double>& sorted, double fraction);

// Measures the lateness of the ticks of a haptic loop on this machine; the ticks themselves do nothing.
struct Jitter {
  std::vector<double> late_s;  // delay of every tick
  long long missed = 0;        // ticks that never began
  std::string real_time;       // rights that the system granted, see become_real_time()
};

// Measures the loop that is used for devices without a loop of their own. stop: may end it early; may be
// null.
Jitter measure_jitter(double duration_s, double rate_hz, const std::atomic<bool>* stop, Clock& clock);

// Returns rows of "from to count bar". Each row ends at twice the time of the row before; empty rows are
// omitted.
std::string histogram(const std::vector<double>& late_s);

}  // namespace remote_touch
