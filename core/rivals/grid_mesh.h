// The triangle mesh between neighbouring points of an organised frame, near a position. Four neighbours in
// two rows and columns form two triangles, divided from the upper right to the lower left. If one of the four
// was not measured, the other three form one triangle. A triangle with an edge longer than a limit is left
// out, because it would bridge a depth edge, or join two sheets that are stored in consecutive rows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/geometry/vector.h"
#include "core/search/gathered_points.h"

namespace remote_touch {

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

}  // namespace remote_touch
