// The surfels of A. Leeper, S. Chan, K. Salisbury, ICRA 2012, [84] of the dissertation, after a description
// of the authors' program (README.md of this folder says what is known of it). Every point has its own
// normal, from the points of its frame, turned towards the sensor of that frame. The surface is f = n . (p -
// a) = 0 with the weighted means a of the points and n of their normals within R. So f < 0 is behind the
// surface, from whichever side the proxy came.
//
//   free      the proxy is the HIP, or follows it if its path needs more checks than a tick makes. Contact
//             begins if f < 0 at a checked position (every R/8) on the path of the HIP since the last tick,
//             its end included; so also if a new frame puts the surface in front of the HIP
//   contact   per tick one step in the tangent plane towards the HIP, less what friction holds back, and one
//             projection onto f = 0 of at most R/2
//   released  when the HIP is outside of the tangent plane, or nothing is within R of the proxy
//
// The force is F = k_s (proxy - HIP). The normal of a tick is blended with that of the previous tick. Limits:
// a cloud that passes the proxy by more than R from one frame to the next is lost, unless the HIP is within R
// behind it. The back of a sheet pulls the hand through. Forbidden regions r_f are ignored.
//
// Outputs: contact_count is the number of points within R; steps is the number of evaluations of f; the state
// is entrenched if f < 0 at the end of a tick.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/rivals/point_normals.h"
#include "core/rivals/rival_renderer.h"

namespace remote_touch {

struct SurfelParameters {
  double support_radius_m = 0.01;  // 0: computed from the first frame
  SurfaceWeight weight = SurfaceWeight::wendland;
  int normal_neighbours = 9;
  double previous_normal_fraction = 0.4;
  double friction = 0.2;
  int fused_frames = 1;
  Vec3 view_direction{0, -1, 0};
  double stiffness_N_per_m = 600;
};

Parameters parameters(SurfelParameters& p);
std::string validate(const SurfelParameters& p);
inline RenderedContact rendered_contact(const SurfelParameters&) {
  return {};
}

class SurfelRenderer final : public RivalOf<SurfelParameters> {
 public:
  // haptic_rate_hz has no effect: the method does not depend on time.
  SurfelRenderer(const SurfelParameters& parameters, double haptic_rate_hz, const Kernels& kernels);
  void reserve(std::size_t points) override;

 private:
  std::shared_ptr<const NeighbourSearch> shown(const Frame& frame) override;
  bool set_points(const NeighbourSearch& points) override;
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  void reset_motion() override { is_held_ = false; }

  PointCloud joined();
  Vec3 normal_of(std::uint32_t number, const Vec3& x_W);
  SurfaceSample sample(const Vec3& p_W);
  void approach(const Vec3& hip_W);
  void follow(const Vec3& hip_W);
  void release(const Vec3& hip_W);
  void report(const Vec3& hip_W, RenderOutput& out);

  double radius_m_;  // R; 0 until it is known
  // One of the newest frames, which are joined. Its normals come from its own points and its own sensor.
  struct FusedFrame {
    std::shared_ptr<const NeighbourSearch> points;  // null before the frame came
    PointNormals normals;
    std::size_t first = 0;  // number of its first point in the joined cloud
  };
  std::vector<FusedFrame> frames_;
  std::size_t newest_ = 0;
  PointCloud buffer_;
  Buffer<Vec3> gathered_normals_;
  bool is_held_ = false;
  double depth_m_ = 0;  // depth of the held proxy behind the surface
  int samples_ = 0;     // evaluations of f in this tick
};

}  // namespace remote_touch
