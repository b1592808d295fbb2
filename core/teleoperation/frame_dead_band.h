// A dead-band for frames: a frame is sent to the operator only if the surface near the slave has moved, or if
// values of its points have changed.
//
// This is the part of model-mediated teleoperation that decides about updates of the model: X. Xu, B.
// Cizmeci, A. Al-Nuaimi, E. Steinbach, "Point cloud-based model-mediated teleoperation with dynamic and
// perception-based model updating", IEEE Trans. Instrum. Meas. 63, 2014. Only its abstract was available; the
// rule is this project's. Stiffness and friction of the object are not estimated.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/rendering/frame.h"

namespace remote_touch {

struct FrameDeadBandSettings {
  double least_motion_m = 0;
  double near_m = 0.04;
};

Parameters parameters(FrameDeadBandSettings& s);
inline std::string validate(const FrameDeadBandSettings&) {
  return {};
}

// Returns the largest motion of the surface near a position from one frame to another, m, not negative. A
// first plane is fitted to the points of `before` within R = near_m + r_f of near_W, where r_f is the largest
// radius of a forbidden region in the two frames; f is the foot of near_W on it. A plane is then fitted to
// the points of each frame within near_m of f. The result is the largest distance of the new plane, along the
// normal of the old one, from the disc of radius near_m on the old plane: |h| + near_m tan(a), with the
// height h of the new plane over the foot of f on the old one, and the angle a of the two planes. A point at
// the distance r from near_W has the weight (1 - (r / R)^2)^2, and one at the distance r from f has
// (1 - (r / near_m)^2)^2. Returns 0 if neither frame has 3 points there, and infinity if only one has, or if
// the planes are perpendicular. So a surface that stays farther than R from near_W does not count as moved.
double surface_motion_m(const NeighbourSearch& before, const NeighbourSearch& now, const Vec3& near_W,
                        double near_m, const Kernels& kernels);

class FrameDeadBand {
 public:
  // pre: validate(settings) is empty.
  explicit FrameDeadBand(const FrameDeadBandSettings& settings) : s_(settings) {}

  // Returns true if a frame has to be sent, and then keeps it as the newest that was sent. slave_W: position
  // of the slave, world frame, when the frame was captured; nothing if it is not known, because the slave had
  // not started or its positions were lost. The frame is sent if
  // - it is the first, or least_motion_m is 0;
  // - slave_W is not known;
  // - the surface near slave_W has moved by more than least_motion_m since the last frame that was sent;
  // - the radius of a region, the stiffness of a point or a guidance target differs from that frame. Points
  //   with the same index are compared, if both were measured. If the frames have different sizes, they
  //   differ unless all points of both have the same values.
  // If least_motion_m is above 0, a frame is never sent in two cases, because renderers drop it: if a frame
  // that was captured later has already come, sent or not; or if it was not captured after the last one that
  // was sent.
  bool sends(const Frame& frame, const std::optional<Vec3>& slave_W, const Kernels& kernels);
  // Returns the number of frames that had to be sent.
  int sent() const { return sent_; }

 private:
  // The radius of the region and the stiffness of every point, at its index; nothing: it is not measured.
  using PointValues = std::vector<std::optional<std::array<double, 2>>>;
  static PointValues values_of(const NeighbourSearch& points, const Kernels& kernels);
  static bool differ(const PointValues& before, const PointValues& now);

  const FrameDeadBandSettings s_;
  std::optional<Frame> last_;       // the newest frame that was sent
  std::optional<double> newest_s_;  // the latest time of capture of all frames
  PointValues last_values_;
  int sent_ = 0;
};

}  // namespace remote_touch
