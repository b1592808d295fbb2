// The points of a cloud for the continuous rule. near() returns the contacts of the look-ahead rule, kept a
// small gap away. clear_fraction() returns the part of a motion that is possible before the first point
// enters the tool. Not in the dissertation.
#pragma once

#include <vector>

#include "core/dissertation/tool/shape/distance_field.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/tool_pose.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch {

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
