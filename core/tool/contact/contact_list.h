// The contacts of a pose for the contact rules, from the points of the collision list.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/tool/contact/contact_thinning.h"
#include "core/tool/contact/disk_contact.h"
#include "core/tool/contact/near_contacts.h"
#include "core/tool/contact/near_disks.h"
#include "core/tool/contact/near_points.h"
#include "core/tool/contact/touch_finder.h"
#include "core/tool/contact/touched_points.h"
#include "core/tool/dynamics/motion_program.h"
#include "core/tool/dynamics/tool_parameters.h"

namespace remote_touch {

// What a detection finds for the printed rule.
struct VoxelContacts {
  // (6.5) with depth 0, or (6.8) with depth 1 where there are collisions.
  std::span<const ToolContact> contacts;
  bool touched = false, collided = false;  // some point is in the tool; in its interior
};

// Lists are valid until the next call. If there are more contacts than the motion program takes, they are
// thinned.
class ContactList final : public NearContactSource {
 public:
  ContactList(std::shared_ptr<const VoxelTool> tool, const ToolParameters& parameters,
              const Kernels& kernels);

  void on_frame(std::shared_ptr<const TiledCloud> cloud);  // allocates unless reserved
  void reserve(std::size_t padded_size);                   // for clouds of that size
  const TouchFinder& finder() const { return finder_; }
  const NearDisks& near_disks() const { return disks_; }  // of the last call of near()
  // For TouchRule::continuous only: every point by itself, none merged, whose field value is at most reach_m,
  // and at most look_ahead_m and the radius of the largest disk. Valid until the next call.
  const NearPoints& points_within(const ToolPose& pose, double reach_m);

  // Every disk that the tool could touch within the smaller of within_m, but at least NearDisks::kSearch_m,
  // and look_ahead_m, and no farther than the field reaches; side as for near_contact().
  using NearContactSource::near;
  NearContacts near(const ToolPose& pose, double side, double within_m) override;
  // The points in shell and interior voxels. Those without a normal are left out.
  VoxelContacts in_voxels(const ToolPose& pose);
  // Points in shell or interior voxels, and unless the rule is voxels those whose disk is touched.
  Touched touched(const ToolPose& pose);

 private:
  void append_contacts(double side);
  void gather_cells();
  void gather_deepest(double side);
  std::span<const ToolContact> thinned(std::vector<ToolContact>& contacts);

  const ToolParameters p_;
  const Kernels& kernels_;
  TouchFinder finder_;
  NearDisks disks_;  // of the points, or of fewer that stand for all
  NearPoints points_;
  TouchedPoints touched_;
  double max_disk_m_ = 0, max_near_disk_m_ = 0;
  ContactThinning thinning_;
  std::vector<ToolContact> contacts_, collisions_;
  std::vector<std::uint32_t> cells_;  // of each near disk
  struct Nearest {
    double bound_m;
    std::uint32_t disk;
  };
  std::vector<Nearest> nearest_;       // of each cell, by their bounds
  std::vector<std::uint32_t> chosen_;  // disks
};

}  // namespace remote_touch
