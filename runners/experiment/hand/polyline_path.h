// A path of straight pieces, each with its own speed.
#pragma once

#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

class PolylinePath {
 public:
  // Starts at a point, at time 0.
  explicit PolylinePath(const Vec3& start) : points_{start}, arrival_s_{0} {}
  // Continues to p at that speed; speed 0 jumps there at once.
  void go_to(const Vec3& p, double speed_m_per_s);
  // Stays for that time.
  void wait(double duration_s);

  Vec3 at(double time_s) const;  // the end point after the end
  double duration_s() const { return arrival_s_.back(); }
  const Vec3& end() const { return points_.back(); }

 private:
  std::vector<Vec3> points_;
  std::vector<double> arrival_s_;
};

}  // namespace remote_touch
