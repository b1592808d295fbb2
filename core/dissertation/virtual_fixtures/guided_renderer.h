// Guidance on top of any renderer, 7.4. The wrench towards the active fixture's goal is added to the
// renderer's own wrench, and the steps of a task switch fixtures on and off. In 7.5 one fixture is active at
// a time: activating one stops the others. Several pull only while one falls and another rises (fade_s), or
// if several start enabled because their first step releases them. Their summed wrench has the limits of one.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/parameters/parameter.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// A guidance virtual fixture is a spring that pulls the hand towards a goal pose in front of a class of
// points, 7.3.2 and 7.4. This class decides whether it pulls, and how strongly. If a target is not visible in
// a frame, the last one is used for a while. The force rises and falls gradually. Neither is in the
// dissertation.
class GuidancePresence {
 public:
  // hold_s: time for which the last target is still used after it is lost; it is lost when a frame arrives
  // that has fewer than min_points of its points. fade_s: time in which the force rises from zero to its full
  // value, and in which it falls to zero again; 0: within one tick.
  GuidancePresence(std::size_t min_points, double hold_s, double fade_s)
      : min_points_(min_points), hold_s_(hold_s), fade_s_(fade_s) {}

  // Adds the target of the newest frame, which arrives at arrives_s. A target of fewer than min_points points
  // counts as lost. A target of strength 0 is switched off by its rule: it and the last target are not used.
  void on_frame(const GuidanceTarget& target, double arrives_s);
  // Returns the newest target with min_points points or more, as long as it is visible and for hold_s after
  // it was lost; null after that, before there was one, and when it is switched off.
  const GuidanceTarget* target(double time_s) const;
  // Returns the factor of the force, 0 to 1. Call it once a tick. wanted: the fixture is active and has a
  // target.
  double advance(bool wanted, double time_s);

 private:
  std::size_t min_points_;
  double hold_s_, fade_s_;
  GuidanceTarget seen_;
  bool is_seen_ = false;
  double lost_s_ = 0;  // arrival of the first frame in which it is lost
  double level_ = 0;
  std::optional<double> level_at_s_;  // time of the previous tick
};

enum class GuidedOrientation { fixed, plane };

struct GuidanceSettings {
  GuidedOrientation orientation = GuidedOrientation::fixed;
  Vec3 rotation_deg{0, 0, 0};
  Vec3 approach_axis{1, 0, 0};
  double standoff_m = 0.1;
  Vec3 offset_m{0, 0, 0};
  int min_points = 20;
  double hold_s = 0, fade_s = 0;  // times of GuidancePresence; not in the dissertation
  double stiffness_N_per_m = 200;
  double gyration_radius_m = 0.03;
  double max_force_N = 4;
  double max_torque_Nm = 0.2;
  double reached_deg = 5;
};

Parameters parameters(GuidanceSettings& s);
std::string validate(const GuidanceSettings& s);

// Returns the goal pose of the tool, base frame; nullopt if the target has fewer than min_points points. The
// position is the target's mean, moved back by standoff_m along the approach axis, plus both offsets. The
// orientation is rotation_deg. If GuidedOrientation is plane and the target is flat, it is followed by the
// shortest rotation that turns the approach axis against the normal of the target's plane.
std::optional<ToolPose> guidance_goal(const GuidanceSettings& settings, const GuidanceTarget& target,
                                      const Vec3& more_offset_m = Vec3::Zero());

// Returns the wrench on the hand towards the goal, about the device's position, world frame; limited to
// max_force_N and max_torque_Nm. stiffness_N_per_m: the fixture's own stiffness; if negative, that of the
// settings is used.
Wrench guidance_wrench(const GuidanceSettings& settings, double stiffness_N_per_m, const ToolPose& goal,
                       const ToolPose& device);

// A task as a sequence of steps, the sequential tasks of 8.2. A step locks or unlocks a forbidden region, or
// activates or releases a guidance fixture.

// lock enables a forbidden region, and unlock disables it. activate starts a guidance fixture and stops all
// others. release stops a guidance fixture. wait does nothing.
enum class FixtureAction { lock, unlock, activate, release, wait };
enum class StepStart { previous, button };
enum class StepEnd { immediately, reached, button };

// A step begins when the previous one has ended and not_before_s has passed. If its start is
// StepStart::button, it then also waits for a press of the button. It performs its action when it begins. It
// ends immediately, when the tool has reached the fixture's goal, or when the button is pressed. A step that
// is not done at its deadline ends and counts as missed.
struct SequenceStep {
  FixtureAction action = FixtureAction::wait;
  std::string fixture;  // label of the fixture; wait has one only with StepEnd::reached
  StepStart start = StepStart::previous;
  double not_before_s = 0;
  StepEnd end = StepEnd::immediately;
  int button = 0;
  double deadline_s = 0;  // time limit from the beginning of the step; 0: none
  Vec3 offset_m{0, 0, 0};
};

Parameters parameters(SequenceStep& s);
std::string validate(const SequenceStep& s);
// Returns the action and the fixture as text for people, such as "activate right".
std::string name_of(const SequenceStep& s);

class FixtureSequence {
 public:
  explicit FixtureSequence(std::vector<SequenceStep> steps) : steps_(std::move(steps)) {}

  // Sets the buttons that are down in this tick, one bit each. Call it once a tick, before begins() and
  // ends().
  void set_buttons(std::uint32_t buttons);
  // Begins the current step if its conditions hold. Returns true if it begins now.
  bool begins(double time_s);
  // Ends the current step if it is done or missed. Returns true if it ends now; the next step is then the
  // current one. reached: the tool is at the step's goal.
  bool ends(double time_s, bool reached);

  // Number of the current step, from 0; the number of steps once the last has ended.
  int current() const { return current_; }
  bool is_over() const { return current_ == static_cast<int>(steps_.size()); }
  const SequenceStep& step() const { return steps_[static_cast<std::size_t>(current_)]; }  // pre: not over
  bool is_running() const { return running_; }  // the current step has begun
  int missed() const { return missed_; }        // number of missed steps so far
  const std::vector<SequenceStep>& steps() const { return steps_; }

 private:
  bool takes_press(int button);

  std::vector<SequenceStep> steps_;
  int current_ = 0, missed_ = 0;
  bool running_ = false;
  double began_s_ = 0;
  std::uint32_t down_ = 0, pressed_ = 0;  // pressed_: went down in this tick, not yet used by a step
};

// Returns one line that describes the first mistake in a task with these fixtures; an empty string if there
// is none. Labels must be unique and known. Only forbidden fixtures can be locked and unlocked; only guidance
// fixtures can be activated, released and waited for. There may be one guidance fixture, but no more, that no
// step activates or releases.
std::string validate(const std::vector<FixtureValues>& fixtures, const std::vector<SequenceStep>& steps);

class GuidedRenderer final : public Renderer {
 public:
  // fixtures: all fixtures of the experiment, in order. switches: the switches that its FixtureAssignment
  // reads. A fixture starts disabled if the first step that acts on it enables it. Otherwise it starts
  // enabled, also if no step acts on it.
  GuidedRenderer(std::unique_ptr<Renderer> inner, const GuidanceSettings& settings,
                 const std::vector<FixtureValues>& fixtures, std::vector<SequenceStep> steps,
                 std::shared_ptr<FixtureSwitches> switches);

  void prepare(Frame& frame) const override { inner_->prepare(frame); }
  void reserve(std::size_t points) override { inner_->reserve(points); }
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override { return inner_->live_parameters(); }
  void parameters_changed() override { inner_->parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  struct Guide {
    std::size_t fixture;       // index in the list of fixtures
    double stiffness_N_per_m;  // -1: stiffness of the settings
    double reached_m;
    bool active;
    GuidancePresence presence;
    Vec3 offset_m = Vec3::Zero();  // offset of the step that activated it
    // The last goal of the force and the last strength of the rule. The force uses them while it falls.
    ToolPose goal = {};
    double strength = 0;
  };
  void begin_with(const std::vector<FixtureValues>& fixtures);
  void act(const SequenceStep& step);
  struct Remaining {
    double m, rad;
  };
  std::optional<Remaining> remaining(const Guide& guide, const RenderOutput& out, double time_s) const;
  const Guide* goal_of(const SequenceStep& step) const;
  void advance(double time_s, RenderOutput& out);
  void pull(const std::optional<ToolPose>& device, double time_s, RenderOutput& out);
  std::size_t number_of(const std::string& label) const;
  Guide* guide_of(std::size_t fixture);
  std::optional<ToolPose> goal(const Guide& guide, double time_s) const;

  const std::unique_ptr<Renderer> inner_;
  const GuidanceSettings settings_;
  std::vector<std::string> labels_;
  std::vector<Guide> guides_;
  FixtureSequence sequence_;
  const std::shared_ptr<FixtureSwitches> switches_;
  FrameOrder order_;
};

}  // namespace remote_touch
