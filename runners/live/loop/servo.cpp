#include "runners/live/loop/servo.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include "core/parameters/parameter.h"

namespace remote_touch {

LiveControls::LiveControls(const Experiment& experiment, const Kernels& kernels, Camera camera)
    : kernels_(kernels),
      configuration_(experiment.to_json()),
      max_stiffness_N_per_m_(experiment.max_stiffness_N_per_m()) {
  std::vector<LiveParameter> live = experiment.live_parameters();
  if (!experiment.changes().empty()) live.clear();
  for (LiveParameter& parameter : live) {
    if (parameter.of == LiveParameter::Of::renderer) ++of_renderer_;
    if (parameter.of == LiveParameter::Of::scenario && camera == Camera::other) continue;
    values_.push_back(parameter.value);
    parameters_.push_back(std::move(parameter));
  }
  if (camera == Camera::simulated)
    shown_ = std::make_shared<ShownScenario>(experiment.build_scenario(kernels));
}

bool LiveControls::has_changed() const {
  return !std::equal(values_.begin(), values_.end(), parameters_.begin(),
                     [](double value, const LiveParameter& parameter) { return value == parameter.value; });
}

std::string LiveControls::change(const ParameterChanges& changes) try {
  std::vector<double> values = values_;
  for (const ParameterChange& change : changes.all()) {
    if (change.parameter < 0 || static_cast<std::size_t>(change.parameter) >= parameters_.size())
      return "there is no live parameter " + std::to_string(change.parameter);
    values[static_cast<std::size_t>(change.parameter)] = change.value;
  }
  ParameterChanges* const slot = requested_.next_slot();
  if (slot == nullptr) return "the haptic loop has not yet applied the earlier changes";
  const Experiment changed = checked(values);
  if (has_stiffness_limit_ && changed.max_stiffness_N_per_m() > max_stiffness_N_per_m_)
    return "this device allows no greater stiffness than at the start of the run";
  if (shown_ && is_of_scenario(changes)) shown_->replace(changed.build_scenario(kernels_));
  *slot = changes;
  requested_.push();
  values_ = std::move(values);
  return {};
} catch (const InputError& error) {
  return error.what();
}

// Returns the whole experiment with all changes so far, checked. Throws InputError.
Experiment LiveControls::checked(const std::vector<double>& values) const {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (values[i] == parameters_[i].value) continue;
    char number[40] = {};
    std::to_chars(number, number + sizeof number - 1, values[i]);  // the shortest text of this number
    const bool is_off_or_on = parameters_[i].is_switch && (values[i] == 0 || values[i] == 1);
    settings.push_back(parameters_[i].name + "=" +
                       (is_off_or_on ? (values[i] == 1 ? "true" : "false") : number));
  }
  return Experiment::from_json(configuration_, "the changed experiment", settings);
}

bool LiveControls::is_of_scenario(const ParameterChanges& changes) const {
  const auto all = changes.all();
  return std::any_of(all.begin(), all.end(), [this](const ParameterChange& change) {
    return static_cast<std::size_t>(change.parameter) >= of_renderer_;
  });
}

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

bool is_released(const DeviceFault& fault) {
  return fault && std::string_view(fault.what) == kReleased.what;
}

}  // namespace

Servo::Servo(const ServoLinks& links, const DevicePlacement& placement, const SafetyLimits& limits,
             double rate_hz, std::int64_t start_ns, double stall_s)
    : links_(links),
      placement_(placement),
      rate_hz_(rate_hz),
      live_(links.renderer.live_parameters()),
      scripted_(links.scripted ? *links.scripted : std::vector<RendererChange>(), links.renderer),
      start_ns_(start_ns),
      gate_(limits),
      heartbeat_(links.device, stall_s) {}

std::int64_t Servo::next_number(std::int64_t now_ns) {
  const auto since_ns = static_cast<double>(now_ns - start_ns_);
  const auto by_clock = static_cast<std::int64_t>(std::ceil(since_ns * rate_hz_ / 1e9));
  return last_number_ = std::max<std::int64_t>(last_number_ + 1, by_clock);
}

// A frame belongs to the first tick at or after its time, as in a simulated run.
void Servo::move_on_to(double time_s, LiveTick& row) {
  auto number = static_cast<std::int64_t>(std::ceil(time_s * rate_hz_));
  while (static_cast<double>(number) / rate_hz_ < time_s) ++number;  // the quotient is rounded
  row.number = last_number_ = std::max(row.number, number);          // no NaN: integers
}

// Changes are made before a frame of the same tick, as in a simulated run. Changes that cannot be recorded
// wait for the next tick.
void Servo::make_changes(LiveTick& row) {
  scripted_.make_until(static_cast<double>(row.number) / rate_hz_);
  row.changed.count = 0;
  const ParameterChanges* const requested = links_.requested ? links_.requested->oldest() : nullptr;
  if (requested == nullptr || links_.rows.next_slot() == nullptr) return;
  row.changed = *requested;
  links_.requested->pop();
  for (const ParameterChange& change : row.changed.all())
    if (static_cast<std::size_t>(change.parameter) < live_.size())
      set_number(live_[static_cast<std::size_t>(change.parameter)], change.value);
  links_.renderer.parameters_changed();
}

// The slot belongs to the servo until the next take(), so the time of arrival can be written into it.
void Servo::take_frame(LiveTick& row) {
  row.taken = -1;
  if (!links_.frames.take()) return make_changes(row);
  LiveFrame& taken = links_.frames.front();
  row.waited_s = static_cast<float>(links_.clock.now_s() - taken.ready_s);
  move_on_to(taken.frame.captured_s, row);
  make_changes(row);
  taken.frame.arrives_s = static_cast<double>(row.number) / rate_hz_;
  links_.renderer.on_frame(taken.frame);
  row.taken = taken.frame.index;
  taken_s_ = links_.clock.now_s();
  ++frames_taken_;
  row.hash = taken.hash;
}

void Servo::note(const DeviceFault& fault, bool of_device) noexcept {
  if (!fault) return;
  trouble_.store(fault.what, std::memory_order_release);
  if (of_device) failed_.store(true, std::memory_order_release);
}

bool Servo::is_over() const noexcept {
  return links_.stop.load(std::memory_order_relaxed) ||
         (links_.signal && links_.signal->load(std::memory_order_relaxed)) ||
         links_.clock.now_ns() >= links_.ends_ns;
}

bool Servo::tick() noexcept try {
  if (!is_over()) {
    one_tick();
    return true;
  }
  heartbeat_.rest();
  links_.device.release();
  return false;
} catch (const std::bad_alloc&) {  // a frame that was not prepared
  return end_for({kNoMemory});
} catch (const std::exception& error) {  // a renderer breaks its contract, or a plug-in reports a problem
  return end_for({text_of(error.what())});
} catch (...) {
  return end_for({"an exception in the haptic loop"});
}

// Keeps the text of the exception without an allocation: what does not fit into the buffer is cut off. The
// first text stays, because other threads may be reading it.
const char* Servo::text_of(const char* reason) noexcept {
  if (exception_text_[0] == '\0')
    std::snprintf(exception_text_.data(), exception_text_.size(), "an exception in the haptic loop: %s",
                  reason);
  return exception_text_.data();
}

bool Servo::end_for(const DeviceFault& trouble) noexcept {
  heartbeat_.rest();
  links_.device.release();
  note(trouble, true);
  return false;
}

// A device that was released stays where it was read last, because the next beat reports the release.
DeviceFault Servo::read(DeviceReading& reading) noexcept {
  const DeviceFault fault = links_.device.read(reading);
  if (!fault) last_reading_ = reading;
  if (!is_released(fault)) return fault;
  reading = last_reading_.value_or(DeviceReading{});
  return {};
}

void Servo::one_tick() {
  const std::int64_t begin_ns = links_.clock.now_ns();
  if (!heartbeat_.beat(begin_ns)) {
    gate_.restart();
    if (has_failed() || !links_.device.rearm())
      note({"the haptic loop hung, and the device was released"}, true);
  }
  row_.since_last_tick_s =
      last_number_ < 0 ? 0 : static_cast<float>(1e-9 * static_cast<double>(begin_ns - last_tick_ns_));
  last_tick_ns_ = begin_ns;
  row_.number = next_number(begin_ns);

  DeviceReading reading;
  const DeviceFault fault = read(reading);
  row_.device = placement_.in_world(reading);
  // The renderer stops and sets its force to zero.
  if (fault || !last_reading_) row_.device.position_W.setConstant(kNoNumber);

  const double read_s = links_.clock.now_s();
  take_frame(row_);
  const double time_s = static_cast<double>(row_.number) / rate_hz_;
  row_.out = links_.renderer.step(row_.device, time_s);
  row_.command =
      links_.remote ? links_.remote->tick(row_.device, row_.out, time_s) : rendered_wrench(row_.out);
  if (links_.remote) {
    row_.out.slave_W = links_.remote->command(row_.device, row_.out);  // the trace shows what is sent
    row_.slave = links_.remote->state(), row_.slave->frame_packets = frames_taken_;
  }
  if (SlavePlace* const place = links_.places ? links_.places->next_slot() : nullptr) {
    *place = {time_s, row_.slave->position_W};
    links_.places->push();
  }
  const double command_time_s = links_.clock.now_s();
  row_.step_s = static_cast<float>(command_time_s - read_s);

  // A dead-band of frames, which needs the places of the slave, sends none while nothing moves.
  const double frame_age_s = links_.places ? 0 : command_time_s - taken_s_.value_or(command_time_s);
  row_.written = gate_.pass(command_time_s, reading, fault, placement_.to_device(row_.command),
                            1e-9 * static_cast<double>(begin_ns), frame_age_s);
  const DeviceFault refused = links_.device.write(row_.written);
  if (refused) {
    row_.written = {};
    if (!is_released(refused)) gate_.latch(refused);
    links_.device.release();
  }
  row_.gate = gate_.state(), row_.is_limited = gate_.is_limiting();
  note(fault, true);
  if (!is_released(refused)) note(refused, true);
  if (row_.gate == GateState::latched) note(gate_.reason(), false);
  latched_.store(row_.gate == GateState::latched, std::memory_order_release);
  if (row_.taken >= 0)
    row_.latency_s = static_cast<float>(links_.clock.now_s() - links_.frames.front().sensed_s);
  if (LiveTick* const slot = links_.rows.next_slot()) {
    *slot = row_;
    links_.rows.push();
  } else {
    rows_lost_.fetch_add(1, std::memory_order_relaxed);
  }
}

namespace {

// Memory for the reason of the end, reserved at the start: the reason may be that there is no more memory.
constexpr std::size_t kReservedForReason = 256;

}  // namespace

CameraFeed::CameraFeed(std::unique_ptr<DepthSource> source, FrameProcessing processing,
                       const Renderer& renderer, const RigidTransform& registration, const Clock& clock,
                       std::int64_t start_ns, TripleBuffer<LiveFrame>& out, FrameSink sink,
                       std::function<void(const Frame&)> on_frame, FrameChoice sends)
    : source_(std::move(source)),
      processing_(std::move(processing)),
      renderer_(renderer),
      X_WC_(registration * source_->view().X_WC),
      clock_(clock),
      start_s_(1e-9 * static_cast<double>(start_ns)),
      out_(out),
      sink_(std::move(sink)),
      on_frame_(std::move(on_frame)),
      sends_(std::move(sends)),
      newest_s_(start_s_) {
  why_.reserve(kReservedForReason);
}

std::string CameraFeed::ended() const {
  return ended_.load(std::memory_order_acquire) ? why_ : std::string();
}

// A reason that needs more memory than there is is cut off: an exception would end the program before the
// loop has released the device.
bool CameraFeed::end(std::string_view why) noexcept {
  try {
    why_ = why;
  } catch (const std::bad_alloc&) {
    why_ = why.substr(0, why_.capacity());
  }
  ended_.store(true, std::memory_order_release);
  return false;
}

CameraCounts CameraFeed::counts() const {
  const std::lock_guard lock(reported_mutex_);
  return reported_;
}

bool CameraFeed::step(double patience_s) noexcept try {
  if (ended_) return false;
  switch (source_->next(sensed_, patience_s)) {
    case SensorState::frame: {
      handle(sensed_);
      const std::lock_guard lock(reported_mutex_);
      reported_ = counts_;
      return true;
    }
    case SensorState::waiting:
      return true;
    case SensorState::ended:
      return end(kEnd);
    case SensorState::failed:
      return end(source_->failure());
  }
  return true;
} catch (const InputError& error) {
  end(error.what());
  refused_.store(true, std::memory_order_release);
  return false;
} catch (const std::bad_alloc&) {
  return end(kNoMemory);
} catch (const std::exception& error) {
  return end(error.what());
} catch (...) {
  return end("an unknown error");
}

bool CameraFeed::is_newer(const SensorFrame& sensed) {
  const bool newer =
      counts_.received == 1 || (sensed.number > last_number_ && sensed.captured_s > last_captured_s_);
  if (!newer) return false;
  if (counts_.received > 1) {
    counts_.skipped += sensed.number - last_number_ - 1;
    counts_.max_pause_s = std::max(counts_.max_pause_s, sensed.captured_s - last_captured_s_);  // no NaN
  }
  last_number_ = sensed.number, last_captured_s_ = sensed.captured_s;
  return true;
}

void CameraFeed::handle(SensorFrame& sensed) {
  ++counts_.received;
  if (!is_newer(sensed)) {
    ++counts_.reversed;
    return;
  }
  if (!is_complete(sensed, source_->view())) {
    ++counts_.incomplete;
    return;
  }
  const double begin_s = clock_.now_s();
  Frame frame;
  frame.index = index_;
  frame.captured_s = sensed.captured_s - start_s_;
  const std::uint64_t off = processing_.fixtures.off();
  if (sink_ && !sink_(sensed, frame, off)) {
    ++counts_.unrecorded;
    return;
  }
  ++index_;
  processing_.fill(frame, sensed, source_->view(), X_WC_, off);
  processing_.needs.check(frame);
  if (sends_ && !sends_(frame)) {
    ++counts_.held_back;
    newest_s_.store(clock_.now_s(), std::memory_order_relaxed);
  } else {
    renderer_.prepare(frame);
    send(std::move(frame), sensed.captured_s);
  }
  counts_.processing_s += clock_.now_s() - begin_s;
  sensed_points_.add(sensed, source_->view());  // done after the frame was sent, so as not to delay it
}

void CameraFeed::send(Frame frame, double sensed_s) {
  std::erase_if(held_, [](const Frame& old) {
    return old.points.use_count() == 1 && (!old.prepared || old.prepared.use_count() == 1);
  });
  held_.push_back(frame);
  if (on_frame_) on_frame_(frame);
  const std::uint64_t hash = frame_hash(*frame.points->stored_cloud(), frame.captured_s);
  const double ready_s = clock_.now_s();
  out_.back() = {std::move(frame), sensed_s, ready_s, hash};
  if (!out_.publish()) ++counts_.overtaken;
  newest_s_.store(ready_s, std::memory_order_relaxed);
  has_sent_.store(true, std::memory_order_release);
}

}  // namespace remote_touch
