// How far a tool may move until the first point of a cloud would get into it: conservative advancement of
// points through the tool's field (outer_field.h). Compare Xu and Barbic 2016. Not in the dissertation.
//
// Seen from the tool, a point moves on a curve. The field along the chord of the curve is a cubic in every
// cell; how far the curve is from its chord is bounded by its second derivative. A cubic is above what its
// Bernstein coefficients are above, so the result is certain, not sampled.
#pragma once

#include "core/tool/dynamics/tool_pose.h"
#include "core/tool/voxels/slope_blocks.h"
#include "core/tool/voxels/voxel_tool.h"

namespace remote_touch {

class ClearWay {
 public:
  // What is less than this outside counts as touched, m; what is deeper than this inside is in the tool
  // already, as a new frame can put it there, and does not stop the tool.
  static constexpr double kTouch_m = 1e-6, kInside_m = 2e-6;

  // tool: made with outer_field; it has to outlive this.
  explicit ClearWay(const VoxelTool& tool);
  // A place at which the field is look_ahead_m or more is outside after any motion by no more than this.
  double safe_motion_m(double look_ahead_m) const;

  // A motion as moved() makes it, in tool axes: the fraction s of the displacement, for s from 0 to 1.
  struct Motion {
    Motion(const ToolPose& from, const Vector6& a_g);

    Vec3 a_T;
    double shift_m, turn_rad;
    Eigen::Matrix3d turned;  // from the tool's axes before to those after it
  };
  // Points at which the field is larger than this are outside during all of a motion, if they are within
  // reach_m of the tool's origin.
  double far_m(const Motion& motion, double reach_m) const {
    return kTouch_m + max_slope_ * (motion.shift_m + motion.turn_rad * (reach_m + motion.shift_m));
  }
  // How much of a motion the tool may go so that a point which is outside stays there; 1: all. p_T,
  // distance_m: the point before the motion, and the field there.
  double fraction(const Motion& motion, const Vec3& p_T, double distance_m) const;

 private:
  struct Chord {
    Vec3 from, along;  // cells
    double bend_m;     // the field on the curve is less than on the chord by no more than bend_m s (1 - s)
    double min_m;      // as low as the field may go
  };
  double first_below(const Chord& chord) const;

  const VoxelTool& tool_;
  SlopeBlocks slopes_;
  double max_slope_;
};

}  // namespace remote_touch
