// A tool above a sheet at height 0: nothing holds it.
#pragma once

#include <gtest/gtest.h>

#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/points/vector.h"

namespace remote_touch {

inline void expect_free(ToolRenderer& r) {
  for (int i = 0; i < 100; ++i) {
    const DeviceState d{{0.001 * i, 0.05, 0}, rotation({0.01 * i, 0.3, -0.2})};
    const RenderOutput out = r.step(d, 0.001 * i);
    EXPECT_EQ(out.proxy_W, d.position_W);
    EXPECT_EQ(out.tool->orientation_W.coeffs(), d.orientation_W.normalized().coeffs());
    EXPECT_EQ(out.force_N, Vec3::Zero());
    EXPECT_EQ(out.tool->torque_Nm, Vec3::Zero());
    EXPECT_EQ(out.contact_count, 0);
    EXPECT_TRUE(out.converged);
  }
}

}  // namespace remote_touch
