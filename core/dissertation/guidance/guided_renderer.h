// Guidance on top of any renderer, 7.4. The wrench towards the active fixture's goal is added to the
// renderer's own wrench, and the steps of a task switch fixtures on and off. In 7.5 one fixture is active at
// a time: activating one stops the others. Several pull only while one falls and another rises (fade_s), or
// if several start enabled because their first step releases them. Their summed wrench has the limits of one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/guidance/fixture_sequence.h"
#include "core/dissertation/guidance/guidance_presence.h"
#include "core/dissertation/guidance/guidance_spring.h"
#include "core/dissertation/virtual_fixtures/fixture_rule.h"
#include "core/dissertation/virtual_fixtures/fixture_switches.h"
#include "core/rendering/frame_order.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// Returns one line that describes the first mistake in a task with these fixtures; an empty string if there
// is none. Labels must be unique and known. Only forbidden fixtures can be locked and unlocked; only guidance
// fixtures can be activated, released and waited for. There may be one guidance fixture, but no more, that no
// step activates or releases.
std::string validate(const std::vector<FixtureValues>& fixtures, const std::vector<SequenceStep>& steps);

class GuidedRenderer final : public Renderer {
 public:
  // fixtures: all fixtures of the experiment, in order. switches: the switches that its FixtureAssignment
  // reads. A fixture starts disabled if the first step that acts on it enables it. Otherwise it starts
  // enabled, also if no step acts on it. pre: validate(fixtures, steps) is empty.
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
