#include "runners/experiment/simulation/simulation.h"

#include <chrono>
#include <cmath>
#include <limits>

#include "analysis/trace/trace.h"
#include "core/kernels/isa.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/hand/teleoperation.h"
#include "runners/experiment/simulation/contact_watch.h"
#include "runners/experiment/simulation/run_notes.h"

namespace remote_touch {

namespace {

std::size_t tick_count(const Experiment& experiment, const Trajectory& trajectory) {
  const RunSettings& settings = experiment.settings();
  const double duration = settings.duration_s > 0 ? settings.duration_s : trajectory.duration_s();
  if (!(duration > 0))
    throw InputError("duration_s = 0", "the trajectory has no end: expected a duration above 0");
  // An excess of a millionth of a tick is a rounding error and not one more tick.
  const double ticks = std::ceil(duration * settings.haptic_rate_hz - 1e-6);
  if (!(ticks >= 1))
    throw InputError("duration_s = " + std::to_string(duration),
                     "shorter than a tick: expected 1 tick or more");
  return static_cast<std::size_t>(ticks);
}

Trace::Truth truth(const Scenario& scenario, const RenderOutput& out, double time_s, std::uint64_t frame_hash,
                   WallWatch& proxy_walls) {
  const double proxy_distance_m =
      proxy_walls.side_m(out.proxy_W, scenario.signed_distance(out.proxy_W, time_s), time_s);
  double slave_distance_m = proxy_distance_m;
  if (!out.slave_W.allFinite())
    slave_distance_m = std::numeric_limits<double>::quiet_NaN();
  else if (out.slave_W != out.proxy_W)
    slave_distance_m = scenario.signed_distance(out.slave_W, time_s);
  Trace::Truth truth{proxy_distance_m, slave_distance_m, frame_hash};
  truth.measured_distance_m = scenario.measured_distance(out.proxy_W, time_s);
  return truth;
}

// Returns the height of the contact point above the measured surface. x_W: position of the renderer, see
// RenderedContact. The contact point is below x along the true normal. The measured surface is that of the
// pixel which shows the contact point: x may hide another part of the object.
double measured_height_m(const Scenario& scenario, const Vec3& x_W, double rest_distance_m, double time_s) {
  const Vec3 foot_W =
      rest_distance_m == 0 ? x_W : Vec3(x_W - rest_distance_m * scenario.true_normal(x_W, time_s));
  return scenario.measured_distance(foot_W, time_s).value_or(std::numeric_limits<double>::quiet_NaN());
}

// Returns the force of the tick without the part of guidance, which may pull in any direction.
Vec3 contact_force_N(const RenderOutput& out) {
  return out.guidance ? Vec3(out.force_N - out.guidance->force_N) : out.force_N;
}

// See RenderedContact.
Trace::TrueContact true_contact(const Scenario& scenario, const RenderedContact& contact, const Vec3& hip_W,
                                const RenderOutput& out, const Trace::Truth& known, double time_s,
                                WallWatch& hand_walls) {
  const double hip_distance_m = hand_walls.side_m(hip_W, scenario.signed_distance(hip_W, time_s), time_s);
  const bool has_proxy = !(contact.spring_N_per_m > 0);
  const Vec3 x_W = has_proxy ? out.proxy_W : Vec3(hip_W + contact_force_N(out) / contact.spring_N_per_m);
  const double distance_m = has_proxy ? known.proxy_distance_m : scenario.signed_distance(x_W, time_s);
  return {distance_m - contact.rest_distance_m, hip_distance_m,
          known.measured_distance_m ? measured_height_m(scenario, x_W, contact.rest_distance_m, time_s)
                                    : std::numeric_limits<double>::quiet_NaN()};
}

// Returns the true normal where the renderer touches, below the proxy; NaN without a contact. A tool touches
// with an area, so its normal is known only on a plane.
Vec3 true_normal(const Scenario& scenario, const RenderOutput& out, double time_s) {
  const Vec3 unknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  if (out.state == ContactState::free || contact_force_N(out).isZero(0)) return unknown;
  return out.tool ? scenario.plane_normal(time_s).value_or(unknown)
                  : scenario.true_normal(out.proxy_W, time_s);
}

class StopWatch {
 public:
  double lap_s() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> lap = now - start_;
    start_ = now;
    return lap.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Passes each frame to a renderer and measures how long the renderer needs for it. Calls
// SimulationOptions::on_frame before, and keeps the points of the first and of the newest frame.
class ObservedFrames final : public FrameReceiver {
 public:
  ObservedFrames(Renderer& renderer, const SimulationOptions& options)
      : renderer_(renderer), duration_s_(options.frame_duration_s), observe_(options.on_frame) {}
  void on_frame(const Frame& frame) override {
    if (observe_) observe_(frame);
    if (!first_points_) first_points_ = frame.points;
    if (!points_ || frame.captured_s > captured_s_) points_ = frame.points, captured_s_ = frame.captured_s;
    StopWatch watch;
    renderer_.on_frame(frame);
    if (duration_s_) duration_s_->push_back(watch.lap_s());
  }
  // Null before the first frame.
  const ContactWatch::Points& first_points() const { return first_points_; }
  const ContactWatch::Points& newest_points() const { return points_; }

 private:
  Renderer& renderer_;
  ContactWatch::Points first_points_, points_;
  double captured_s_ = 0;
  std::vector<double>* duration_s_;
  const std::function<void(const Frame&)>& observe_;
};

void add(std::vector<Note> more, std::vector<Note>& notes) {
  for (Note& note : more) notes.push_back(std::move(note));
}

// Returns the notes on the contacts of a run without a tool. A tool touches with an area and not at a
// position.
std::vector<Note> contact_notes(const ContactWatch& watch, const Scenario& scenario,
                                const RenderedContact& contact, bool has_fixtures, const Kernels& kernels) {
  std::vector<Note> notes;
  if (contact.rest_distance_m >= 0) add(watch.start_notes(scenario, contact.rest_distance_m, kernels), notes);
  if (!(contact.ball_radius_m > 0) || has_fixtures) return notes;  // regions are larger than the ball
  add(watch.spacing_notes(contact.ball_radius_m, kernels), notes);
  add(watch.first_touch_notes(scenario, contact.ball_radius_m, kernels), notes);
  return notes;
}

}  // namespace

Trace simulate(const Experiment& experiment, const SimulationOptions& options) {
  const Kernels& kernels = options.kernels ? *options.kernels : kernels_for(best_isa());
  const auto scenario = experiment.build_scenario(kernels);
  experiment.check_needs(*scenario);
  const auto trajectory = experiment.build_trajectory(*scenario);
  const auto switches = std::make_shared<FixtureSwitches>();
  const auto renderer = experiment.build_renderer(kernels, switches);
  FrameProcessing processing = experiment.build_processing(kernels, switches);
  const bool has_fixtures = !processing.fixtures.empty();
  FrameStream frames(*scenario, std::move(processing), experiment.settings().transport,
                     experiment.settings().key, options.hash_frames, options.generate_all_points);
  ObservedFrames observed(*renderer, options);
  FrameLink link(experiment.frame_dead_band(), observed, kernels);
  RendererChanges changes(experiment.changes(), *renderer);
  SimulatedHand hand = experiment.build_hand();
  const auto recorded_scene = experiment.build_recorded_scene(kernels);
  std::optional<Teleoperation> remote =
      experiment.build_teleoperation(recorded_scene ? recorded_scene.get() : scenario.get());
  const std::size_t ticks = tick_count(experiment, *trajectory);
  const RenderedContact contact = experiment.rendered_contact();
  const bool finds_contact = options.find_true_contact && !std::isnan(contact.rest_distance_m);

  SurfaceWatch surface(scenario->without_faults(), *trajectory);
  ContactWatch contacts(held_depth_m(contact));
  WallWatch proxy_walls(*scenario, "the proxy"), hand_walls(*scenario, "the hand");
  Trace trace;
  trace.reserve(ticks);
  trace.held_depth_m = held_depth_m(contact);
  StopWatch watch;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    if (options.stop && *options.stop) throw Interrupted{};
    // The time is computed from the number of the tick and is not a sum, so that rounding errors do not add
    // up.
    const double time_s = static_cast<double>(tick) / experiment.settings().haptic_rate_hz;
    if (trajectory->is_missed(time_s)) continue;
    changes.make_until(time_s);
    frames.deliver_until(time_s, link);
    const DeviceState device = hand.move(trajectory->at(time_s), time_s);
    if (options.step_duration_s) watch.lap_s();
    RenderOutput out = renderer->step(device, time_s);
    if (options.step_duration_s) options.step_duration_s->push_back(watch.lap_s());
    hand.apply(remote ? remote->tick(device, out, time_s) : rendered_wrench(out));
    std::optional<SlaveState> slave;
    if (remote) {
      out.slave_W = remote->command(device, out);  // the trace shows what is sent
      remote->observe_exerted(hand.state()->force_N);
      slave = remote->state();
      slave->frame_packets = link.sent();
      link.observe_slave(slave->position_W, time_s);
    }
    Trace::Truth known = truth(*scenario, out, time_s, frames.newest_hash(), proxy_walls);
    if (finds_contact)
      known.contact = true_contact(*scenario, contact, device.position_W, out, known, time_s, hand_walls);
    if (options.find_true_contact) known.normal = true_normal(*scenario, out, time_s);
    if (hand.follows_script()) known.expected_force_N = trajectory->expected_force_N(time_s);
    trace.append(time_s, device, out, known, hand.state(), slave);
    if (options.report) {
      surface.add(device.position_W, time_s);
      if (!out.tool)
        contacts.add(time_s, device.position_W, out, observed.newest_points(),
                     known.measured_distance_m.value_or(known.proxy_distance_m));
    }
    if (options.progress && tick % (ticks / 100 + 1) == 0)
      options.progress(static_cast<double>(tick) / static_cast<double>(ticks));
  }
  if (options.report) {
    const double end_s = static_cast<double>(ticks) / experiment.settings().haptic_rate_hz;
    *options.report = report_of(*scenario, *trajectory, trace, end_s);
    std::vector<Note>& notes = options.report->notes;
    add_missed_phases(experiment.phases(), end_s, notes);
    add_missed_phases(experiment.operator_phases(), end_s, notes);
    add(fixture_notes(frames.fixtures(), observed.first_points(), observed.newest_points()), notes);
    add(surface.notes(), notes);
    add(proxy_walls.notes(), notes);
    add(hand_walls.notes(), notes);
    add(slave_setting_notes(experiment, Experiment::Hand::simulated), notes);
    add(slave_notes(trace), notes);
    if (trace.has_tool())
      add(tool_start_notes(trace), notes);
    else
      add(contact_notes(contacts, scenario->without_faults(), contact, has_fixtures, kernels), notes);
  }
  return trace;
}

}  // namespace remote_touch
