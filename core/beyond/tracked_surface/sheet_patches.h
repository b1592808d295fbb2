// The patches of tracked sheets around a tool, and the motion of the tool with them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/beyond/tracked_surface/carried_tool.h"
#include "core/beyond/tracked_surface/sheet_tracker.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/dissertation/tool_motion/motion_program.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tiled_cloud.h"
#include "core/dissertation/tool_motion/tool_renderer.h"

namespace remote_touch {

// The contact of the tool when a frame arrives.
struct ToolHold {
  ToolPose pose;
  bool held = false;                      // points push the tool
  std::span<const ToolContact> contacts;  // contacts near the tool, with the points of the previous frame
};

// Each group of positions on the tool has one patch. The proxy of the patch is over the middle of the group,
// a contact radius above the lowest position of the group. The other patches are for contacts that none of
// these explains, such as a wall beside a tool on a floor. Another patch begins at its contact and ends when
// the tool has left it.
class SheetPatches final : public PointChange {
 public:
  // unit_m: the contact radius of the trackers, which is their unit of length.
  SheetPatches(const SheetSettings& settings, double unit_m, std::size_t max_patches, const VoxelTool& tool,
               const Kernels& kernels);
  void reserve(std::size_t points);

  // Keeps a frame for requery() while the tool has no position yet.
  void keep(const std::shared_ptr<const NeighbourSearch>& frame, double captured_s);
  struct Update {
    bool missing = false;  // a surface that holds the tool is not seen, but not yet dropped
    ToolSurfaceMotion motion;
  };
  // Processes a new frame. Allocates nothing if reserve() was called for its size.
  Update on_frame(const std::shared_ptr<const NeighbourSearch>& frame, const ToolHold& hold,
                  double captured_s);
  // Returns true if the tool has moved too far from the position of the last query.
  bool must_requery(const ToolPose& pose) const;
  // Updates the sheets around the tool from the points of the newest frame. A missing sheet is dropped, and
  // its patch searches for a new one. Returns the displacement that moves the tool out of the sheets.
  Vector6 requery(const ToolPose& pose, bool held);

  // Returns true if points are shown at other positions than the measured ones.
  bool changes_points() const;
  // Returns the radius around the tool's centre of mass within which points must be shown until the next
  // requery.
  double shown_radius_m() const { return shown_radius_m_; }
  bool concerns(const BoundingSphere& sphere) const override;
  bool apply(Point& point) const override;

  // Access for tests and for pages that show the patches.
  std::size_t size() const { return patches_.size(); }
  bool tracks(std::size_t patch) const { return patches_[patch].in_use && patches_[patch].tracker->tracks(); }
  const SheetTracker& tracker(std::size_t patch) const { return *patches_[patch].tracker; }

 private:
  struct Patch {
    std::unique_ptr<SheetTracker> tracker;
    std::span<const Vec3> positions_T;
    Vec3 middle_T = Vec3::Zero();
    double reach_m = 0;     // distance that the tool may move until the next query
    bool of_group = false;  // true: the patch of a group; false: of a contact
    bool in_use = false;
    Vec3 normal_W = Vec3::Zero();           // normal of that contact
    int contacts = 0;                       // number of contacts that it explains
    bool missing = false;                   // the sheet was not seen in the newest frame
    double captured_s = 0, interval_s = 0;  // time of the newest frame that shows it; interval before it
    Vec3 queried_W = Vec3::Zero();
  };
  struct Lowest {
    bool found = false;
    double clearance = 0;  // height above the sheet, units
    // The mean of the positions that are nearly as low. It is the lowest position itself if the sheet is not
    // seen below the mean, for example over a hole.
    Vec3 p_W = Vec3::Zero();
  };
  bool explains(const Patch& patch, const Vec3& p_W, const Vec3& n_W) const;
  Lowest lowest(const Patch& patch, const ToolPose& pose) const;
  ProxyPosition proxy_position(const Patch& patch, const ToolPose& pose, bool held) const;
  static bool holds(const Patch& patch, bool held) { return held && patch.contacts > 0; }
  int patch_of(const ToolHold& hold, const ToolContact& contact) const;
  void count_contacts(const ToolHold& hold);
  void count_unexplained(const ToolHold& hold);
  void follow(Patch& patch, const std::shared_ptr<const NeighbourSearch>& frame, const ToolHold& hold,
              double captured_s);
  bool is_face(const SheetTracker& tracker, double sigma) const;
  void start_patch(const std::shared_ptr<const NeighbourSearch>& frame, double captured_s);
  ToolSurfaceMotion carried(const ToolHold& hold);
  Vec3 out_of_swept(const Patch& patch, const ToolPose& now, const ToolPose& before) const;
  void note_query(Patch& patch, const ToolPose& pose) const;

  const double unit_m_;
  const ToolPositions positions_;
  std::vector<Patch> patches_;
  double shown_radius_m_ = 0;
  Vector6 rate_per_s_ = Vector6::Zero();  // rate of a held tool at the previous frame
  // The deepest contact that no patch explains, and the number of contacts with its direction. Another patch
  // begins there.
  struct {
    int alike = 0;
    Vec3 p_W = Vec3::Zero(), n_W = Vec3::Zero();
    double depth_m = 0;
  } unexplained_;
  std::vector<int> patch_of_ = std::vector<int>(MotionProgram::kMaxContacts);  // per contact; -1: none
};

}  // namespace remote_touch
