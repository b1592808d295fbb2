// The contacts of a pose for the contact rules, from the points that TouchFinder detects; for the continuous
// rule also the part of a motion that is possible before the first point enters the tool.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/dissertation/tool_motion/motion_program.h"
#include "core/dissertation/tool_motion/near_points.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/touch_finder.h"
#include "core/kernels/tool_kernels.h"
#include "core/mesh/distance_field.h"
#include "core/mesh/voxel_tool.h"

namespace remote_touch {

// The contacts that the look-ahead rule needs from a scene: everything that the tool could touch soon.
struct NearContacts {
  std::span<const ToolContact> contacts;
  double deepest_m = 0;  // largest depth, negative if nothing is touched; -infinity: nothing was found
  // Every contact within this distance is listed, unless it was left out because there were too many;
  // infinity: every contact within the look-ahead.
  double within_m = std::numeric_limits<double>::infinity();
};

// The interface between the look-ahead rule and the source of contacts: the points of a surface, or regions.
class NearContactSource {
 public:
  virtual ~NearContactSource() = default;
  // Returns the contacts of a pose within within_m. It may return more, but none beyond the look-ahead, and
  // no more than MotionProgram::kMaxContacts. side: +1 or -1, the side of the surface that the tool was on
  // before a frame put points into it; 0: not known. Valid until the next call.
  virtual NearContacts near(const ToolPose& pose, double side, double within_m) = 0;
  // Returns all contacts within the look-ahead.
  NearContacts near(const ToolPose& pose, double side) {
    return near(pose, side, std::numeric_limits<double>::infinity());
  }
  // Returns the fraction of a motion from this pose that the tool may make. A source that cannot check this
  // returns 1.
  virtual double clear_fraction(const ToolPose&, const Vector6&) { return 1; }
};

// The result of a detection for the printed rule.
struct VoxelContacts {
  // The contacts of (6.5) with depth 0. If there are collisions, these are listed instead: (6.8) with depth
  // 1.
  std::span<const ToolContact> contacts;
  bool touched = false, collided = false;  // a point with a normal is in the tool; one is in its interior
};

// Lists are valid until the next call. If there are more contacts than MotionProgram::kMaxContacts, they are
// thinned.
class ContactList final : public NearContactSource {
 public:
  ContactList(std::shared_ptr<const VoxelTool> tool, const ToolParameters& parameters,
              const Kernels& kernels);

  void on_frame(std::shared_ptr<const TiledCloud> cloud);  // allocates unless reserved
  void reserve(std::size_t padded_size);                   // reserves memory for clouds of this size
  const TouchFinder& finder() const { return finder_; }
  const NearDisks& near_disks() const { return disks_; }  // disks of the last near()
  // Returns true if a single point, none merged, has a field value below value_m, which is 0 or less. Only
  // for ContactRule::continuous.
  bool has_point_below(const ToolPose& pose, double value_m);
  // Returns every single point, none merged, with a field value of at most way.far, apart from some that
  // cannot stop the motion, as NearPoints does. No point is returned whose field value is above look_ahead_m
  // plus the radius of the largest disk, or beyond the reach of the field. Only for ContactRule::continuous.
  // Valid until the next call.
  const NearPoints& points_on_way(const ToolPose& pose, SlabWay way);

  // Returns the contacts of all disks that are within within_m of the tool, or within NearDisks::kSearch_m if
  // that is more. Disks beyond look_ahead_m or beyond the reach of the field are left out. side: as for
  // near_contact().
  using NearContactSource::near;
  NearContacts near(const ToolPose& pose, double side, double within_m) override;
  // Returns the contacts of the points in shell and interior voxels, except those without a normal.
  VoxelContacts in_voxels(const ToolPose& pose);
  // Counts the points in shell or interior voxels. Unless the rule is voxels, also counts the points whose
  // disk touches the tool.
  Touched touched(const ToolPose& pose);

 private:
  double max_single_m() const;
  void append_contacts(double side);
  void gather_cells();
  void gather_deepest(double side);
  std::span<const ToolContact> thinned(std::vector<ToolContact>& contacts);

  const ToolParameters p_;
  const Kernels& kernels_;
  TouchFinder finder_;
  NearDisks disks_;  // disks of the points, or of fewer points that represent all
  NearPoints points_;
  TouchedPoints touched_;
  double max_disk_m_ = 0, max_near_disk_m_ = 0;
  ContactThinning thinning_;
  std::vector<ToolContact> contacts_, collisions_;
  std::vector<std::uint32_t> cells_;  // cell of each near disk
  struct Nearest {
    double bound_m;
    std::uint32_t disk;
  };
  std::vector<Nearest> nearest_;       // nearest disk of each cell, by bound
  std::vector<std::uint32_t> chosen_;  // numbers of disks
};

// Computes the part of a motion that a tool may make before the first point of a cloud enters it, by
// conservative advancement of points through the tool's field (distance_field.h). Compare Xu and Barbic 2016.
// Not in the dissertation.
//
// A point moves on a curve in the tool frame. The second derivative of the curve bounds its distance from its
// chord. The field along the chord is a cubic in every cell. A cubic is nowhere below the smallest of its
// Bernstein coefficients, so the result is certain and does not depend on samples.
class ClearWay {
 public:
  // A point less than kTouch_m outside the tool counts as touched, m. A point deeper than kInside_m in the
  // tool was put there by a new frame, and does not stop the tool.
  static constexpr double kTouch_m = 1e-6, kInside_m = 2e-6;

  // tool: made with outer_field; it has to outlive this.
  explicit ClearWay(const VoxelTool& tool);
  // Returns a length of motion, m. A position with a field value of look_ahead_m or more stays outside the
  // tool in every motion up to this length.
  double safe_motion_m(double look_ahead_m) const;

  // The motion moved(from, s a_g) for s from 0 to 1, in tool axes.
  struct Motion {
    Motion(const ToolPose& from, const Vector6& a_g);

    Vec3 a_T;
    double shift_m, turn_rad;
    Eigen::Matrix3d turned;  // rotates from the tool axes before the motion to those after it
  };
  // Returns the field value above which points stay outside during the whole motion, if they are within
  // reach_m of the tool's origin.
  double far_m(const Motion& motion, double reach_m) const {
    return kTouch_m + max_slope_ * (motion.shift_m + motion.turn_rad * (reach_m + motion.shift_m));
  }
  // Returns the fraction of a motion that the tool may make so that a point that is outside stays there; 1:
  // all of it. p_T, distance_m: the point before the motion, and the field there. A fraction above `limit` is
  // not computed exactly: the result is then any number above `limit`, or 1.
  double fraction(const Motion& motion, const Vec3& p_T, double distance_m, double limit = 1) const;
  // Returns the motion for kernels: fraction() is 1 for every point that keeps their distance `touch`. Points
  // farther than far_m before the motion do not matter.
  SlabWay slab_way(const Motion& motion, double far_m) const;

 private:
  struct Chord {
    Vec3 from, along;  // cells
    double bend_m;     // the field on the curve is at least that on the chord less bend_m s (1 - s)
    double min_m;      // lowest field value allowed
  };
  double first_below(const Chord& chord, double limit) const;

  const VoxelTool& tool_;
  SlopeBlocks slopes_;
  double max_slope_;
};

class ContinuousContacts final : public NearContactSource {
 public:
  // Contacts keep the tool this far from the points, because a step that is correct only to first order could
  // otherwise move a point into the tool.
  static constexpr double kGap_m = 5e-5;

  // tool: made with outer_field; it has to outlive this.
  ContinuousContacts(const ToolParameters& parameters, const VoxelTool& tool);
  // Returns the longest motion that is allowed. A longer one could meet points that are not near yet.
  double max_motion_m() const { return max_motion_m_; }

  // Begins a tick with these points, which have to outlive it. Forgets the points that have stopped the tool
  // before.
  void begin(ContactList& points);

  // Returns all contacts within the look-ahead, each with its depth increased by the gap; within_m is
  // ignored. Points that have stopped the tool since begin() are added as contacts of their own, so that a
  // step against one of them is not tried again.
  using NearContactSource::near;
  NearContacts near(const ToolPose& pose, double side, double within_m) override;
  // Returns true if a point is in the tool. This is checked for every point, because near() may represent
  // points by a disk that is not in the tool.
  bool has_points_inside(const ToolPose& pose) const;
  double clear_fraction(const ToolPose& pose, const Vector6& a_g) override;
  // Returns the clear fraction of a motion away from a surface, after a frame that can have put points
  // anywhere. A point stops this motion only if it has a normal that points against the motion. If such a
  // point is already in the tool, as between walls that have closed, the fraction is 0. side: side of the
  // surface, as in near(). pre: the motion is a translation.
  double fraction_ahead(const ToolPose& pose, const Vector6& a_g, double side) const;

 private:
  void add_stop(const Vec3& p_W);
  void add_stops(const ToolPose& pose);
  double known_fraction(const Vector6& a_g) const;
  const NearPoints& on_way(const ToolPose& pose, const ClearWay::Motion& motion, const Vec3& ahead_W) const;

  const VoxelTool& tool_;
  const double reach_m_;  // largest distance of a near point from the tool's centre of mass
  ClearWay way_;
  const double max_motion_m_;
  ContactList* points_ = nullptr;
  ContactThinning thinning_;
  std::vector<ToolContact> contacts_;
  std::vector<Vec3> stops_W_;
};

}  // namespace remote_touch
