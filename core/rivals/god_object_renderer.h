// The god-object of C. Zilles and K. Salisbury, "A constraint-based god-object method for haptic display",
// IROS 1995, on the grid mesh of an organised frame (grid_mesh.h). Recorded depth images were rendered in
// this way before point clouds were rendered directly ([82], [83] of the dissertation).
//
// The god-object is a point that never passes a triangle, from either side. Each round moves it straight to
// the position that is nearest to the HIP among those on the free side of all planes met so far. If a
// triangle is in the way, it stops there, and the plane of this triangle is added. If no triangle is in the
// way, it has arrived, and the planes are searched anew from there. This ends when the god-object is at rest
// or when the maximum number of rounds is reached. F = k_s (god-object - HIP).
//
// So that its side is always clear, the god-object keeps the distance surface_offset_m from the planes that
// hold it. It does not move if it is between two planes that are closer together than that.
//
// Limits: a new frame replaces the mesh, and the god-object stays at its position, because the motion of the
// surface is not known. A mesh that passes over the god-object no longer holds it (pop-through). It falls
// through regions that were not measured, and through gaps wider than max_edge_length_m, which have no
// triangles. An unorganised frame has no mesh: the god-object is free and the status is no_frame, although
// frame_index is 0 or more. Forbidden regions r_f are ignored; the stiffness of points (5.8) is used.
//
// Outputs: contact_count is the number of planes that hold the god-object, 0 to 3; steps is the number of
// rounds; nearest_distance_m is the distance to the nearest point; the state is never entrenched, because a
// surface that has passed the god-object no longer holds it.
#pragma once

#include <string>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/rivals/grid_mesh.h"
#include "core/rivals/plane_constraints.h"
#include "core/rivals/rival_renderer.h"

namespace remote_touch {

struct GodObjectParameters {
  double max_edge_length_m = 0.02;
  double surface_offset_m = 1e-5;
  double stiffness_N_per_m = 600;
  int steps_per_tick = 60;
};

Parameters parameters(GodObjectParameters& p);
std::string validate(const GodObjectParameters& p);
// Returns an upper bound, over all poses, of the increase of |force| per displacement of the HIP, N/m.
// It does not cover points that have a stiffness of their own.
inline double max_stiffness_N_per_m(const GodObjectParameters& p) {
  return p.stiffness_N_per_m;
}

class GodObjectRenderer final : public RivalRenderer {
 public:
  // pre: validate(parameters) is empty. haptic_rate_hz has no effect: the method does not depend on time.
  GodObjectRenderer(const GodObjectParameters& parameters, double haptic_rate_hz, const Kernels& kernels);
  void reserve(std::size_t points) override;
  Parameters live_parameters() override { return live_ones(parameters(p_)); }
  void parameters_changed() override { stiffness_N_per_m_ = p_.stiffness_N_per_m; }

 private:
  bool set_points(const NeighbourSearch& points) override;
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  void update_mesh();
  bool follow(const Vec3& hip_W);
  bool go(const Vec3& goal);
  void report(const Vec3& hip_W, RenderOutput& out);

  GodObjectParameters p_;
  GridMesh mesh_;
  Vec3 meshed_W_ = Vec3::Zero();  // centre of the ball in which mesh_ is valid, if is_meshed_
  bool is_meshed_ = false;
  int columns_ = 0;  // number of columns of the newest frame
  PlaneConstraints planes_;
  int active_planes_ = 0, rounds_ = 0;  // values of this tick
};

}  // namespace remote_touch
