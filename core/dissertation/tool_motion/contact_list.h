// Computes the contacts of a pose for the contact rules, from the points that TouchFinder detects.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/dissertation/tool_motion/motion_program.h"
#include "core/dissertation/tool_motion/near_points.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/touch_finder.h"

namespace remote_touch {

// The contacts that the look-ahead rule needs from a scene: everything that the tool could touch soon.

struct NearContacts {
  std::span<const ToolContact> contacts;
  double deepest_m = 0;  // largest depth, negative if nothing is touched; -infinity: nothing was found
  // Every contact within this distance is listed, unless it was left out because there were too many;
  // infinity: every contact within the look-ahead.
  double within_m = std::numeric_limits<double>::infinity();
};

// The interface between the look-ahead rule and the source of contacts: the points of a surface, or regions.
class NearContactSource {
 public:
  virtual ~NearContactSource() = default;
  // Returns the contacts of a pose within within_m. It may return more, but none beyond the look-ahead, and
  // no more than MotionProgram::kMaxContacts. side: +1 or -1, the side of the surface that the tool was on
  // before a frame put points into it; 0: not known. Valid until the next call.
  virtual NearContacts near(const ToolPose& pose, double side, double within_m) = 0;
  // Returns all contacts within the look-ahead.
  NearContacts near(const ToolPose& pose, double side) {
    return near(pose, side, std::numeric_limits<double>::infinity());
  }
  // Returns the fraction of a motion from this pose that the tool may make. A source that cannot check this
  // returns 1.
  virtual double clear_fraction(const ToolPose&, const Vector6&) { return 1; }
};

// The result of a detection for the printed rule.
struct VoxelContacts {
  // The contacts of (6.5) with depth 0. If there are collisions, these are listed instead: (6.8) with depth
  // 1.
  std::span<const ToolContact> contacts;
  bool touched = false, collided = false;  // a point with a normal is in the tool; one is in its interior
};

// Lists are valid until the next call. If there are more contacts than MotionProgram::kMaxContacts, they are
// thinned.
class ContactList final : public NearContactSource {
 public:
  ContactList(std::shared_ptr<const VoxelTool> tool, const ToolParameters& parameters,
              const Kernels& kernels);

  void on_frame(std::shared_ptr<const TiledCloud> cloud);  // allocates unless reserved
  void reserve(std::size_t padded_size);                   // reserves memory for clouds of this size
  const TouchFinder& finder() const { return finder_; }
  const NearDisks& near_disks() const { return disks_; }  // disks of the last near()
  // Returns true if a single point, none merged, has a field value below value_m, which is 0 or less. Only
  // for ContactRule::continuous.
  bool has_point_below(const ToolPose& pose, double value_m);
  // Returns every single point, none merged, with a field value of at most way.far, apart from some that
  // cannot stop the motion, as NearPoints does. No point is returned whose field value is above look_ahead_m
  // plus the radius of the largest disk, or beyond the reach of the field. Only for ContactRule::continuous.
  // Valid until the next call.
  const NearPoints& points_on_way(const ToolPose& pose, SlabWay way);

  // Returns the contacts of all disks that are within within_m of the tool, or within NearDisks::kSearch_m if
  // that is more. Disks beyond look_ahead_m or beyond the reach of the field are left out. side: as for
  // near_contact().
  using NearContactSource::near;
  NearContacts near(const ToolPose& pose, double side, double within_m) override;
  // Returns the contacts of the points in shell and interior voxels, except those without a normal.
  VoxelContacts in_voxels(const ToolPose& pose);
  // Counts the points in shell or interior voxels. Unless the rule is voxels, also counts the points whose
  // disk touches the tool.
  Touched touched(const ToolPose& pose);

 private:
  double max_single_m() const;
  void append_contacts(double side);
  void gather_cells();
  void gather_deepest(double side);
  std::span<const ToolContact> thinned(std::vector<ToolContact>& contacts);

  const ToolParameters p_;
  const Kernels& kernels_;
  TouchFinder finder_;
  NearDisks disks_;  // disks of the points, or of fewer points that represent all
  NearPoints points_;
  TouchedPoints touched_;
  double max_disk_m_ = 0, max_near_disk_m_ = 0;
  ContactThinning thinning_;
  std::vector<ToolContact> contacts_, collisions_;
  std::vector<std::uint32_t> cells_;  // cell of each near disk
  struct Nearest {
    double bound_m;
    std::uint32_t disk;
  };
  std::vector<Nearest> nearest_;       // nearest disk of each cell, by bound
  std::vector<std::uint32_t> chosen_;  // numbers of disks
};

}  // namespace remote_touch
