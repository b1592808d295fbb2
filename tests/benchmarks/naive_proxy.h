// The reference of the benchmarks: the method written plainly from its equations, over all points, in double
// precision and without the kernels.
#pragma once

#include <vector>

#include "core/dissertation/proxy/proxy_motion.h"
#include "core/points/point_cloud.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch::naive {

struct Step {
  ContactState state = ContactState::free;  // state before the step
  double nearest_distance_m = 0;
  Vec3 normal = Vec3::Zero();
  Vec3 step = Vec3::Zero();
};

// One proxy step, 4.2.3 and 4.2.4, which checks every point. pre: step_rule = variable, free_root = ahead.
Step proxy_step(const std::vector<Vec3>& points, const Vec3& proxy_W, const Vec3& hip_W,
                const Vec3& previous_normal, const ProxyParameters& p);

std::vector<Vec3> points_of(const PointCloud& cloud);

}  // namespace remote_touch::naive
