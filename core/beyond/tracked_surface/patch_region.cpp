#include "core/beyond/tracked_surface/patch_region.h"

namespace remote_touch {

bool PatchRegion::holds(const Ball& ball) const {
  const PatchPlace p = frame.place(ball.centre);
  const double reach = ball.radius / frame.unit_m() + 0x1p-10;
  return std::hypot(p.u, p.v) + reach < radius && std::abs(p.h) + reach < half_height;
}

}  // namespace remote_touch
