// The points near a tool as disks in its field: what near() and touched() of a contact list both need.
//
// The points are kept from one pose to the next: a few more are searched than lie within reach, and while the
// tool has moved so little that no other point can have come within reach, these are measured again.
#pragma once

#include <span>
#include <vector>

#include "core/search/gathered_points.h"
#include "core/tool/contact/disk_contact.h"
#include "core/tool/contact/touch_finder.h"

namespace remote_touch {

// Keeps the result: a query for the same pose again costs nothing.
class NearDisks {
 public:
  // What is searched beyond the reach.
  static constexpr double kSpare_m = 4e-4;

  NearDisks(double disk_radius_ratio, double cell_m)
      : disk_radius_ratio_(disk_radius_ratio), cells_per_m_(1 / cell_m) {}

  // Allocates unless reserved. The cloud has to outlive the queries; it is the finder's, or fewer points.
  void on_frame(const TiledCloud& cloud);
  void reserve(std::size_t padded_size);  // for clouds of that size
  // All disks whose centre is within reach_m, and some farther ones, none without a cloud; in the order of
  // the cloud's tiles. Which farther ones depends on the poses before. pre: reach_m <= kFieldMargin_m - 2e-4.
  void query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m);

  std::size_t size() const { return count_; }
  double lower_m(std::size_t i) const { return lower_[i]; }  // lower_bound_m()
  // The disk has a normal and lies so flat in the field that no point of it counts as nearer than its centre.
  bool is_flat(std::size_t i) const { return remote_touch::is_flat(slope_[i], radius_[i], extent_[i]); }
  double distance_m(std::size_t i) const { return distance_[i]; }
  Vec3 p_T(std::size_t i) const { return p_T_.at(i); }
  // cell_and_octant() of its centre and the direction against the gradient, in which a contact there would
  // push.
  std::uint64_t cell(std::size_t i) const { return cell_[i]; }
  // Appends the contacts of the disks with these numbers: of those whose lower bound is more than search_m
  // far_contact(), of others near_contact() at their nearest place.
  void append_contacts(std::span<const std::uint32_t> numbers, const TouchFinder& finder,
                       const Kernels& kernels, double search_m, double side,
                       std::vector<ToolContact>& contacts);
  SurfaceDisk disk(std::size_t i) const {
    return {p_T_.at(i), n_T_.at(i), radius_[i], {distance_[i], gradient_T_.at(i)}, extent_[i]};
  }

 private:
  struct Columns {
    Buffer<double> x, y, z;

    Vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  };
  bool is_covered(const TouchFinder& finder, const ToolPose& pose, double reach_m) const;
  void search(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  DiskColumns columns() const;
  void finish_outside(const VoxelTool& tool);

  const double disk_radius_ratio_, cells_per_m_;
  const TiledCloud* cloud_ = nullptr;
  // The points kept, and where and how far they were searched.
  Columns p_W_, n_W_;
  Buffer<double> spacing_, extent_;
  ToolPose searched_at_;
  double searched_m_ = -1;

  PosedField field_{};
  Columns p_T_, n_T_, gradient_T_;
  Buffer<double> radius_, distance_, slope_, lower_;
  Buffer<std::uint64_t> cell_;
  Columns contact_r_T_, contact_n_T_;
  Buffer<double> contact_depth_, contact_side_;
  std::size_t count_ = 0;
  bool is_known_ = false;  // the columns are valid for:
  ToolPose pose_;
  double reach_m_ = 0;
};

}  // namespace remote_touch
