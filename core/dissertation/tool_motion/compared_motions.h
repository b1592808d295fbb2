// Motions of a tool by other authors, for comparison: a god-object with six degrees of freedom, and penalty
// methods.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/mesh/voxel_tool.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"

namespace remote_touch {

// The god-object with six degrees of freedom, after M. Ortega, S. Redon and S. Coquillart, "A
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

// The points of a frame as voxels: the voxmap of McNeely, Puterbaugh and Troy 1999, for a scene of which only
// points are known. A voxel with a point in it is a surface voxel. All others are free, because points do not
// show what is behind them.
class Voxmap {
 public:
  // Voxel (i, j, k) spans voxel_m (i .. i + 1, j .. j + 1, k .. k + 1) of the world. Points that are not
  // finite, or more than 2^20 voxels from the origin along an axis, are left out. Allocates.
  Voxmap(const PointCloud& cloud, double voxel_m);

  double voxel_m() const { return voxel_m_; }
  // Returns the middle of the surface voxel that holds a position; none if its voxel is free. Does not
  // allocate.
  std::optional<Vec3> surface_middle_W(const Vec3& p_W) const;

 private:
  std::optional<std::uint64_t> key_of(const Vec3& p_W) const;
  std::size_t slot_of(std::uint64_t key) const;

  double voxel_m_;
  std::vector<std::uint64_t> slots_;  // open addressing: keys, or kFree; a power of two, half or more free
};

// Penalty methods for comparison: points push the tool, and no constraint limits its motion. Each of N points
// that touch pushes with the force
//
//   f_i = k_p d_i n_i at r_i,
//
// where r_i is the point, d_i its depth and n_i a normal. If N > 10, all f_i are multiplied by 10 / N, as in
// the source. The virtual coupling (6.9) pulls the tool to the device. Each step moves the tool towards the
// pose at which the wrench of the points and the wrench of the coupling balance, linearised at the present
// pose, by half a voxel at most. There are two force laws:
//
// Voxmap and pointshell (`voxmap`): W. McNeely, K. Puterbaugh and J. Troy, "Six degree-of-freedom haptic
// rendering using voxel sampling", SIGGRAPH 1999. The tool consists of points with normals into it
// (voxel_tool.h). The scene consists of voxels (Voxmap), which prepare() makes from each frame. The depth
// of a tool point in a surface voxel is its depth below the tangent plane: the plane through the middle of
// the voxel, perpendicular to the normal of the point.
//
// Distance field (`distance-field`): J. Barbic and D. James, "Six-DoF haptic rendering of contact between
// geometrically complex reduced deformable models", IEEE Transactions on Haptics 2008, compute the depth from
// a distance field. Here the roles are exchanged: the field belongs to the tool, and the points to the cloud.
// n_i is the normal of the cloud; if there is none, it is the direction in which the tool leaves the point
// soonest.
//
// Differences from the sources. The tool has no mass, but rests where the wrenches balance, as in M. Wan and
// W. McNeely, "Quasi-static approximation for 6 degrees-of-freedom haptic rendering", IEEE Visualization
// 2003. So there is no velocity that the proximity layers of the 1999 paper could brake before contact.
// Instead, no step is longer than half a voxel, so that points do not jump over a layer of voxels. The points
// of the pointshell lie on the surface and not in the middle of voxels. A cloud has no interior voxels.
//
// Known limits, which the comparison should show. The depth of the points in the tool is proportional to the
// force. The tool passes through points that are deeper in it than its middle, or, with a voxmap, through a
// layer of voxels that yields. If walls are close together, the points of all walls push at once. The surface
// of a voxmap is where the middles of its voxels are: up to half a voxel beside its points, and in steps if
// it is not parallel to an axis.

enum class PenaltyLaw { distance_field, voxmap };

struct ToolPenaltyParameters {
  PenaltyLaw force_law = PenaltyLaw::distance_field;
  double voxmap_voxel_m = 0.003;
  double point_stiffness_N_per_m = 2400;  // k_p
  int steps_per_tick = 200;
  double rest_threshold_m = 1e-6;
  EvenCoupling coupling;
};

Parameters parameters(ToolPenaltyParameters& p);
inline std::string validate(const ToolPenaltyParameters&) {
  return {};
}
// Returns the settings that ToolRenderer reads: the spring, its limits, and how contacts are counted.
ToolParameters tool_parameters(const ToolPenaltyParameters& p);

// The part that both force laws share.
class PenaltyMotion : public ToolMotion {
 public:
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) final;

 protected:
  // max_step_m: maximum displacement of any point of the tool in a step.
  PenaltyMotion(const ToolPenaltyParameters& parameters, const VoxelTool& tool, double max_step_m)
      : p_(parameters), reach_m_(tool.reach_m), max_step_m_(max_step_m) {}

  // Effect of the points on the tool: in tool axes, about its centre of mass.
  struct Push {
    int points = 0;
    Vector6 wrench_T = Vector6::Zero();  // N, N m
    Eigen::Matrix<double, 6, 6> stiffness_T =
        decltype(stiffness_T)::Zero();  // decrease of the wrench per displacement of the tool

    // Adds a point at r_T, depth_m deep along the unit vector n_T, that pushes with k_p.
    void add(const Vec3& r_T, const Vec3& n_T, double depth_m, double k_p_N_per_m);
  };
  virtual Push push(const ToolPose& pose, const ContactList& contacts) const = 0;

  const ToolPenaltyParameters p_;
  const double reach_m_;

 private:
  Vector6 balancing_step(const ToolPose& pose, const ToolPose& device, const Push& push) const;

  const double max_step_m_;
};

class FieldPenalty final : public PenaltyMotion {
 public:
  FieldPenalty(const ToolPenaltyParameters& parameters, const VoxelTool& tool)
      : PenaltyMotion(parameters, tool, 0.5 * tool.grid.size_m) {}

 private:
  Push push(const ToolPose& pose, const ContactList& contacts) const override;
};

class VoxmapPenalty final : public PenaltyMotion {
 public:
  VoxmapPenalty(const ToolPenaltyParameters& parameters, const VoxelTool& tool)
      : PenaltyMotion(parameters, tool, 0.5 * parameters.voxmap_voxel_m),
        shell_(make_pointshell(tool, parameters.voxmap_voxel_m)) {}
  std::shared_ptr<const FramePreparation> prepared(const PointCloud& cloud) const override;
  void on_frame(const std::shared_ptr<const FramePreparation>& prepared) override;

 private:
  Push push(const ToolPose& pose, const ContactList& contacts) const override;

  const Pointshell shell_;
  std::shared_ptr<const Voxmap> map_;  // voxmap of the newest frame
};

// The tool has to outlive the result.
std::unique_ptr<ToolMotion> make_penalty_motion(const ToolPenaltyParameters& parameters,
                                                const VoxelTool& tool);

}  // namespace remote_touch
