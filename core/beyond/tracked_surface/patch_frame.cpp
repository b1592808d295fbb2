#include "core/beyond/tracked_surface/patch_frame.h"

namespace remote_touch {

PatchFrame::PatchFrame(const Vec3& origin_W, const Vec3& normal_W, double contact_radius_m)
    : origin_W_(origin_W), n_W_(normal_W), unit_m_(contact_radius_m) {
  int min = 0;
  normal_W.cwiseAbs().minCoeff(&min);
  u_W_ = normal_W.cross(Vec3::Unit(min)).normalized();
  v_W_ = normal_W.cross(u_W_);
}

}  // namespace remote_touch
