// A dead-band for frames: a frame is sent to the operator only if the surface near the slave has moved.
//
// This is the part of model-mediated teleoperation that decides about updates of the model: X. Xu, B.
// Cizmeci, A. Al-Nuaimi, E. Steinbach, "Point cloud-based model-mediated teleoperation with dynamic and
// perception-based model updating", IEEE Trans. Instrum. Meas. 63, 2014. Only its abstract was available; the
// rule is this project's. Stiffness and friction of the object are not estimated.
#pragma once

#include <string>

#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

struct FrameDeadBandSettings {
  double least_motion_m = 0;
  double near_m = 0.04;
};

Parameters parameters(FrameDeadBandSettings& s);
inline std::string validate(const FrameDeadBandSettings&) {
  return {};
}

// Returns the distance between the surfaces of two frames near a position, m, not negative. A first plane is
// fitted to the points of `before` within near_m of near_W; q is the foot of near_W on it. For both frames
// the points within near_m of q are averaged. The result is the distance of the two means along the normal of
// the plane that is fitted to those points of `before`. A point at the distance r from near_W or q has the
// weight (1 - (r / near_m)^2)^2. Returns 0 if neither frame has 3 points there, and infinity if only one has.
// So a surface that stays farther than near_m from near_W does not count as moved.
double surface_motion_m(const NeighbourSearch& before, const NeighbourSearch& now, const Vec3& near_W,
                        double near_m, const Kernels& kernels);

class FrameDeadBand {
 public:
  // pre: validate(settings) is empty.
  explicit FrameDeadBand(const FrameDeadBandSettings& settings) : s_(settings) {}

  // Returns true if a frame has to be sent, and then keeps it as the newest that was sent. slave_W: position
  // of the slave, world frame, when the frame was captured. If it is not finite, the slave has not started,
  // and the frame is sent. The first frame is always sent.
  bool sends(std::shared_ptr<const NeighbourSearch> frame, const Vec3& slave_W, const Kernels& kernels);
  // Returns the number of frames that had to be sent.
  int sent() const { return sent_; }

 private:
  const FrameDeadBandSettings s_;
  std::shared_ptr<const NeighbourSearch> last_;  // the newest frame that was sent
  int sent_ = 0;
};

}  // namespace remote_touch
