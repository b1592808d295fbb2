// The shadow that a second device beside a camera has: a projector of light, or the second camera of a pair.
#pragma once

#include <vector>

#include "core/geometry/camera.h"

namespace remote_touch {

// Returns for each pixel of a depth image 1 if the second device does not see the surface that the camera
// sees there. The device is at (baseline, 0, 0) in the camera frame, to the camera's right, so that shadows
// lie to the left of near objects. They are baseline focal (1 / z_near - 1 / z_far) pixels wide.
//
// A straight line stays straight in coordinates of column u and disparity d = baseline focal / z. The
// line from a point (u, d) to the device is (u + s, d + s), s > 0. The point is in the shadow if this line
// meets the surfaces of its row. They are exactly known at the pixels. Between two neighbours the surface is
// straight, unless their depths differ by more than edge_jump_m: then there is an edge in the middle between
// them, and nothing behind it. A surface that turns its back to the device is in the shadow as well. Surfaces
// that the camera does not see are unknown and throw no shadow.
//
// focal_baseline_px_m: product of the focal length in pixels and the baseline, above 0.
std::vector<char> baseline_shadow(const DepthImage& depth, double focal_baseline_px_m, double edge_jump_m);

}  // namespace remote_touch
