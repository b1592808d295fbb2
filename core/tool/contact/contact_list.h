// The contacts of a pose for the contact rules, from the points of the collision list.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/rendering/renderer.h"
#include "core/tool/contact/contact_thinning.h"
#include "core/tool/contact/disk_contact.h"
#include "core/tool/contact/near_contacts.h"
#include "core/tool/contact/near_disks.h"
#include "core/tool/contact/touch_finder.h"
#include "core/tool/dynamics/motion_program.h"
#include "core/tool/dynamics/tool_parameters.h"

namespace remote_touch {

// What a detection finds for the printed rule.
struct VoxelContacts {
  // (6.5) with depth 0, or (6.8) with depth 1 where there are collisions.
  std::span<const ToolContact> contacts;
  bool touched = false, collided = false;  // some point is in the tool; in its interior
};

// What a pose touches, every point counted.
struct Touched {
  ContactState state = ContactState::free;  // entrenched: some points are in interior voxels
  int points = 0;
  int clusters = 0;               // 10 mm cells of the tool frame with such points
  double nearest_distance_m = 0;  // smallest field value of a point; infinite beyond the look-ahead
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
  // Of the last call of near() or touched(); for TouchRule::continuous those of the points.
  const NearDisks& near_disks() const { return is_merged_ ? merged_disks_ : disks_; }

  // Every disk that the tool could touch within look_ahead_m, or as far as the field reaches; side as for
  // near_contact().
  NearContacts near(const ToolPose& pose, double side) override;
  // The points in shell and interior voxels. Those without a normal are left out.
  VoxelContacts in_voxels(const ToolPose& pose);
  // Points in shell or interior voxels, and under the look-ahead rule those whose disk is touched.
  Touched touched(const ToolPose& pose);

 private:
  NearDisks& near_ones() { return is_merged_ ? merged_disks_ : disks_; }
  void gather_near(double reach_m);
  void append_contacts(double side);
  void gather_cells();
  void gather_deepest(double side);
  bool is_touched(std::size_t disk) const;
  void add_cluster(const Vec3& p_T);
  Touched touched_within(const ToolPose& pose, double reach_m);
  std::span<const ToolContact> thinned(std::vector<ToolContact>& contacts);

  const ToolParameters p_;
  const Kernels& kernels_;
  TouchFinder finder_;
  NearDisks disks_, merged_disks_;
  bool is_merged_ = false;  // near() looks at fewer points that stand for all
  double max_disk_m_ = 0, max_near_disk_m_ = 0;
  ContactThinning thinning_;
  std::vector<ToolContact> contacts_, collisions_;
  struct NearDisk {
    double bound_m;
    std::uint32_t disk, cell;
  };
  std::vector<NearDisk> near_;     // within the look-ahead
  std::vector<NearDisk> nearest_;  // of each cell, by their bounds
  std::vector<NearDisk> others_;   // that can be deeper than the contact of the nearest
  std::vector<std::uint32_t> chosen_;
  std::vector<std::uint64_t> clusters_;
};

}  // namespace remote_touch
