// The points of a cloud for the continuous rule. near() returns the contacts of the look-ahead rule, kept a
// small gap away. clear_fraction() returns the part of a motion that is possible before the first point
// enters the tool. Not in the dissertation.
#pragma once

#include <vector>

#include "core/dissertation/tool/contact/clear_way.h"
#include "core/dissertation/tool/contact/contact_list.h"

namespace remote_touch {

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
