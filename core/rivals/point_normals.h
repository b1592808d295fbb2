// A normal for each point of a frame: the axis along which its nearest neighbours are thinnest (principal
// component analysis), turned towards the sensor. A normal is computed at its first use and kept until the
// next frame.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/vector.h"
#include "core/rivals/nearest_points.h"

namespace remote_touch {

// The sensor: its position, or only its viewing direction if it is far away.
struct ViewPoint {
  bool has_position = false;
  Vec3 position_W = Vec3::Zero();
  Vec3 direction_W{0, -1, 0};

  // Vector from the sensor to p; not of unit length.
  Vec3 ray_to(const Vec3& p_W) const { return has_position ? Vec3(p_W - position_W) : direction_W; }
};

// Returns the camera position of a stored frame with an image, else the direction.
ViewPoint view_point(const NeighbourSearch& points, const Vec3& direction_W);

class PointNormals {
 public:
  // neighbours: number of points of a plane fit, the point itself included; 3 or more.
  PointNormals(int neighbours, const Kernels& kernels) : neighbours_(neighbours), nearest_(kernels) {}

  void reserve(std::size_t points);
  // Starts a new frame. Allocates only for a frame larger than reserved. pre: the points live until the next
  // call.
  void set_points(const NeighbourSearch& points, const ViewPoint& view);
  // Returns the unit normal of the point with that index in the frame; zero if its neighbours span no plane.
  // The order of the points has no effect. Allocates nothing.
  Vec3 of(std::uint32_t number, const Vec3& x_W);
  NearestPoints& nearest() { return nearest_; }

 private:
  Vec3 compute(const Vec3& x_W);

  const int neighbours_;
  NearestPoints nearest_;
  const NeighbourSearch* points_ = nullptr;
  ViewPoint view_;
  std::uint32_t frame_ = 0;  // number of calls of set_points()
  std::vector<Vec3> normals_;
  std::vector<std::uint32_t> computed_in_;  // value of frame_ when the normal was computed
};

}  // namespace remote_touch
