#include "core/dissertation/virtual_fixtures/guided_renderer.h"

#include <algorithm>
#include <cmath>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/points/vector.h"

namespace remote_touch {

void GuidancePresence::on_frame(const GuidanceTarget& target, double arrives_s) {
  const bool is_off = target.strength == 0;
  const bool was_seen = std::exchange(is_seen_, !is_off && target.points >= min_points_);
  if (is_off)
    seen_ = {};
  else if (is_seen_)
    seen_ = target;
  else if (was_seen)
    lost_s_ = arrives_s;
}

const GuidanceTarget* GuidancePresence::target(double time_s) const {
  if (is_seen_) return &seen_;
  const bool is_held = hold_s_ > 0 && seen_.is_visible() && time_s - lost_s_ < hold_s_;
  return is_held ? &seen_ : nullptr;
}

double GuidancePresence::advance(bool wanted, double time_s) {
  const double since_s = time_s - level_at_s_.value_or(time_s);
  level_at_s_ = time_s;
  const double change = fade_s_ > 0 ? since_s / fade_s_ : 1;
  level_ = std::clamp(wanted ? level_ + change : level_ - change, 0.0, 1.0);
  return level_;
}

namespace {

// Returns the shortest rotation that turns one unit vector into another. If the vectors are opposite, every
// half-turn about a perpendicular axis is the shortest, and one of them is returned.
Eigen::Quaterniond shortest_rotation(const Vec3& from, const Vec3& to) {
  constexpr double kOpposite = 1e-9;
  const double w = 1 + from.dot(to);
  if (w > kOpposite) {
    const Vec3 v = from.cross(to);
    return Eigen::Quaterniond(w, v.x(), v.y(), v.z()).normalized();
  }
  int min = 0;
  from.cwiseAbs().minCoeff(&min);
  const Vec3 axis = from.cross(Vec3::Unit(min)).normalized();
  return {0, axis.x(), axis.y(), axis.z()};
}

}  // namespace

Parameters parameters(GuidanceSettings& s) {
  return {
      {"orientation", choice(s.orientation, {"fixed", "plane"}), 0, 0,
       "orientation of the goal: fixed: rotation_deg; plane: perpendicular to the plane of the target's points, if they lie in a plane"},
      {"rotation_deg", &s.rotation_deg, -360, 360,
       "rotation vector (axis times angle) from the axes of the tool to the goal, base frame"},
      {"approach_axis", &s.approach_axis, -1, 1, "axis of the tool that points at the target, tool frame"},
      {"standoff_m", &s.standoff_m, 0, 1, "distance of the goal from the target, against the approach axis"},
      {"offset_m", &s.offset_m, -1, 1, "offset added to the goal, base frame"},
      {"min_points", &s.min_points, 1, 1000000,
       "minimum number of points of a target; with fewer, the target is lost"},
      {"hold_s", &s.hold_s, 0, 10,
       "time for which guidance uses the last target after it was lost; 0: the guidance force ends with the frame in "
       "which it is lost"},
      {"fade_s", &s.fade_s, 0, 10,
       "time over which the guidance force rises when it begins, and falls when it ends; 0: in one tick"},
      {"stiffness_N_per_m", &s.stiffness_N_per_m, 0, 10000,
       "stiffness of the spring to the goal, for fixtures without their own"},
      {"gyration_radius_m", &s.gyration_radius_m, 0, 1,
       "rotational stiffness = stiffness times this squared"},
      {"max_force_N", &s.max_force_N, 0, 1000, "maximum magnitude of the guidance force"},
      {"max_torque_Nm", &s.max_torque_Nm, 0, 100, "maximum magnitude of the guidance torque"},
      {"reached_deg", &s.reached_deg, 0, 180,
       "the goal counts as reached when the tool is within radius_m (of the fixture rule) and within this angle of it"},
  };
}

std::string validate(const GuidanceSettings& s) {
  if (s.approach_axis.norm() < 1e-3) return "approach_axis: expected a vector of length 0.001 or more";
  return {};
}

std::optional<ToolPose> guidance_goal(const GuidanceSettings& s, const GuidanceTarget& target,
                                      const Vec3& more_offset_m) {
  if (target.points < static_cast<std::size_t>(s.min_points)) return {};
  ToolPose goal;
  goal.q_WT = rotation(kRadiansPerDegree * s.rotation_deg);
  Vec3 approach_W = goal.q_WT * s.approach_axis.normalized();
  if (s.orientation == GuidedOrientation::plane && target.is_flat()) {
    goal.q_WT = (shortest_rotation(approach_W, -target.normal_W) * goal.q_WT).normalized();
    approach_W = -target.normal_W;
  }
  goal.p_W = target.mean_W - s.standoff_m * approach_W + s.offset_m + more_offset_m;
  return goal;
}

Wrench guidance_wrench(const GuidanceSettings& s, double stiffness_N_per_m, const ToolPose& goal,
                       const ToolPose& device) {
  const WrenchSpring spring{stiffness_N_per_m >= 0 ? stiffness_N_per_m : s.stiffness_N_per_m,
                            s.gyration_radius_m, s.max_force_N, s.max_torque_Nm};
  return coupling_wrench(spring, Eigen::Matrix3d::Identity(), goal, device);
}

namespace {

constexpr double kRounding_s = 1e-9;  // rounding error of a time difference

}  // namespace

Parameters parameters(SequenceStep& s) {
  return {
      {"action", choice(s.action, {"lock", "unlock", "activate", "release", "wait"}), 0, 0,
       "lock: enable a forbidden region; unlock: disable it; activate: start a guidance fixture and stop any other; release: stop it; wait: do nothing"},
      {"fixture", &s.fixture, 0, 0, "label of the fixture on which the step acts"},
      {"start", choice(s.start, {"previous", "button"}), 0, 0,
       "previous: start when the previous step has ended; button: then wait for the button"},
      {"not_before_s", &s.not_before_s, 0, 86400, "earliest start time"},
      {"done", choice(s.end, {"immediately", "reached", "button"}), 0, 0,
       "when the step ends: immediately, when the tool has reached the goal, or when the button is pressed"},
      {"button", &s.button, 0, 31, "number of the button"},
      {"deadline_s", &s.deadline_s, 0, 86400,
       "maximum duration; a longer step counts as missed and the next one starts; 0: no limit"},
      {"offset_m", &s.offset_m, -1, 1, "for activate: offset added to the goal, base frame"},
  };
}

std::string name_of(const SequenceStep& s) {
  SequenceStep step = s;
  const auto action = std::get<Choice>(parameters(step).front().value);
  return action.names[static_cast<std::size_t>(action.get())] + (s.fixture.empty() ? "" : " ") + s.fixture;
}

std::string validate(const SequenceStep& s) {
  const bool needs_fixture = s.action != FixtureAction::wait || s.end == StepEnd::reached;
  if (needs_fixture && s.fixture.empty()) return "fixture = \"\": expected the label of a fixture";
  if (!needs_fixture && !s.fixture.empty())
    return "fixture = \"" + s.fixture + "\": expected none for wait, unless done = reached";
  if (s.action != FixtureAction::activate && !s.offset_m.isZero(0))
    return "offset_m: expected 0 unless action = activate";
  if (s.end == StepEnd::immediately && s.deadline_s > 0)
    return "deadline_s = " + std::to_string(s.deadline_s) + ": expected 0 for done = immediately";
  const bool guided = s.action == FixtureAction::activate || s.action == FixtureAction::wait;
  if (s.end == StepEnd::reached && !guided)
    return "done = reached: expected only with action = activate or wait";
  return {};
}

void FixtureSequence::set_buttons(std::uint32_t buttons) {
  pressed_ = buttons & ~down_;
  down_ = buttons;
}

// Returns true if the button was pressed in this tick and no step has used that press yet. The press counts
// as used then.
bool FixtureSequence::takes_press(int button) {
  const std::uint32_t bit = std::uint32_t{1} << button;
  const bool pressed = (pressed_ & bit) != 0;
  pressed_ &= ~bit;
  return pressed;
}

bool FixtureSequence::begins(double time_s) {
  if (is_over() || running_ || time_s < step().not_before_s) return false;
  if (step().start == StepStart::button && !takes_press(step().button)) return false;
  running_ = true, began_s_ = time_s;
  return true;
}

bool FixtureSequence::ends(double time_s, bool reached) {
  if (!running_) return false;
  const SequenceStep& s = step();
  const bool done = s.end == StepEnd::immediately || (s.end == StepEnd::reached && reached) ||
                    (s.end == StepEnd::button && takes_press(s.button));
  const bool missed = !done && s.deadline_s > 0 && time_s - began_s_ >= s.deadline_s - kRounding_s;
  if (!done && !missed) return false;
  missed_ += missed ? 1 : 0;
  running_ = false;
  ++current_;
  return true;
}

namespace {

bool is_for(FixtureAction action, FixtureRole role) {
  const bool forbidden = action == FixtureAction::lock || action == FixtureAction::unlock;
  return forbidden == (role == FixtureRole::forbidden);
}

// Returns the name of the action as experiment files spell it.
std::string action_name(SequenceStep step) {
  const Parameters all = parameters(step);
  const Choice& action = std::get<Choice>(all.front().value);
  return action.names[static_cast<std::size_t>(action.get())];
}

std::string labels_of(const std::vector<FixtureValues>& fixtures) {
  std::string text;
  for (const FixtureValues& fixture : fixtures)
    if (!fixture.label.empty()) text += (text.empty() ? ": \"" : ", \"") + fixture.label + "\"";
  return text.empty() ? ", but no fixture has a label" : text;
}

// Returns the first step that acts on the fixture, or steps.end().
auto first_naming(const std::vector<SequenceStep>& steps, const std::string& label) {
  return std::find_if(steps.begin(), steps.end(), [&](const SequenceStep& s) {
    return s.action != FixtureAction::wait && !label.empty() && s.fixture == label;
  });
}

bool is_named(const std::vector<SequenceStep>& steps, const std::string& label) {
  return first_naming(steps, label) != steps.end();
}

bool first_action_is(const std::vector<SequenceStep>& steps, const std::string& label, FixtureAction action) {
  const auto first = first_naming(steps, label);
  return first != steps.end() && first->action == action;
}

}  // namespace

std::string validate(const std::vector<FixtureValues>& fixtures, const std::vector<SequenceStep>& steps) {
  if (!steps.empty() && fixtures.size() > FixtureSwitches::kMaxCount)
    return "fixtures: " + std::to_string(fixtures.size()) + " rules: expected " +
           std::to_string(FixtureSwitches::kMaxCount) + " or fewer with a sequence";
  for (std::size_t i = 0; i < fixtures.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!fixtures[i].label.empty() && fixtures[i].label == fixtures[j].label)
        return "fixtures." + std::to_string(i) + ".label = \"" + fixtures[i].label +
               "\": expected a label of its own, fixtures." + std::to_string(j) + " has this one";
  std::size_t unnamed = 0;
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    if (fixtures[i].role != FixtureRole::guidance || is_named(steps, fixtures[i].label)) continue;
    if (++unnamed > 1)
      return "fixtures." + std::to_string(i) +
             ".role = guidance: expected at most once among fixtures that no step of a sequence activates or releases";
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].fixture.empty()) continue;
    const std::string at = "sequence." + std::to_string(i);
    const auto named = std::find_if(fixtures.begin(), fixtures.end(),
                                    [&](const auto& fixture) { return fixture.label == steps[i].fixture; });
    if (named == fixtures.end())
      return at + ".fixture = \"" + steps[i].fixture + "\": expected the label of a fixture" +
             labels_of(fixtures);
    if (!is_for(steps[i].action, named->role))
      return at + ".action = \"" + action_name(steps[i]) + "\": expected " +
             (named->role == FixtureRole::forbidden
                  ? "lock, unlock for a fixture with role = forbidden"
                  : "activate, release, wait for a fixture with role = guidance");
  }
  return {};
}

GuidedRenderer::GuidedRenderer(std::unique_ptr<Renderer> inner, const GuidanceSettings& settings,
                               const std::vector<FixtureValues>& fixtures, std::vector<SequenceStep> steps,
                               std::shared_ptr<FixtureSwitches> switches)
    : inner_(std::move(inner)),
      settings_(settings),
      sequence_(std::move(steps)),
      switches_(std::move(switches)) {
  begin_with(fixtures);
}

void GuidedRenderer::begin_with(const std::vector<FixtureValues>& fixtures) {
  const auto first_is = [&](const FixtureValues& fixture, FixtureAction action) {
    return first_action_is(sequence_.steps(), fixture.label, action);
  };
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    const FixtureValues& fixture = fixtures[i];
    labels_.push_back(fixture.label);
    if (fixture.role == FixtureRole::guidance)
      guides_.push_back(
          {i,
           fixture.stiffness_N_per_m,
           fixture.radius_m,
           !first_is(fixture, FixtureAction::activate),
           {static_cast<std::size_t>(settings_.min_points), settings_.hold_s, settings_.fade_s}});
    else if (i < FixtureSwitches::kMaxCount)
      switches_->set(i, !first_is(fixture, FixtureAction::lock));
  }
}

void GuidedRenderer::on_frame(const Frame& frame) {
  inner_->on_frame(frame);
  if (!order_.accept_if_newer(frame)) return;
  for (std::size_t i = 0; i < guides_.size(); ++i)
    guides_[i].presence.on_frame(i < frame.guidance.size() ? frame.guidance[i] : GuidanceTarget{},
                                 frame.arrives_s);
}

// Returns the index of the fixture with this label. pre: there is one.
std::size_t GuidedRenderer::number_of(const std::string& label) const {
  return static_cast<std::size_t>(std::find(labels_.begin(), labels_.end(), label) - labels_.begin());
}

GuidedRenderer::Guide* GuidedRenderer::guide_of(std::size_t fixture) {
  const auto found = std::find_if(guides_.begin(), guides_.end(),
                                  [&](const Guide& guide) { return guide.fixture == fixture; });
  return found == guides_.end() ? nullptr : &*found;
}

void GuidedRenderer::act(const SequenceStep& step) {
  if (step.action == FixtureAction::wait) return;
  const std::size_t fixture = number_of(step.fixture);
  Guide* const guide = guide_of(fixture);
  if (guide == nullptr) {
    switches_->set(fixture, step.action == FixtureAction::lock);
    return;
  }
  const bool activates = step.action == FixtureAction::activate;
  if (activates)
    for (Guide& other : guides_) other.active = false;
  guide->active = activates;
  if (activates) guide->offset_m = step.offset_m;
}

// Returns the guide whose goal the step waits for; null if it waits for none.
const GuidedRenderer::Guide* GuidedRenderer::goal_of(const SequenceStep& step) const {
  if (step.end != StepEnd::reached) return nullptr;
  const std::size_t fixture = number_of(step.fixture);
  const auto found = std::find_if(guides_.begin(), guides_.end(),
                                  [&](const Guide& guide) { return guide.fixture == fixture; });
  return found == guides_.end() ? nullptr : &*found;
}

std::optional<ToolPose> GuidedRenderer::goal(const Guide& guide, double time_s) const {
  const GuidanceTarget* const target = guide.presence.target(time_s);
  return target ? guidance_goal(settings_, *target, guide.offset_m) : std::nullopt;
}

// Returns the distance and the angle that remain from the tool to the goal; empty if the goal or the tool's
// position is not known. The tool counts, not the device, because the robot follows the tool. A proxy has no
// orientation, so its angle is 0.
std::optional<GuidedRenderer::Remaining> GuidedRenderer::remaining(const Guide& guide,
                                                                   const RenderOutput& out,
                                                                   double time_s) const {
  const std::optional<ToolPose> there = goal(guide, time_s);
  if (!there || !out.proxy_W.allFinite()) return {};
  double turn = 0;
  if (out.tool) turn = rotation_vector(out.tool->orientation_W * there->q_WT.conjugate()).norm();
  return Remaining{(out.proxy_W - there->p_W).norm(), turn};
}

void GuidedRenderer::advance(double time_s, RenderOutput& out) {
  while (true) {
    if (sequence_.begins(time_s)) act(sequence_.step());
    if (sequence_.is_over()) return;
    const Guide* const guide = goal_of(sequence_.step());
    std::optional<Remaining> remaining_goal;
    if (guide) remaining_goal = remaining(*guide, out, time_s);
    const bool reached = remaining_goal && remaining_goal->m <= guide->reached_m &&
                         remaining_goal->rad <= settings_.reached_deg * kRadiansPerDegree;
    if (!sequence_.ends(time_s, reached)) return;
    if (remaining_goal && std::isnan(out.guidance->sequence_distance_m))
      out.guidance->sequence_distance_m = remaining_goal->m,
      out.guidance->sequence_angle_rad = remaining_goal->rad;
  }
}

// Adds the guidance wrench to the output. While there is no valid device pose, no fixture pulls and the level
// of the force falls. When the device is valid again, the level rises from there. The goal in the output is
// that of the active fixture, or of a fixture whose force falls if none is active.
void GuidedRenderer::pull(const std::optional<ToolPose>& device, double time_s, RenderOutput& out) {
  bool has_active_goal = false;
  int pulling = 0;
  for (Guide& guide : guides_) {
    const std::optional<ToolPose> there = guide.active && device ? goal(guide, time_s) : std::nullopt;
    if (there) guide.goal = *there, guide.strength = guide.presence.target(time_s)->strength;
    const double level = guide.presence.advance(there.has_value(), time_s);
    if (level == 0 || !device) continue;
    const Wrench wrench = guidance_wrench(settings_, guide.stiffness_N_per_m, guide.goal, *device);
    out.guidance->active = true;
    ++pulling;
    if (there || !has_active_goal)
      out.guidance->goal_W = guide.goal.p_W, out.guidance->goal_orientation_W = guide.goal.q_WT;
    has_active_goal = has_active_goal || there.has_value();
    out.guidance->force_N += level * guide.strength * wrench.force_N;
    if (out.tool) out.guidance->torque_Nm += level * guide.strength * wrench.torque_Nm;
  }
  if (pulling > 1) {  // the wrench of each is limited already
    out.guidance->force_N = limited_length(out.guidance->force_N, settings_.max_force_N);
    out.guidance->torque_Nm = limited_length(out.guidance->torque_Nm, settings_.max_torque_Nm);
  }
  out.force_N += out.guidance->force_N;
  if (out.tool) out.tool->torque_Nm += out.guidance->torque_Nm;
}

RenderOutput GuidedRenderer::step(const DeviceState& device, double time_s) {
  RenderOutput out = inner_->step(device, time_s);
  out.guidance.emplace();
  sequence_.set_buttons(device.buttons);
  advance(time_s, out);
  pull(device_pose(device), time_s, out);
  out.guidance->sequence_step = sequence_.current();
  out.guidance->sequence_running = sequence_.is_running();
  out.guidance->sequence_missed = sequence_.missed();
  return out;
}

}  // namespace remote_touch
