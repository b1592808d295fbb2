// A volumetric penalty method for comparison: a tool filled with inner spheres is pushed out of the points of
// a frame. Force and torque are proportional to the penetration volume (SpherePenetration). R. Weller and
// G. Zachmann, "A unified approach for physically-based simulations and haptic rendering", ACM SIGGRAPH
// Symposium on Video Games 2009, introduced them for two bodies of inner spheres; M. Kaluschke, R. Weller, G.
// Zachmann and others, World Haptics 2017, for one body and the point cloud of a depth camera.
//
//   f_i = k_V V_i n_i at x_i,
//
// where V_i is the volume of sphere i in the scene, n_i is the normal of the scene there, and x_i is the
// centroid of that part. The virtual coupling (6.9) pulls the tool to the device. Each step moves the tool
// towards the pose at which the wrench of the spheres and the wrench of the coupling balance, linearised at
// the present pose, by half a voxel at most, and by less and less if steps turn back.
//
// Not from the sources: the coupling and the steps. But for the shorter steps they are those of the penalty
// methods (compared_motions.h), so that the methods differ in the force of the points only.
//
// Known limits, which the comparison should show. The force grows with the square of the depth at first, so
// the surface feels soft. The part of the tool behind the surface is inside, however thin the object is. So a
// tool that touches a surface from its back is pushed through it to the side of the sensor. A tool that is
// entirely behind the points feels nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/dissertation/tool_motion/touch_finder.h"
#include "core/mesh/voxel_tool.h"
#include "core/parameters/parameter.h"
#include "core/rivals/point_normals.h"

namespace remote_touch {

// Fills a tool with inner spheres: spheres inside its mesh that do not overlap. R. Weller and G. Zachmann,
// "Inner sphere trees for proximity and penetration queries", Robotics: Science and Systems 2009, describe
// them as a greedy packing on a discrete distance field. The same authors' "ProtoSphere: A GPU-assisted
// prototype guided sphere packing algorithm for arbitrary objects" (2010) moves the centre of each next
// sphere, the prototype, away from the nearest obstacle (the surface, or a sphere that was packed before),
// with steps that become shorter.
//
// Ours: the prototype starts at the node of the tool's grid around which the largest sphere fits, because
// the source's start in every cell of a grid needs a GPU. The radius is exact: the distance to the nearest
// triangle, or to the nearest earlier sphere.
//
// Beyond the source, a tool that equals its mirror image in a coordinate plane has a packing that does, too:
// a sphere is packed with its images, or lies on the plane if they would overlap. Only the last sphere may
// lack images. Without this rule a symmetric tool on a plane would feel a torque that comes from its packing
// only.

// The spheres are in the tool frame, the largest ones first (nearly: a prototype can find more room than its
// node has). No two overlap, and none leaves the mesh, but for 1e-9 m of rounding.
struct InnerSpheres {
  std::vector<Sphere> spheres;
  double coverage = 0;  // volume of the spheres divided by that of the tool, 0 to 1
  // The neighbours of sphere i are neighbour[first_neighbour[i]] .. neighbour[first_neighbour[i + 1] - 1], in
  // rising order. Spheres are neighbours if the gap between them is a voxel or less. The gaps of the spanning
  // tree with the smallest sum of gaps are added, so that every sphere can be reached from every other one.
  std::vector<std::uint32_t> first_neighbour, neighbour;

  std::span<const std::uint32_t> neighbours(std::uint32_t i) const {
    return {neighbour.data() + first_neighbour[i], neighbour.data() + first_neighbour[i + 1]};
  }
};
std::string text(const InnerSpheres& made);

inline constexpr int kMaxInnerSpheres = 5000;

// Packs at most max_spheres spheres. It ends earlier if no node of the grid has room for a sphere of 0.9
// voxels; about half a million nodes are tried at most, in a larger tool only some of its nodes. The result
// is the same on every x86-64. pre: 1 <= max_spheres <= kMaxInnerSpheres, and the tool was made without
// outer_field. Throws InputError if there is no room for one sphere.
InnerSpheres make_inner_spheres(const VoxelTool& tool, int max_spheres);

// Finds the sphere that contains a position, among spheres that do not overlap.
class SphereLocator {
 public:
  // Sorts the spheres into the cells of a grid around them: 96 along its longest side. Keeps the spheres by
  // reference. pre: at least one sphere, all finite and with a radius above 0.
  explicit SphereLocator(std::span<const Sphere> spheres);

  // Returns the number of the sphere whose centre is nearer to p than its radius; the lowest number if
  // rounding makes two spheres overlap. p is in the frame of the spheres and may be NaN. Does not allocate.
  std::optional<std::uint32_t> at(const Vec3& p) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vec3& p) const;
  std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * cells_[1] + j) * cells_[0] + i);
  }
  template <class Act>
  void for_cells_of(const Sphere& sphere, const Act& act) const;

  std::span<const Sphere> spheres_;
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
  double cell_m_ = 1;
  Cell cells_{1, 1, 1};
  std::vector<std::uint32_t> first_;   // first entry of each cell in number_; one more at the end
  std::vector<std::uint32_t> number_;  // spheres that reach into each cell, in rising order
};

// The penetration volume of a tool of inner spheres in the points of a frame, and the wrench that it causes.
// M. Kaluschke, R. Weller, G. Zachmann and others, "A volumetric penetration measure for 6-DOF haptic
// rendering of streaming point clouds", World Haptics 2017. The source finds the spheres that collide with
// points, decides which other spheres are inside the penetrated cloud, along a graph of neighbouring spheres,
// and computes force and torque from the normals of the points and from the volume of each sphere. Only a
// summary of it was available, so the following equations are this project's.
//
// Sphere i with centre c and radius r collides if it contains points. Point j, with normal n_j, means that
// the scene fills the half-space n_j . (x - p_j) < 0. The part of the sphere in it is a cap, and the points
// share the sphere by weights:
//
//   h_j = r - n_j . (c - p_j),   V(h) = pi h^2 (3 r - h) / 3,   w_j = 1 - |p_j - c|^2 / r^2,
//   V_i = sum w_j V(h_j) / sum w_j,   f_i = k_V sum w_j V(h_j) n_j / sum w_j,
//
// where h is the height of the cap, and k_V the stiffness. If all points lie in one plane, V_i is the volume
// of the sphere behind it. Walls on both sides of a sphere push against each other. A point on the sphere has
// no weight, so it enters and leaves without a jump. The force acts at the centroid of each cap, which lies
// below the centre along n_j, so the torque is that of a force at the centre. A point without a normal has
// the direction in which the tool leaves the point soonest.
//
// The neighbours of a colliding sphere, and the neighbours of these, take over its plane if they do not
// collide themselves, reach behind the plane, and fulfil two conditions. They keep the inside from spreading
// to the side, where the tool reaches beyond the edge of a surface.
// - The radius of the cut is at most the spacing of the cloud there. A larger cut without points shows that
//   there is no surface.
// - t - r_k <= r + max(0, depth of the centre behind the plane), where t is the distance between the centres
//   of the two spheres beside each other, in the plane, and r_k is the radius of the colliding sphere.
// A sphere takes the plane with the smallest t - r_k.
//
// The result does not depend on the order of the points: the sums over points are exact (point_normals.h),
// and spheres are visited in an order of their own.

// The part of a ball on one side of a plane.
struct BallCap {
  double volume_m3;
  double disk_m2;  // area of the cut
};
// Returns the part behind a plane; height_m: height of the ball's centre in front of it, negative behind it.
BallCap cap_behind(double radius_m, double height_m);

// The effect of all spheres, in tool axes, about the origin of the tool. The wrench and its slope have to be
// multiplied by the stiffness, N/m^3.
struct SpherePenetration {
  int spheres = 0;                     // number of spheres of which a part is in the scene
  double volume_m3 = 0;                // sum of V_i
  Vector6 wrench_T = Vector6::Zero();  // sum of f_i / k_V and c cross f_i / k_V
  // Decrease of the wrench per displacement of the tool, if the half-spaces stay: the areas of the cuts times
  // l l^T, where l = (n, c cross n), in the same weighted means and sums.
  Eigen::Matrix<double, 6, 6> slope_T = decltype(slope_T)::Zero();
};

class PenetrationQuery {
 public:
  explicit PenetrationQuery(std::shared_ptr<const InnerSpheres> spheres);

  // Returns the penetration at a pose. finder: that of the tool from which the spheres were made. Does not
  // allocate.
  SpherePenetration penetration(const ToolPose& pose, const TouchFinder& finder);

 private:
  // The sums over the points in a sphere. Volumes are divided by that of the sphere, and areas by that of its
  // largest cut, so that no term is larger than 1.
  struct PointSums {
    explicit PointSums(double grid)
        : weight(grid), volume(grid), offset(grid), normal(grid), push(grid), cut(grid) {}
    void add(const Vec3& offset_of_point, const Vec3& n_T);

    ExactSum weight, volume;     // w, w V
    ExactVector offset, normal;  // w (p - c) / r, w n
    ExactVector push;            // w V n
    ExactSquares cut;            // w A n n^T
    double spacing_m = 0;        // largest spacing of the points
  };
  // The contribution of a sphere.
  struct Effect {
    double volume_m3;
    Vec3 push_T;            // f_i / k_V
    Eigen::Matrix3d cut_T;  // A n n^T
  };
  struct Plane {
    Vec3 a_T, n_T;
    double spacing_m;      // largest spacing of its points
    std::uint32_t sphere;  // the colliding sphere that it comes from
  };

  void gather(const ToolPose& pose, const TouchFinder& finder);
  void fit_planes();
  void spread();
  double distance_beside_m(const Plane& plane, const Sphere& sphere) const;
  bool is_inside(const Plane& plane, const Sphere& sphere, double beside_m) const;
  Effect effect_of_points(std::uint32_t i) const;
  Effect effect_of_plane(std::uint32_t i) const;
  void reset();

  static constexpr std::uint32_t kNoPlane = ~std::uint32_t{0};

  const std::shared_ptr<const InnerSpheres> made_;
  const SphereLocator locator_;
  std::vector<PointSums> sums_;             // one for each sphere
  std::vector<std::uint8_t> has_points_;    // one for each sphere
  std::vector<std::uint32_t> with_points_;  // spheres that contain points
  std::vector<Plane> planes_;               // the colliding spheres
  std::vector<std::uint32_t> plane_of_;     // index of the plane of each sphere, or kNoPlane
  std::vector<double> beside_m_;            // t - r_k of each sphere that took over a plane
  std::vector<std::uint32_t> inside_;       // spheres that took over a plane
  std::vector<std::uint32_t> queue_;        // ring of the spheres whose neighbours are to be visited
  std::vector<std::uint8_t> is_queued_;
};

// The default k_V is this project's choice: a contact of 240 mm^2 is then as stiff as ten points of the
// penalty methods, 24 kN/m.
struct InnerSphereParameters {
  int inner_spheres = 1000;                // largest number of spheres
  double volume_stiffness_N_per_m3 = 1e8;  // k_V
  int steps_per_tick = 200;
  double rest_threshold_m = 1e-6;
  EvenCoupling coupling;
};

Parameters parameters(InnerSphereParameters& p);
inline std::string validate(const InnerSphereParameters&) {
  return {};
}
// Returns the settings that ToolRenderer reads: the spring, its limits, and how contacts are counted.
ToolParameters tool_parameters(const InnerSphereParameters& p);

class InnerSphereMotion final : public ToolMotion {
 public:
  // Packs the spheres, which takes long for a large tool. tool: made without outer_field. Throws InputError
  // as make_inner_spheres() does.
  InnerSphereMotion(const InnerSphereParameters& parameters, const VoxelTool& tool);
  // The same with spheres that were made before.
  InnerSphereMotion(const InnerSphereParameters& parameters, const VoxelTool& tool,
                    std::shared_ptr<const InnerSpheres> spheres);

  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) override;

 private:
  Vector6 balancing_step(const ToolPose& pose, const ToolPose& device, const SpherePenetration& in) const;
  bool turns_back(const Vector6& step, const Vector6& trend) const;

  const InnerSphereParameters p_;
  const double reach_m_, max_step_m_;
  PenetrationQuery query_;
};

}  // namespace remote_touch
