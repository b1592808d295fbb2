// The points of a cloud for the continuous rule: the contacts of the look-ahead rule, kept a small gap away,
// and the part of a motion that is possible before the first point gets into the tool. Not in the
// dissertation.
#pragma once

#include <vector>

#include "core/dissertation/tool/contact/clear_way.h"
#include "core/dissertation/tool/contact/contact_list.h"

namespace remote_touch {

class ContinuousContacts final : public NearContactSource {
 public:
  // Contacts hold the tool this far from the points, so that a step which is right only to first order does
  // not take a point into the tool.
  static constexpr double kGap_m = 5e-5;

  // tool: made with outer_field; it has to outlive this.
  ContinuousContacts(const ToolParameters& parameters, const VoxelTool& tool);
  // Returns the longest motion that is allowed, because points that are not near could stop a longer one.
  double max_motion_m() const { return max_motion_m_; }

  // Begins a tick with these points, and forgets which of them stopped the tool before. They have to outlive
  // it.
  void begin(ContactList& points);

  // Returns all contacts within the look-ahead, with the gap; within_m is ignored. Points that have stopped
  // the tool since begin() are contacts of their own, so that a step against one of them is not tried again.
  using NearContactSource::near;
  NearContacts near(const ToolPose& pose, double side, double within_m) override;
  // True if a point is in the tool, even if near() represents it by a disk that is not.
  bool has_points_inside(const ToolPose& pose) const;
  double clear_fraction(const ToolPose& pose, const Vector6& a_g) override;
  // Returns the clear fraction of a motion away from a surface after a frame that can have put points
  // anywhere. Only points with a normal that faces the tool from ahead stop it. If such a point is in the
  // tool, as between walls that have closed, the fraction is 0. side: side of the surface, as in near(). pre:
  // the motion is a translation.
  double fraction_ahead(const ToolPose& pose, const Vector6& a_g, double side) const;

 private:
  void add_stop(const Vec3& p_W);
  void add_stops(const ToolPose& pose);
  double known_fraction(const Vector6& a_g) const;

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
