#include "runners/experiment/simulation/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>

#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/hand/teleoperation.h"
#include "runners/experiment/simulation/run_notes.h"

namespace remote_touch {
namespace {

std::string seconds(double time_s) {
  return formatted("%.6g s", time_s);
}

// Adds a note for each phase of the hand, such as a press, that begins only after the motion of the scene has
// ended.
void add_late_phases(const std::vector<Phase>& of_scene, const std::vector<Phase>& of_hand, double end_s,
                     std::vector<Note>& notes) {
  if (of_scene.empty()) return;
  const Phase& last = of_scene.back();
  for (const Phase& phase : of_hand)
    if (phase.begins_s >= last.ends_s && phase.begins_s < end_s)
      notes.push_back({"after the motion", phase.name + " begins at " + seconds(phase.begins_s) + ", after " +
                                               last.name + " has ended at " + seconds(last.ends_s)});
}

// Returns the number of frames that the renderer used in a part of the run.
int frames_between(const Trace& trace, double begins_s, double ends_s) {
  int frames = 0, newest = -1;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const bool is_inside = trace.time_s[i] > begins_s - kSameTime_s && trace.time_s[i] < ends_s + kSameTime_s;
    if (!is_inside || trace.frame_index[i] == newest) continue;
    newest = trace.frame_index[i];
    ++frames;
  }
  return frames;
}

// Adds a note if the renderer used only one or two frames while the scene moved. A motion that lasts less
// than 0.2 s in this run gets no note, because few frames of an ordinary rate are in it.
void add_few_frames(const std::vector<Phase>& of_scene, const Trace& trace, double end_s,
                    std::vector<Note>& notes) {
  constexpr double kBriefMotion_s = 0.2;
  constexpr int kEnoughFrames = 3;
  if (of_scene.empty()) return;
  double begins_s = end_s, ends_s = 0;
  for (const Phase& phase : of_scene) {
    begins_s = std::min(begins_s, std::max(0.0, phase.begins_s));  // no NaN: settings
    ends_s = std::max(ends_s, std::min(end_s, phase.ends_s));      // no NaN
  }
  const int frames = frames_between(trace, begins_s, ends_s);
  if (frames == 0 || frames >= kEnoughFrames || ends_s - begins_s < kBriefMotion_s) return;
  notes.push_back({"few frames", std::to_string(frames) + (frames == 1 ? " frame" : " frames") + " in the " +
                                     seconds(ends_s - begins_s) + " in which the scene moves: its motion " +
                                     (frames == 1 ? "after this frame" : "between and after them") +
                                     " is not seen"});
}

void add_contact(const Trace& trace, std::vector<Note>& notes) {
  const auto is_none = [](int count) { return count == 0; };
  const auto is_zero = [](const Vec3& force) { return force.norm() == 0; };
  if (std::ranges::all_of(trace.frame_index, [](int frame) { return frame < 0; }))
    notes.push_back({"no frame", "no frame arrived before the run ended"});
  else if (std::ranges::all_of(trace.contact_count, is_none) && std::ranges::all_of(trace.force_N, is_zero))
    notes.push_back(no_contact_note());
}

// Adds a note if the renderer's force or torque is not a finite number in some tick.
void add_unknown_forces(const Trace& trace, std::vector<Note>& notes) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.force_N[i].allFinite() && (!trace.has_tool() || trace.torque_Nm[i].allFinite())) continue;
    if (count++ == 0) first = i;
  }
  if (count == 0) return;
  notes.push_back({"force not finite", "the renderer's force is not a finite number in " +
                                           std::to_string(count) + " of " + std::to_string(trace.length()) +
                                           " ticks, first at " + seconds(trace.time_s[first]) +
                                           ": it counts as no force there"});
}

constexpr std::size_t kMainMeasures = 5;

enum class When { always, fixtures, no_fixtures };

// The first five that apply to the run and have a value are printed. So a run without a known truth or
// without a tool has the next ones instead.
struct Priority {
  const char* measure;
  When when;
  const char* unless = "";  // another measure, with which this one is left out
};
constexpr Priority kPriorities[] = {
    // Did the slave touch, how hard, and what did the hand feel of it?
    {"max_slave_force", When::always},
    {"min_slave_clearance", When::always},
    {"max_device_force", When::always},
    // A region is violated if the slave comes too near to the surface behind it.
    {"min_slave_distance", When::fixtures},
    // Guidance has to lead the hand to its goal.
    {"guidance_error", When::always},
    {"guidance_error_angle", When::always},
    // The first question about a method: does its proxy stay on the right side of the surface? Where a camera
    // measured the surface, the second is on which side of the true one that is.
    {"popped_through", When::no_fixtures},
    {"popped_through_truth", When::no_fixtures},
    {"first_pop_through_time", When::no_fixtures},  // has no value unless it happened
    {"tool_popped_through", When::no_fixtures},
    // How far was it wrong? The depth of points in a tool needs no truth.
    {"max_penetration", When::no_fixtures, "popped_through_truth"},
    {"max_tool_penetration", When::always},
    // How well does the hand feel the shape?
    {"rms_contact_error", When::no_fixtures},
    // The error has two parts, of the camera and of the renderer.
    {"rms_camera_error", When::no_fixtures},
    {"rms_renderer_error", When::no_fixtures},
    // How much does the device have to exert, and how large is the jolt when a frame arrives?
    {"max_force", When::always},
    {"max_force_jump", When::always},
    {"max_torque", When::always},
    // Was there a contact, and did the steps of a tick suffice?
    {"force_fraction", When::always},
    {"unconverged_fraction", When::always},
    {"exhausted_fraction", When::always},
    {"mean_steps", When::always},
};

bool is_wanted(When when, Fixtures fixtures) {
  return when == When::always || (when == When::fixtures) == (fixtures == Fixtures::some);
}

bool is_built_in(const std::string& name) {
  return std::ranges::any_of(built_in_measures(), [&](const Measure& each) { return each.name == name; });
}

struct UnitName {
  const char *unit, *words;
};
constexpr UnitName kUnitNames[] = {
    {"1", ""},
    {"m", "metres"},
    {"s", "seconds"},
    {"N", "newtons"},
    {"J", "joules"},
    {"rad", "radians"},
    {"N m", "newton metres"},
    {"1/s", "per second"},
    {"N/m", "newtons per metre"},
};

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

Note no_contact_note() {
  return {"no contact", "no point was touched, and no force was felt"};
}

void add_missed_phases(const std::vector<Phase>& phases, double end_s, std::vector<Note>& notes) {
  std::set<std::string> missed;
  for (const Phase& phase : phases)
    if (phase.begins_s >= end_s && missed.insert(phase.name).second)
      notes.push_back({"phase not reached", "the run ends at " + seconds(end_s) + ", before " + phase.name +
                                                " begins at " + seconds(phase.begins_s)});
}

std::string text_of(const RunReport& report) {
  std::string text;
  for (const std::string& line : report.inputs) text += "  read " + printable(line) + "\n";
  if (!report.hand.empty()) text += "  hand: " + printable(report.hand) + "\n";
  for (const Note& note : report.notes)
    text += "  note (" + printable(note.kind) + "): " + printable(note.text) + "\n";
  return text;
}

RunReport report_of(const Scenario& scenario, const Trajectory& trajectory, const Trace& trace,
                    double end_s) {
  RunReport report;
  if (std::string input = scenario.input(); !input.empty()) report.inputs.push_back(std::move(input));
  report.hand = trajectory.aim();
  report.notes = scenario.input_notes();
  for (Note& note : trajectory.notes()) report.notes.push_back(std::move(note));
  const std::vector<Phase> of_scene = scenario.phases(), of_hand = trajectory.phases();
  add_missed_phases(of_scene, end_s, report.notes);
  add_missed_phases(of_hand, end_s, report.notes);
  // The time of a tick is computed from its number, and the end of a motion is a sum of times. Both are
  // rounded, so times that are nearly equal count as equal.
  if (trajectory.duration_s() > end_s + kSameTime_s)
    report.notes.push_back({"phase not reached", "the run ends at " + seconds(end_s) +
                                                     ", before the trajectory ends at " +
                                                     seconds(trajectory.duration_s())});
  add_late_phases(of_scene, of_hand, end_s, report.notes);
  add_few_frames(of_scene, trace, end_s, report.notes);
  add_contact(trace, report.notes);
  add_unknown_forces(trace, report.notes);
  return report;
}

void add_report(TextAttributes& attributes, const RunReport& report) {
  std::string read, notes;
  for (const std::string& line : report.inputs) read += (read.empty() ? "" : "\n") + line;
  for (const Note& note : report.notes) notes += (notes.empty() ? "" : "\n") + note.text;
  if (!read.empty()) attributes.emplace_back("frames_read", read);
  if (!report.hand.empty()) attributes.emplace_back("hand", report.hand);
  if (!notes.empty()) attributes.emplace_back("notes", notes);
}

void refuse_notes(const RunReport& report) {
  std::string all;
  for (const Note& note : report.notes) all += (all.empty() ? "" : "; ") + note.kind + ": " + note.text;
  if (!all.empty()) throw InputError("--strict", all);
}

std::vector<MeasuredValue> measured_values(std::span<const Measure> list, const Trace& trace) {
  std::vector<MeasuredValue> values;
  for (const Measure& measure : list)
    if (applies(measure, trace)) values.push_back({&measure, measure.compute(trace)});
  return values;
}

std::vector<MeasuredValue> main_measures(const std::vector<MeasuredValue>& all, Fixtures fixtures) {
  std::vector<MeasuredValue> chosen;
  const auto find = [&](const std::string& name) {
    return std::ranges::find_if(all, [&](const MeasuredValue& each) { return each.measure->name == name; });
  };
  for (const Priority& priority : kPriorities) {
    const auto found = find(priority.measure);
    if (found == all.end() || std::isnan(found->value) || !is_wanted(priority.when, fixtures)) continue;
    if (find(priority.unless) != all.end()) continue;
    chosen.push_back(*found);
    if (chosen.size() == kMainMeasures) break;
  }
  for (const MeasuredValue& each : all)
    if (!is_built_in(each.measure->name)) chosen.push_back(each);
  return chosen;
}

std::string unit_in_words(const std::string& unit) {
  for (const UnitName& name : kUnitNames)
    if (unit == name.unit) return name.words;
  return unit;
}

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
