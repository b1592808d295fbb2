// The patches of tracked sheets around a tool: the positions on the tool that they follow, and the motion
// with which their surfaces carry the tool.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/beyond/tracked_surface/sheet_tracker.h"
#include "core/dissertation/tool_motion/motion_program.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/dissertation/tool_motion/touch_finder.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/vector.h"

namespace remote_touch {

// Positions on the surface of a tool, in a few groups. Each group is small enough for one patch of a tracked
// sheet. The positions are in the tool frame. Nothing is allocated after construction.
class ToolPositions {
 public:
  struct Group {
    Vec3 middle_T = Vec3::Zero();
    double radius_m = 0;  // distance of its farthest position from the middle
    std::size_t first = 0, count = 0;
  };

  // Selects at most kMax positions on the surface of the mesh, spread evenly: each one is the farthest from
  // those before it. It stops when every sampled position of the surface is within group_radius_m / 8 of a
  // selected one. Then it divides them into the smallest number of groups with radii up to group_radius_m,
  // but at most max_groups groups.
  static constexpr std::size_t kMax = 256;
  ToolPositions(const TriangleMesh& mesh, double group_radius_m, std::size_t max_groups);

  std::span<const Vec3> all() const { return positions_T_; }
  std::span<const Group> groups() const { return groups_; }
  std::span<const Vec3> of(const Group& group) const { return all().subspan(group.first, group.count); }

 private:
  void divide(std::size_t groups);

  std::vector<Vec3> positions_T_;  // group by group
  std::vector<Group> groups_;
};

// A position where a surface holds the tool, and the motion of the surface there along its unit normal.
struct CarriedPosition {
  Vec3 p_W, normal_W;
  double moved_m = 0, error_m = 0;  // error_m: standard error of moved_m
  double weight = 1;
};

// Estimate of the motion of a tool that surfaces carry, each of which is measured along its normal only:
// least squares over positions p_k for a displacement t of their weighted mean c and a rotation vector w
// about it: n_k . (t + w x (p_k - c)) = d_k. The motion is zero in directions that the positions do not
// determine. These are the directions in the space of (t, lever w) in which the mean square of the rows is
// below kObservable. So a single position gives a displacement along its normal, a row of positions adds a
// rotation about one axis, and a face adds rotations about two. Displacement within a face and rotation about
// its normal remain zero. Positions are summed in the order of add(). Allocates nothing.
class CarriedMotion {
 public:
  // lever_m: a rotation counts as the displacement that it causes at this distance from the mean.
  explicit CarriedMotion(double lever_m) : lever_m_(lever_m) {}
  static constexpr double kObservable = 0.1;
  void clear() { *this = CarriedMotion(lever_m_); }
  void add(const CarriedPosition& position);
  bool empty() const { return !(weight_ > 0); }

  struct Result {
    Vector6 motion = Vector6::Zero();  // (displacement, rotation vector) of the body in m and rad, world axes
    Vector6 shrunk = Vector6::Zero();  // the same: `expected` plus the change that noise does not explain
    bool known = false;
  };
  // Returns the motion as that of a body whose centre is at about_W. expected: predicted motion of the same
  // body. known is false if there are no positions.
  Result about(const Vec3& about_W, const Vector6& expected = Vector6::Zero()) const;

 private:
  double lever_m_;
  double weight_ = 0, error_m_ = 0;
  Vec3 first_W_ = Vec3::Zero(), sum_m_ = Vec3::Zero();  // sums are relative to the first position
  Eigen::Matrix<double, 6, 6> rows_ = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6 right_ = Vector6::Zero();
};

// The contact of the tool when a frame arrives.
struct ToolHold {
  ToolPose pose;
  bool held = false;                      // points push the tool
  std::span<const ToolContact> contacts;  // contacts near the tool, with the points of the previous frame
};

// Each group of positions on the tool has one patch. The proxy of the patch is over the middle of the group,
// a contact radius above the lowest position of the group. The other patches are for contacts that none of
// these explains, such as a wall beside a tool on a floor. Another patch begins at its contact and ends when
// the tool has left it.
class SheetPatches final : public PointChange {
 public:
  // unit_m: the contact radius of the trackers, which is their unit of length.
  SheetPatches(const SheetSettings& settings, double unit_m, std::size_t max_patches, const VoxelTool& tool,
               const Kernels& kernels);
  void reserve(std::size_t points);

  // Keeps a frame for requery() while the tool has no position yet.
  void keep(const std::shared_ptr<const NeighbourSearch>& frame, double captured_s);
  struct Update {
    bool missing = false;  // a surface that holds the tool is not seen, but not yet dropped
    ToolSurfaceMotion motion;
  };
  // Processes a new frame. Allocates nothing if reserve() was called for its size.
  Update on_frame(const std::shared_ptr<const NeighbourSearch>& frame, const ToolHold& hold,
                  double captured_s);
  // Returns true if the tool has moved too far from the position of the last query.
  bool must_requery(const ToolPose& pose) const;
  // Updates the sheets around the tool from the points of the newest frame. A missing sheet is dropped, and
  // its patch searches for a new one. Returns the displacement that moves the tool out of the sheets.
  Vector6 requery(const ToolPose& pose, bool held);

  // Returns true if points are shown at other positions than the measured ones.
  bool changes_points() const;
  // Returns the radius around the tool's centre of mass within which points must be shown until the next
  // requery.
  double shown_radius_m() const { return shown_radius_m_; }
  bool concerns(const BoundingSphere& sphere) const override;
  bool apply(Point& point) const override;

  // Access for tests and for pages that show the patches.
  std::size_t size() const { return patches_.size(); }
  bool tracks(std::size_t patch) const { return patches_[patch].in_use && patches_[patch].tracker->tracks(); }
  const SheetTracker& tracker(std::size_t patch) const { return *patches_[patch].tracker; }

 private:
  struct Patch {
    std::unique_ptr<SheetTracker> tracker;
    std::span<const Vec3> positions_T;
    Vec3 middle_T = Vec3::Zero();
    double reach_m = 0;     // distance that the tool may move until the next query
    bool of_group = false;  // true: the patch of a group; false: of a contact
    bool in_use = false;
    Vec3 normal_W = Vec3::Zero();           // normal of that contact
    int contacts = 0;                       // number of contacts that it explains
    bool missing = false;                   // the sheet was not seen in the newest frame
    double captured_s = 0, interval_s = 0;  // time of the newest frame that shows it; interval before it
    Vec3 queried_W = Vec3::Zero();
  };
  struct Lowest {
    bool found = false;
    double clearance = 0;  // height above the sheet, units
    // The mean of the positions that are nearly as low. It is the lowest position itself if the sheet is not
    // seen below the mean, for example over a hole.
    Vec3 p_W = Vec3::Zero();
  };
  bool explains(const Patch& patch, const Vec3& p_W, const Vec3& n_W) const;
  Lowest lowest(const Patch& patch, const ToolPose& pose) const;
  ProxyPosition proxy_position(const Patch& patch, const ToolPose& pose, bool held) const;
  static bool holds(const Patch& patch, bool held) { return held && patch.contacts > 0; }
  int patch_of(const ToolHold& hold, const ToolContact& contact) const;
  void count_contacts(const ToolHold& hold);
  void count_unexplained(const ToolHold& hold);
  void follow(Patch& patch, const std::shared_ptr<const NeighbourSearch>& frame, const ToolHold& hold,
              double captured_s);
  bool is_face(const SheetTracker& tracker, double sigma) const;
  void start_patch(const std::shared_ptr<const NeighbourSearch>& frame, double captured_s);
  ToolSurfaceMotion carried(const ToolHold& hold);
  Vec3 out_of_swept(const Patch& patch, const ToolPose& now, const ToolPose& before) const;
  void note_query(Patch& patch, const ToolPose& pose) const;

  const double unit_m_;
  const ToolPositions positions_;
  std::vector<Patch> patches_;
  double shown_radius_m_ = 0;
  Vector6 rate_per_s_ = Vector6::Zero();  // rate of a held tool at the previous frame
  // The deepest contact that no patch explains, and the number of contacts with its direction. Another patch
  // begins there.
  struct {
    int alike = 0;
    Vec3 p_W = Vec3::Zero(), n_W = Vec3::Zero();
    double depth_m = 0;
  } unexplained_;
  std::vector<int> patch_of_ = std::vector<int>(MotionProgram::kMaxContacts);  // per contact; -1: none
};

}  // namespace remote_touch
