#include "runners/experiment/simulation/run_notes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/force_measures.h"
#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/number_columns.h"

namespace remote_touch {
namespace {

// Returns the index of a kind; 0 for a name that is not in the list.
std::size_t number_of_kind(const std::string& name) {
  const std::vector<NoteKind>& kinds = note_kinds();
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (name == kinds[i].name) return i;
  return 0;
}

// A hand of 0.5 kg has this energy at 4.5 m/s. Rendered surfaces give a hand at most 1.6 J in the scenes of
// the scorecard.
constexpr double kMuchEnergy_J = 5;

bool is_started(const Trace& trace) {
  return std::any_of(trace.received_command_m.begin(), trace.received_command_m.end(),
                     [](const Vec3& command) { return command.allFinite(); });
}

// Returns true if every command that the slave had is the first one that it was meant to have, and later ones
// were meant for it. Ticks before the first command have NaN. A command that is sent in the last tick cannot
// move the slave any more.
bool kept_first_command(const Trace& trace) {
  const auto first = std::find_if(trace.received_command_m.begin(), trace.received_command_m.end(),
                                  [](const Vec3& command) { return command.allFinite(); });
  const auto is_first = [&](const Vec3& command) { return command == *first; };
  const auto is_other = [&](const Vec3& command) { return command.allFinite() && command != *first; };
  return std::all_of(first, trace.received_command_m.end(), is_first) &&
         std::any_of(trace.slave_command_m.begin(), trace.slave_command_m.end() - 1, is_other);
}

// Only a slave that the hand is to feel sends forces.
bool sends_forces(const Trace& trace) {
  return trace.force_packets.back() > 0;
}

bool feels_nothing(const Trace& trace) {
  const auto is_zero = [](const Vec3& force) { return force.isZero(0); };
  return !std::isnan(first_slave_contact_time_s(trace)) &&
         std::all_of(trace.device_force_N.begin(), trace.device_force_N.end(), is_zero);
}

// The slave is put at its first command in one tick, and pushed out from the next one on.
void add_start(const Trace& trace, std::vector<Note>& notes) {
  constexpr double kRounding_m = 1e-9;
  const auto is_known = [](const Vec3& position) { return position.allFinite(); };
  const auto first = std::ranges::find_if(trace.slave_position_m, is_known);
  const auto tick = static_cast<std::size_t>(first - trace.slave_position_m.begin());
  const double depth_m = -trace.slave_clearance_m[tick];
  if (!(depth_m > kRounding_m)) return;
  const double force_N = tick + 1 < trace.length() ? trace.slave_peak_force_N[tick + 1] : 0;
  notes.push_back(
      {"slave starts in contact",
       formatted("the slave starts %.3g mm behind the true surface, with a force of %.3g N on it: largest "
                 "forces of the run may be those of its start",
                 1e3 * depth_m, force_N)});
}

}  // namespace

const std::vector<NoteKind>& note_kinds() {
  static const std::vector<NoteKind> kinds = {
      {"other", "a note of your own program or plug-in; replay prints its text"},
      {"phase not reached",
       "the run ends before a press, a motion or a change begins, or before the trajectory ends"},
      {"after the motion", "the press begins after the motion of the scene has ended"},
      {"no contact", "no point was touched and no force was felt"},
      {"no frame", "no frame arrived before the run ended"},
      {"wide spacing", "a ball of the contact radius passes between the points"},
      {"points dropped", "many measured points are beyond scenario.max_depth_m"},
      {"frames unused", "not all frames of the recording were used"},
      {"frames apart", "successive frames show different parts of the scene"},
      {"unusual rate", "the stamps of the recording may not be in seconds"},
      {"recording incomplete",
       "a bag was cut short, or its stamps are missing or out of order; a live session was interrupted"},
      {"colours missing", "measured points have no colour"},
      {"viewpoint unused", "seen from its VIEWPOINT, the points of a PCD file form no image"},
      {"behind the surface", "the hand was farther behind what the camera sees than planned"},
      {"off the surface", "the hand was meant to touch but was off what the camera sees"},
      {"holes bridged", "image-scan or image-press treats holes up to bridge_m wide as closed"},
      {"edges bridged", "image-scan treats depth jumps above edge_jump_m as surface"},
      {"object not scanned", "image-scan touches another thing than the nearest object"},
      {"camera changes", "a later CameraInfo or depth unit of a bag differs from the first, which is used"},
      {"starts in contact",
       "when the first frame arrives, the hand is behind the surface or within the contact radius of it"},
      {"lost at the first touch",
       "the surface passed the proxy before a third frame after the first contact"},
      {"object not pressed", "image-press presses another thing than the nearest object"},
      {"hand jumped", "the pixel that image-press follows suddenly showed another place"},
      {"nothing selected", "a fixture rule selects no point, so that it has no effect"},
      {"outcome unknown",
       "popped_through has no value, beside an object for example; fractions of runs leave it out, and their intervals "
       "allow for both outcomes"},
      {"few frames", "fewer than three frames show the motion of the scene"},
      {"columns unused", "a measured contact has columns that are not used"},
      {"slave without surface", "the true surface, or its normal, is not known where the slave was"},
      {"slave without command",
       "the slave received no command, or none after its first, or the hand felt none of its forces"},
      {"slave loop gains energy",
       "the device gave much energy to the hand: hand, links and slave may oscillate"},
      {"setting without effect", "settings of the experiment that cannot act together"},
      {"slave starts in contact",
       "the slave starts behind the true surface, so that its largest forces may be those of its start"},
      {"force not finite", "the renderer's force is not a number in some ticks; it counts as no force there"},
      {"thin object", "the hand or the proxy passed the middle of a wall; it has no side from there on"},
      {"unusual poses",
       "a file of poses, or of a contact, is improbably fast, far or slow, or states a convention that is not read"},
      {"poses do not fit", "the frames of a recording fit each other worse with the poses of the camera"},
      {"truth elsewhere", "a true object of a recording is nowhere near what the camera measured"},
      {"not in view", "an object of a scene of meshes is at no time in the image of the camera"},
      {"camera assumed", "the intrinsics of a recording are assumed, because no file states them"},
      {"equal numbers",
       "frames of a recording have names that differ in leading zeros only; one may be a copy"},
  };
  return kinds;
}

std::vector<std::string> note_kind_names() {
  std::vector<std::string> names;
  for (const NoteKind& kind : note_kinds()) names.emplace_back(kind.name);
  return names;
}

std::uint64_t note_bits(const std::vector<Note>& notes) {
  std::uint64_t bits = 0;
  for (const Note& note : notes) bits |= std::uint64_t{1} << number_of_kind(note.kind);
  return bits;
}

std::string text_of_kind(const std::string& name) {
  const std::size_t number = number_of_kind(name);
  const NoteKind& kind = note_kinds()[number];
  return name == kind.name ? name + ": " + kind.meaning : name;
}

double shown_depth(const PointCloud& cloud, const RigidTransform& X_CW, const Vec3& p_C, double reach_m) {
  constexpr double kMaxReach_px = 32;  // bounds the work for a hand close to the lens
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const CameraIntrinsics& camera = cloud.image->camera;
  if (!(p_C.z() > 0)) return unknown;
  const double column = std::floor(camera.fx * p_C.x() / p_C.z() + camera.cx + 0.5);
  const double row = std::floor(camera.fy * p_C.y() / p_C.z() + camera.cy + 0.5);
  if (!(column >= 0 && row >= 0 && column < camera.width && row < camera.height)) return unknown;
  const int u = static_cast<int>(column), v = static_cast<int>(row);
  const auto reach_px = [&](double focal_px) {
    return static_cast<int>(std::clamp(focal_px * reach_m / p_C.z(), 1.0, kMaxReach_px));
  };
  const int across = reach_px(camera.fx), down = reach_px(camera.fy);
  std::vector<double> depths;
  for (int y = std::max(0, v - down); y <= std::min<int>(camera.height - 1, v + down); ++y)
    for (int x = std::max(0, u - across); x <= std::min<int>(camera.width - 1, u + across); ++x) {
      const int right = (x - u) * down, below = (y - v) * across;
      if (right * right + below * below > across * across * down * down) continue;
      const std::size_t i = static_cast<std::size_t>(y) * camera.width + x;
      if (cloud.is_measured(i)) depths.push_back((X_CW * cloud.point(i)).z());
    }
  return depths.empty() ? unknown : median_in_place(depths);
}

// Returns the newest frame at a time; null if it is not an image.
const PointCloud* SurfaceWatch::image_at(double time_s) {
  const int frame = std::clamp(scenario_.newest_frame(time_s), 0, scenario_.frame_count() - 1);
  if (frame == frame_) return cloud_;
  frame_ = frame;
  points_ = scenario_.points(frame);
  // The search of an image stores the points in the order of the pixels. Any other frame is copied.
  cloud_ = points_->stored_cloud();
  if (!cloud_ || !cloud_->image) cloud_ = &copy_.emplace(scenario_.cloud(frame));
  const auto is_image = [](const PointCloud& cloud) {
    if (!cloud.image) return false;
    const CameraIntrinsics& camera = cloud.image->camera;
    return cloud.size() == camera.pixels();
  };
  if (!is_image(*cloud_)) return cloud_ = nullptr;
  X_CW_ = cloud_->image->X_WC.inverse();
  return cloud_;
}

void SurfaceWatch::add_step(const Vec3& hand_W, double time_s, double max_step_m) {
  const double step_m = last_W_ ? (hand_W - *last_W_).norm() : 0;
  last_W_ = hand_W;
  if (max_step_m <= 0 || !(step_m > max_step_m)) return;
  if (jumps_++ == 0) first_jump_s_ = time_s, first_jump_m_ = step_m;
  longest_jump_m_ = std::max(longest_jump_m_, step_m);  // no NaN: above a limit
}

void SurfaceWatch::add(const Vec3& hand_W, double time_s) {
  const std::optional<SurfacePlan> plan = trajectory_.surface_plan(time_s);
  if (!plan) return;
  add_step(hand_W, time_s, plan->max_step_m);
  const PointCloud* cloud = image_at(time_s);
  if (!cloud) return;
  ++ticks_;
  const Vec3 hand_C = X_CW_ * hand_W;
  const double behind_m = hand_C.z() - shown_depth(*cloud, X_CW_, hand_C, plan->reach_m);
  if (behind_m > plan->max_depth_m) {
    if (behind_++ == 0) first_behind_s_ = time_s;
    if (behind_m > deepest_m_) deepest_m_ = behind_m, allowed_m_ = plan->max_depth_m;
  } else if (plan->touches && !(behind_m >= plan->min_depth_m)) {  // also if behind_m is NaN
    if (off_++ == 0) first_off_s_ = time_s;
  }
}

std::vector<Note> SurfaceWatch::notes() const {
  std::vector<Note> notes;
  const auto percent = [&](std::size_t count) {
    return 100 * static_cast<double>(count) / static_cast<double>(ticks_);
  };
  if (behind_ > 0)
    notes.push_back(
        {"behind the surface",
         formatted("the hand was behind the surface that the camera sees in %.3g %% of the ticks, first at "
                   "%.6g s, by up to %.3g mm; at most %.3g mm were planned",
                   percent(behind_), first_behind_s_, 1e3 * deepest_m_, 1e3 * allowed_m_)});
  if (off_ > 0)
    notes.push_back(
        {"off the surface",
         formatted(
             "the hand was meant to touch but was off the surface that the camera sees in %.3g %% of the "
             "ticks, first at %.6g s: there is a hole or an edge, or the surface has moved",
             percent(off_), first_off_s_)});
  if (jumps_ > 0)
    notes.push_back(
        {"hand jumped",
         formatted("the hand jumped by %.3g mm at %.6g s, because its pixel then showed another surface",
                   1e3 * first_jump_m_, first_jump_s_)});
  if (jumps_ > 1)
    notes.back().text += formatted("; it jumped %zu times, by up to %.3g mm", jumps_, 1e3 * longest_jump_m_);
  return notes;
}

std::vector<Note> fixture_notes(const FixtureAssignment& fixtures,
                                const std::shared_ptr<const NeighbourSearch>& first,
                                const std::shared_ptr<const NeighbourSearch>& last) {
  const PointCloud* const at_first = first ? first->stored_cloud() : nullptr;
  const PointCloud* const at_last = last ? last->stored_cloud() : nullptr;
  if (fixtures.empty() || !at_first || !at_last) return {};
  std::vector<std::size_t> rules = fixtures.rules_without_points(*at_first);
  if (!rules.empty() && at_last != at_first) {
    std::vector<std::size_t> in_both;
    const std::vector<std::size_t> later = fixtures.rules_without_points(*at_last);
    std::set_intersection(rules.begin(), rules.end(), later.begin(), later.end(),
                          std::back_inserter(in_both));
    rules = std::move(in_both);
  }
  std::vector<Note> notes;
  for (const std::size_t rule : rules)
    notes.push_back({"nothing selected", "fixtures." + std::to_string(rule) +
                                             " selects no point of the first frame and none of the last"});
  return notes;
}

std::vector<Note> slave_notes(const Trace& trace) {
  std::vector<Note> notes;
  if (!trace.has_slave() || trace.length() == 0) return notes;
  if (!is_started(trace))
    return {{"slave without command", "the slave never started: no command was finite"}};
  const auto is_unknown = [](double clearance) { return std::isnan(clearance); };
  if (std::all_of(trace.slave_clearance_m.begin(), trace.slave_clearance_m.end(), is_unknown))
    notes.push_back({"slave without surface",
                     "the true surface is not known where the slave was, so it could not touch anything"});
  else if (std::isnan(max_slave_force_N(trace)))
    notes.push_back(
        {"slave without surface",
         "the normal of the true surface is not known where the slave was behind it, so there was "
         "no force on it, and measures of its force have no value"});
  add_start(trace, notes);
  if (kept_first_command(trace))
    notes.push_back(
        {"slave without command",
         "the slave received no command after its first: all were lost, late or in the dead-band"});
  if (!sends_forces(trace)) return notes;
  if (feels_nothing(trace))
    notes.push_back(
        {"slave without command",
         "the hand felt no force of the slave: all were lost, late, in the dead-band, or stopped by "
         "gain or device"});
  if (const double given_J = max_energy_injected_J(trace); given_J > kMuchEnergy_J) {
    notes.push_back(
        {"slave loop gains energy",
         formatted(
             "the device gave the hand up to %.3g J, with a force of up to %.3g N: hand, links and slave "
             "may oscillate",
             given_J, max_device_force_N(trace))});
  }
  return notes;
}

std::vector<Note> slave_setting_notes(const Experiment& experiment, Experiment::Hand hand) {
  constexpr const char* kKind = "setting without effect";
  const auto setting = [&](const char* path) { return experiment.value_at_start(path); };
  std::vector<Note> notes;
  if (!setting("slave").is_object()) return notes;
  const std::string force = setting("feedback.force").get<std::string>();
  if (force != "rendered" && !setting("fixtures").empty())
    notes.push_back({kKind, "fixtures hold nothing back with feedback.force = " + force +
                                ": the HIP is sent to the slave, and the hand does not feel the renderer"});
  const bool is_scripted = hand == Experiment::Hand::simulated && !setting("operator").is_object() &&
                           setting("trajectory.name") != "live-session";
  if (is_scripted && force != "rendered" && force != "none")
    notes.push_back({kKind, "feedback.force = " + force +
                                " moves nothing: without the section operator the hand follows its path, "
                                "whatever the device exerts"});
  return notes;
}

std::string slave_summary(const Trace& trace) {
  const double clearance_m = min_slave_clearance_m(trace);
  if (std::isnan(clearance_m)) return {};
  const double touched = slave_touched(trace);
  if (std::isnan(touched)) return "it is not known whether the slave touched: its force is unknown";
  if (touched > 0)
    return formatted("the slave touched first at %.3f s; largest force of the scene on it: %.3g N",
                     first_slave_contact_time_s(trace), max_slave_force_N(trace));
  return formatted("the slave did not touch; it came within %.3g mm of the surface", 1e3 * clearance_m);
}

}  // namespace remote_touch
