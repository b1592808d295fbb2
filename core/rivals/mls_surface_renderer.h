// A proxy on the moving least squares surface of a point cloud (mls_projection.h). J.-K. Lee and Y. J. Kim,
// "Haptic rendering of point set surfaces", World Haptics 2007, take the projection of a cloud point onto
// this surface as the contact point. Only their abstract was available; the rules of the proxy are this
// project's (README.md of this folder).
//
//   free      the proxy follows the HIP. Contact begins at the first checked position (every h/4) on the path
//             of the HIP since the last tick, its end included, that lies behind the surface. Farther than
//             h/2 from the surface the sign of f decides; nearer, the side of the position's own projection
//   contact   the contact point is the projection of the proxy onto the surface. It slides in the tangent
//             plane towards the HIP, by at most R/4, and is projected back, until it comes no nearer
//   released  when the HIP is outside of the tangent plane, or the surface does not reach the proxy
//
// The force is F = k_s (proxy - HIP). Clouds may vary with time: each tick begins with a projection of the
// proxy onto the surface of the newest frame. In contact the normal keeps its side. In free space the side is
// that of the sensor, as for surfels, or that from which the proxy came, as for implicit-surface. Limits: a
// cloud that passes the proxy by more than R from one frame to the next is lost. Two sheets less than R apart
// are averaged. With side=sensor, the back of a sheet pulls the hand through. Forbidden regions r_f are
// ignored.
//
// Outputs: contact_count is the number of points within R; steps is the number of checked positions and
// projections; the state is entrenched if the projection had not settled to R/1000 at the end of the tick.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "core/rivals/mls_projection.h"
#include "core/rivals/point_normals.h"
#include "core/rivals/rival_renderer.h"

namespace remote_touch {

enum class OutsideRule {
  sensor,  // the side of the surface that the sensor sees
  path     // the side from which the proxy came near the points
};

struct MlsSurfaceParameters {
  double weight_width_m = 0.0045;  // h; 0: computed from the first frame
  int degree = 2;
  OutsideRule outside = OutsideRule::sensor;
  Vec3 view_direction{0, -1, 0};
  double stiffness_N_per_m = 600;
  int steps_per_tick = 20;
};

Parameters parameters(MlsSurfaceParameters& p);
std::string validate(const MlsSurfaceParameters& p);
inline RenderedContact rendered_contact(const MlsSurfaceParameters&) {
  return {};
}

class MlsSurfaceRenderer final : public RivalOf<MlsSurfaceParameters> {
 public:
  // haptic_rate_hz has no effect: the method does not depend on time.
  MlsSurfaceRenderer(const MlsSurfaceParameters& parameters, double haptic_rate_hz, const Kernels& kernels);
  void reserve(std::size_t points) override;

 private:
  bool set_points(const NeighbourSearch& points) override;
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  void reset_motion() override { is_held_ = false; }

  void choose_width(const NeighbourSearch& points);
  MlsSample sample(const Vec3& p_W);
  MlsFoot project(const Vec3& p_W, const Vec3& start_W);
  void stand_on(const MlsFoot& foot);
  bool approach(const Vec3& hip_W);
  bool begins_contact(const MlsSample& here);
  bool follow(const Vec3& hip_W);
  bool slide(MlsFoot& here, const Vec3& hip_W);
  bool may_step() const { return steps_ < p_.steps_per_tick; }
  void report(const Vec3& hip_W, RenderOutput& out);

  MlsProjection surface_;
  bool has_width_;  // h is known
  NearestPoints nearest_;
  PointCloud buffer_;
  ViewPoint view_;
  Vec3 side_W_ =
      Vec3::Zero();  // normal where the proxy was last, for OutsideRule::path; zero away from points
  bool is_held_ = false;
  Vec3 start_W_ = Vec3::Zero();  // normal of the reference plane of the held proxy
  double residual_m_ = 0;        // residual of the last projection of the held proxy
  int steps_ = 0;                // checked positions and projections in this tick
};

}  // namespace remote_touch
