// A sheet of points, and a tool in the free space above it.
#pragma once

#include <gtest/gtest.h>

#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/points/vector.h"

namespace remote_touch {

// columns x rows points in the plane y = y_m, centred about (x_m, 0).
struct Sheet {
  int columns = 41, rows = 41;
  double spacing_m = 0.002, x_m = 0, y_m = 0;
  Vec3 normal = Vec3::UnitY();
};

inline PointCloud sheet_of(const Sheet& s) {
  PointCloud cloud;
  for (int j = 0; j < s.rows; ++j)
    for (int i = 0; i < s.columns; ++i)
      cloud.append(
          {s.x_m + (i - 0.5 * (s.columns - 1)) * s.spacing_m, s.y_m, (j - 0.5 * (s.rows - 1)) * s.spacing_m},
          s.normal);
  return cloud;
}

// A tool above a sheet at height 0: nothing holds it.
inline void expect_free(Renderer& r) {
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
