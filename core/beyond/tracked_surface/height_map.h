// The heights of a sheet over a patch.
#pragma once

#include <array>

#include "core/beyond/tracked_surface/patch_frame.h"
#include "core/kernels/patch_kernels.h"

namespace remote_touch {

// Heights over the square |u|, |v| <= kHalf around the patch's origin, in contact radii. Nodes, one contact
// radius apart, hold local planes. The corners of the cells between them hold heights. The map is bilinear in
// each cell, so it is continuous.
class HeightMap {
 public:
  static constexpr double kHalf = 8;
  static constexpr int kCells = 32;  // along each side
  static constexpr double kCell = 2 * kHalf / kCells;
  static constexpr int kNodes = kCells / 2 + 1;
  static constexpr double kNodePitch = 2 * kCell;

  struct Node {
    double height = 0, slope_u = 0, slope_v = 0;
    double error = 0;      // standard error of the height, if it has a plane
    bool known = false;    // true: the node has a plane
    bool covered = false;  // true: the sheet reaches this node; false: the plane only extends it
  };
  static double node_at(int i) { return i * kNodePitch - kHalf; }
  Node& node(int i, int j) { return nodes_[static_cast<std::size_t>(j * kNodes + i)]; }
  const Node& node(int i, int j) const { return nodes_[static_cast<std::size_t>(j * kNodes + i)]; }
  const Node& nearest_node(double u, double v) const;
  // Returns the standard error of the height at a position: that of the nearest node. If it has no plane, the
  // largest error of the nodes next to it that have one; infinite if there is none.
  double error(double u, double v) const;
  // Computes the heights of the corners. Must be called after nodes were changed.
  void fill_cells();

  // Sets the map to a plane that is known within `radius` contact radii of the origin.
  void set_plane(double height, double slope_u, double slope_v, double radius);
  // Extends the map by `rings` contact radii beyond its border, with planes.
  void extend(int rings);
  // Reduces the change since an earlier map of the same patch to the part that the errors of the nodes do not
  // explain. Then noise moves the map much less from frame to frame, and a motion well above the noise is
  // hardly delayed.
  void shrink_change_since(const HeightMap& earlier);
  // Adds a plane: the motion and rotation of the sheet.
  void add_plane(double height, double slope_u, double slope_v);

  // Returns the height at a position; NaN if no height is known there. A position beyond the map's border has
  // the height of the nearest position on the border.
  double height(double u, double v) const;
  // Returns the same heights for the kernels.
  HeightGrid grid() const { return {corner_.data(), kCells, kHalf, 1 / kCell, kLast}; }
  // The slopes at a position, from the heights half a cell away on either side; NaN if one of these is not
  // known.
  struct Slopes {
    double u, v;
  };
  Slopes slopes(double u, double v) const;
  // Returns the mean slopes of the nodes within `radius` that the sheet covers; slopes() if there are none.
  Slopes mean_slopes(double u, double v, double radius) const;
  bool covers(double u, double v) const;

 private:
  static constexpr int kCorners = kCells + 1;
  static constexpr double kLast = kCells - 1e-9;
  std::array<Node, kNodes * kNodes> nodes_;
  std::array<double, kCorners * kCorners> corner_;
};

}  // namespace remote_touch
