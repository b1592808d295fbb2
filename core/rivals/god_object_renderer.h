// The god-object of C. Zilles and K. Salisbury, "A constraint-based god-object method for haptic display",
// IROS 1995, on the grid mesh of an organised frame (GridMesh). Recorded depth images were rendered in
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

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"
#include "core/rivals/rival_renderer.h"

namespace remote_touch {

// The triangle mesh between neighbouring points of an organised frame, near a position. Four neighbours in
// two rows and columns form two triangles, divided from the upper right to the lower left. If one of the four
// was not measured, the other three form one triangle. A triangle with an edge longer than a limit is left
// out, because it would bridge a depth edge, or join two sheets that are stored in consecutive rows.

struct Triangle {
  Vec3 a, b, c;
  Vec3 normal;  // unit; its sign has no meaning
};

// Crossing of a segment and a triangle. start and end: heights of the ends of the segment above the
// triangle's plane, positive on the side of the segment's start. So start > 0 >= end.
struct Crossing {
  const Triangle* triangle = nullptr;
  double start = 0, end = 0;
  double fraction() const { return start / (start - end); }  // fraction of the segment up to the plane
};

class GridMesh {
 public:
  explicit GridMesh(double max_edge_length_m) : edge_limit_m_(max_edge_length_m) {}

  // Reserves memory for frames of this number of points. assign() and the rest then never allocate.
  void reserve(std::size_t points);
  // Computes the triangles that meet the ball, from the points of a frame with this number of columns. pre:
  // points holds all points within ball.radius + edge limit of the ball's centre. The order of the points has
  // no effect: the triangles are the same, in the same order.
  void assign(const GatheredPoints& points, int columns, const Ball& ball);
  std::span<const Triangle> triangles() const { return {triangles_.data(), count_}; }

  // Returns the first triangle that the segment crosses. A segment that ends on a triangle's plane crosses
  // it. A segment that starts on the plane is on no side and does not cross it. Triangles are enlarged by
  // 1e-9 of their size, so that no segment passes between two.
  std::optional<Crossing> first_crossing(const Vec3& from, const Vec3& to) const;

 private:
  void add(const Vec3& a, const Vec3& b, const Vec3& c, const Ball& ball);

  double edge_limit_m_;
  std::size_t count_ = 0;
  Buffer<Triangle> triangles_;
  // Index in the list + 1 of each point in a window of the frame; 0: none.
  Buffer<std::uint32_t> index_plus_one_;
};

// The position nearest to a goal on the free side of a few planes: the minimisation of C. Zilles and K.
// Salisbury, "A constraint-based god-object method for haptic display", IROS 1995. They solve it by Lagrange
// multipliers for one, two or three active planes. Here all choices of up to three planes are tried, because
// no more than three are needed to hold a point in space. The result is the nearest position that obeys every
// plane.
class PlaneConstraints {
 public:
  // slack_m: allowed violation of a plane, for rounding.
  explicit PlaneConstraints(double slack_m) : slack_m_(slack_m) {}

  static constexpr std::size_t kMaxCount = 8;

  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  // Adds the constraint n . y >= n . point + offset_m for a unit normal n. Returns false if there are
  // kMaxCount planes already.
  bool add(const Vec3& normal, const Vec3& point, double offset_m);

  struct Nearest {
    bool found = false;  // true: a position obeys all planes
    Vec3 position = Vec3::Zero();
    int active_planes = 0;  // number of planes that hold it, 0 to 3
  };
  Nearest nearest(const Vec3& goal) const;

 private:
  struct Plane {
    Vec3 normal, point;
    double offset_m;
  };
  std::array<Plane, kMaxCount> planes_;
  std::size_t count_ = 0;
  double slack_m_;
};

struct GodObjectParameters {
  double max_edge_length_m = 0.02;
  double surface_offset_m = 1e-5;
  double stiffness_N_per_m = 600;
  int steps_per_tick = 60;
};

Parameters parameters(GodObjectParameters& p);
std::string validate(const GodObjectParameters& p);
inline RenderedContact rendered_contact(const GodObjectParameters& p) {
  return {p.surface_offset_m};
}

class GodObjectRenderer final : public RivalOf<GodObjectParameters> {
 public:
  // haptic_rate_hz has no effect: the method does not depend on time.
  GodObjectRenderer(const GodObjectParameters& parameters, double haptic_rate_hz, const Kernels& kernels);
  void reserve(std::size_t points) override;

 private:
  bool set_points(const NeighbourSearch& points) override;
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  void update_mesh();
  bool follow(const Vec3& hip_W);
  bool go(const Vec3& goal);
  void report(const Vec3& hip_W, RenderOutput& out);

  GridMesh mesh_;
  Vec3 meshed_W_ = Vec3::Zero();  // centre of the ball in which mesh_ is valid, if is_meshed_
  bool is_meshed_ = false;
  int columns_ = 0;  // number of columns of the newest frame
  PlaneConstraints planes_;
  int active_planes_ = 0, rounds_ = 0;  // values of this tick
};

}  // namespace remote_touch
