// The wrench of a renderer's output.
#pragma once

#include "core/rendering/renderer.h"
#include "core/rendering/wrench.h"

namespace remote_touch {

// Returns the wrench that the renderer commands. Without a tool it has no torque.
inline Wrench rendered_wrench(const RenderOutput& out) {
  return {out.force_N, out.tool ? out.tool->torque_Nm : Vec3(Vec3::Zero())};
}

}  // namespace remote_touch
