// A god-object with six degrees of freedom for comparison, after M. Ortega, S. Redon and S. Coquillart, "A
// six degree-of-freedom god-object method for haptic display of rigid bodies with surface properties", IEEE
// TVCG 13(3), 2007. The tool never penetrates what it touches, and the hand feels the part of its motion that
// the contacts prevent. Each step computes
//
//   a_u = displacement from the tool to the device,
//   a_c = argmin over a of 1/2 (a - a_u)^T M (a - a_u) subject to J a >= 0,
//
// where J consists of the contacts of the present pose only (Gauss' principle; quasi-static, so there is no
// velocity). The tool moves along a_c until continuous collision detection finds the first new contact, which
// is a row of J in the next step. Steps are made until the tool is at rest, or until the budget is used up.
// Force and torque on the hand are those of the constraints at the last pose, k M (a_c - a_u). They are zero
// for the part of the motion that no contact hinders, even if the tool has not reached the device yet. If the
// tool is at rest, the contacts prevent all of the motion. They include those that stopped the last step and
// are not touched any more, because of an error of second order.
//
// The mesh of the scene. The source has two meshes at rest. Its contacts are corners against faces and edges
// against edges. Here the faces of the scene are the small disks around its points (near_points.h). A
// contact is a point against the surface of the tool, or the surface of the tool against a disk, with the
// normal of the disk. The tool never passes a point (contact_list.h); the time of contact with a disk
// is that of the linearised motion. Edges of a scene are not known, and there is nothing where the sensor saw
// nothing.
//
// The tool is kept ContinuousContacts::kGap_m away from its contacts. While no frame has put points into the
// tool, a contact at which up to twice this distance is missing is a row J a >= d, where d is the missing
// distance, so that errors of second order do not accumulate. M is that of a body of 1 kg with the gyration
// radius of the coupling about every axis, and not that of the tool, so that the spring is the same as with
// the other methods.
//
// New frames. Only the hand moves in the source. Here, points that a frame puts into the tool are contacts of
// the present pose like any others. J a >= 0 allows the tool to move out but does not push it out, and if it
// waits at the device, a_u = 0 and there is no force. So the hand does not feel a surface that moves into the
// tool until the hand moves, and the surface has passed the tool when it leaves the tool on the other side.
// The outer side of a disk in the tool is the side from which a surface was touched last, as with the
// look-ahead rule.
#pragma once

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/tool_motion.h"
#include "core/dissertation/tool_motion/tool_parameters.h"

namespace remote_touch {

struct ToolGodObjectParameters {
  int steps_per_tick = 60;
  double max_step_m = 1e-3;
  double rest_threshold_m = 1e-6;
  double disk_radius_ratio = 0.75;
  EvenCoupling coupling;
};

Parameters parameters(ToolGodObjectParameters& p);
std::string validate(const ToolGodObjectParameters& p);
// Returns the settings that ToolRenderer reads: the spring, its limits, and how contacts are counted.
ToolParameters tool_parameters(const ToolGodObjectParameters& p);

class GodObjectMotion final : public ToolMotion {
 public:
  // tool: made with outer_field; it has to outlive this.
  GodObjectMotion(const ToolGodObjectParameters& parameters, const VoxelTool& tool);
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) override;

 private:
  // Gathers the rows of J: the contacts that are touched.
  void gather_touched(const NearContacts& near);
  // Returns a_c in world axes, and reports the contacts that hold it.
  Vector6 constrained(const Vector6& a_gu, const ToolPose& pose, ToolMotionReport& report);
  // Returns the fraction of a_c up to the first new contact.
  double free_fraction(const Vector6& a_c, const ToolPose& pose, const NearContacts& near);

  const ToolGodObjectParameters p_;
  const double reach_m_, max_step_m_;
  ContinuousContacts near_;
  MotionProgram program_;
  std::vector<ToolContact> touched_;
  double side_ = 1;          // side of the surface that held the tool last: +1 is the side of the sensor
  bool settling_ = false;    // a frame came, and points are still in the tool
  bool has_failed_ = false;  // ConstrainedMotion::failed of the last program
};

}  // namespace remote_touch
