// The heights of a sheet over a patch.
#pragma once

#include <array>

#include "core/beyond/tracked_surface/patch_frame.h"
#include "core/kernels/patch_kernels.h"

namespace remote_touch {

// Heights over the square |u|, |v| <= kHalf around the patch's origin, in contact radii. Nodes, one contact
// radius apart, carry local planes; corners of cells between them carry heights, and within a cell the map is
// bilinear, so it is continuous.
class HeightMap {
 public:
  static constexpr double kHalf = 8;
  static constexpr int kCells = 32;  // along each side
  static constexpr double kCell = 2 * kHalf / kCells;
  static constexpr int kNodes = kCells / 2 + 1;
  static constexpr double kNodePitch = 2 * kCell;

  struct Node {
    double height = 0, slope_u = 0, slope_v = 0;
    double error = 0;      // standard error of the height
    bool known = false;    // there is a plane
    bool covered = false;  // the sheet reaches this node; else the plane continues it beyond its border
  };
  static double node_at(int i) { return i * kNodePitch - kHalf; }
  Node& node(int i, int j) { return nodes_[static_cast<std::size_t>(j * kNodes + i)]; }
  const Node& node(int i, int j) const { return nodes_[static_cast<std::size_t>(j * kNodes + i)]; }
  const Node& nearest_node(double u, double v) const;
  // Must be called after nodes were changed.
  void fill_cells();

  // Sets the map to a plane that is known within this number of contact radii of the origin.
  void set_plane(double height, double slope_u, double slope_v, double radius);
  // Continues the map by this number of contact radii beyond its border, as planes.
  void extend(int rings);
  // Reduces the change since an earlier map of the same patch to the part that the nodes' errors do not
  // explain. Noise then moves the map much less from frame to frame, and a motion that is well above it
  // appears hardly later.
  void steady(const HeightMap& earlier);
  // Adds a plane: the motion and rotation of the sheet.
  void add_plane(double height, double slope_u, double slope_v);

  // Height at a position; NaN where no height is known. Beyond the map's border, it is that of the nearest
  // position on it.
  double height(double u, double v) const;
  // The same heights, for kernels.
  HeightGrid grid() const { return {corner_.data(), kCells, kHalf, 1 / kCell, kLast}; }
  // Slopes of the cells; NaN where no height is known.
  struct Slopes {
    double u, v;
  };
  Slopes slopes(double u, double v) const;
  // Mean slopes of the nodes that the sheet covers within that distance.
  Slopes mean_slopes(double u, double v, double radius) const;
  bool covers(double u, double v) const;

 private:
  static constexpr int kCorners = kCells + 1;
  static constexpr double kLast = kCells - 1e-9;
  std::array<Node, kNodes * kNodes> nodes_;
  std::array<double, kCorners * kCorners> corner_;
};

}  // namespace remote_touch
