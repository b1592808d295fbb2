// Shared helpers for the tests of guidance on top of a renderer: fixtures, steps, targets and frames in one
// line each.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/dissertation/virtual_fixtures/guided_renderer.h"
#include "core/points/vector.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::guided_scene {

enum class Inner { proxy, tool };
inline std::string inner_name(const testing::TestParamInfo<Inner>& info) {
  return info.param == Inner::proxy ? "proxy" : "tool";
}

inline std::unique_ptr<Renderer> inner(Inner kind) {
  if (kind == Inner::proxy)
    return std::make_unique<ProxyRenderer>(ProxyParameters{}, 1000, scenes::kernels());
  return std::make_unique<ToolRenderer>(ToolParameters{}, scenes::box_tool({0.02, 0.005, 0.01}),
                                        scenes::kernels());
}

inline FixtureValues fixture(FixtureRole role, const std::string& label) {
  FixtureValues values;
  values.role = role, values.label = label;
  return values;
}
inline FixtureValues guide(const std::string& label) {
  return fixture(FixtureRole::guidance, label);
}
inline FixtureValues region(const std::string& label) {
  return fixture(FixtureRole::forbidden, label);
}

inline SequenceStep step(FixtureAction action, const std::string& label,
                         StepStart start = StepStart::previous, int button = 0) {
  SequenceStep s;
  s.action = action, s.fixture = label, s.start = start, s.button = button;
  return s;
}
inline SequenceStep until_reached(SequenceStep s) {
  s.end = StepEnd::reached;
  return s;
}

// The goal is the target itself, in the orientation of the base.
inline GuidanceSettings plain() {
  GuidanceSettings s;
  s.standoff_m = 0;
  return s;
}

using Switches = std::shared_ptr<FixtureSwitches>;
inline GuidedRenderer guided(Inner kind, const std::vector<FixtureValues>& fixtures,
                             std::vector<SequenceStep> steps = {}, const GuidanceSettings& settings = plain(),
                             const Switches& switches = std::make_shared<FixtureSwitches>()) {
  EXPECT_EQ(validate(fixtures, steps), "");
  return {inner(kind), settings, fixtures, std::move(steps), switches};
}

inline GuidanceTarget target(const Vec3& mean_W) {
  return {100, mean_W, Vec3::Zero()};
}

inline Frame frame(std::vector<GuidanceTarget> targets, int index = 0) {
  Frame f = scenes::frame(scenes::flat_grid(40), index);
  f.guidance = std::move(targets);
  return f;
}

inline DeviceState device(const Vec3& p_W, const Vec3& turn = Vec3::Zero(), std::uint32_t buttons = 0) {
  return {p_W, rotation(turn), buttons};
}

inline const Vec3 kAbove(0, 0.1, 0), kLeft(-0.05, 0.1, 0), kRight(0.05, 0.1, 0);

inline void expect_no_guidance(const RenderOutput& out) {
  ASSERT_TRUE(out.guidance);
  EXPECT_FALSE(out.guidance->active);
  EXPECT_EQ(out.guidance->force_N, Vec3::Zero());
  EXPECT_EQ(out.guidance->torque_Nm, Vec3::Zero());
  EXPECT_TRUE(out.guidance->goal_W.array().isNaN().all());
  EXPECT_TRUE(out.guidance->goal_orientation_W.coeffs().array().isNaN().all());
  EXPECT_EQ(out.force_N, Vec3::Zero());
  if (out.tool) {
    EXPECT_EQ(out.tool->torque_Nm, Vec3::Zero());
  }
}

}  // namespace remote_touch::guided_scene
