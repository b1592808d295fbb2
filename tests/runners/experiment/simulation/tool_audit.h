// Certifies, tick by tick, that no point of a cloud got into a tool on its way: conservative advancement of
// every point on the exact distance to the tool's mesh. It shares nothing with the renderers' contact rules:
// no grid, no disks, no constraints.
//
// The distance to a solid, negative inside, changes by no more than the point moves. Let it be s at the
// middle of an interval of the way, and let the point move by at most l in half of the interval. The point is
// then nowhere deeper than l - s. If that is above the tolerance, the interval is halved, until all of it is
// certified or a position is found at which the point is deeper.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/mesh/triangle_tree.h"
#include "core/points/point_cloud.h"

namespace remote_touch {

struct ToolAudit {
  std::int64_t point_ticks = 0;  // number of points times ticks
  std::int64_t inside = 0;       // number of them that begin with the point deeper than the tolerance
  std::int64_t entered = 0;      // number that begin outside and get deeper on the way: missed crossings
  double deepest_m = 0;          // greatest depth that was found among the points that entered
};

class ToolAuditor {
 public:
  // mesh: closed, in the tool frame.
  ToolAuditor(const TriangleMesh& mesh, double tolerance_m);

  // Replaces the points by those of this cloud. Points that are not finite are left out.
  void on_frame(const PointCloud& cloud);
  // Moves the points to those of this cloud, each on a line, while the tool moves from one pose to the other
  // as in tick(). pre: as many points as before, in their order.
  void tick_with_frame(const PointCloud& cloud, const ToolPose& from, const ToolPose& to);
  // Moves the tool from one pose to the other: its origin along a line, its orientation about one axis, both
  // evenly. pre: `from` is the pose at which the tick before ended, if the points are the same.
  void tick(const ToolPose& from, const ToolPose& to);

  const ToolAudit& audit() const { return audit_; }
  // Signed distance of a position in the tool frame to the tool, negative inside.
  double signed_distance_m(const Vec3& p_T);

 private:
  struct Point {
    Vec3 p_W;
    double clear_m = 0;  // lower bound of the distance to the tool; below 0: not known
    bool is_inside = false, is_known = false;
    int face = 0;  // the face that was nearest at the last query
  };
  // Neighbours in the cloud, enclosed by a ball. None of them is checked while the ball is beyond the tool's
  // reach.
  struct Group {
    Vec3 centre_W;
    double radius_m;
    std::size_t first, last;
    bool was_far;
  };
  struct Way;
  void gather_groups();
  void tick(Group& group, const ToolPose& from, const Vec3& shift_W, const Vec3& turn_W);
  void check(Point& point, const Way& way, double max_m);
  double depth_on(const Way& way, double from, double until, double max_m, int& face);
  double signed_distance_m(const Vec3& p_T, int& face) const;

  TriangleTree tree_;
  double tolerance_m_, reach_m_ = 0;
  std::vector<Point> points_;
  std::vector<Group> groups_;
  ToolAudit audit_;
};

}  // namespace remote_touch
