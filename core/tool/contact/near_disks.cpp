#include "core/tool/contact/near_disks.h"

#include <cmath>

#include "core/tool/contact/contact_thinning.h"

namespace remote_touch {

void NearDisks::on_frame(const TiledCloud& cloud) {
  reserve(cloud.padded_size());
}

void NearDisks::reserve(std::size_t padded_size) {
  for (Columns* columns : {&p_T_, &n_T_, &gradient_T_})
    for (auto* column : {&columns->x, &columns->y, &columns->z}) column->grow(padded_size);
  for (auto* column : {&radius_, &distance_, &slope_, &lower_}) column->grow(padded_size);
  cell_.grow(padded_size);
  count_ = 0, is_known_ = false;
}

void NearDisks::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                      double reach_m) {
  if (is_known_ && pose == pose_ && reach_m == reach_m_) return;
  const VoxelTool& tool = finder.tool();
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  PosedField field;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) field.R_TW[axis][k] = R_TW(axis, k);
    field.p_W[axis] = pose.p_W[axis];
    field.origin_T[axis] = tool.grid.origin_T[axis];
    field.cells[axis] = tool.grid.cells[static_cast<std::size_t>(axis)];
  }
  field.node = tool.distance_m.data();
  field.size = tool.grid.size_m;
  const auto three = [](Columns& c, double*(&out)[3]) {
    out[0] = c.x.data(), out[1] = c.y.data(), out[2] = c.z.data();
  };
  DiskColumns disks;
  three(p_T_, disks.p_T), three(n_T_, disks.n_T), three(gradient_T_, disks.gradient_T);
  disks.radius = radius_.data(), disks.distance = distance_.data(), disks.slope = slope_.data(),
  disks.lower = lower_.data(), disks.cell = cell_.data();
  const std::span<const std::uint32_t> points = finder.within(pose, reach_m);
  kernels.tool.disks_in_field(finder.cloud().columns(), points.data(), points.size(), disk_radius_ratio_,
                              cells_per_m_, field, disks);
  count_ = points.size();
  finish_outside(tool);
  is_known_ = true, pose_ = pose, reach_m_ = reach_m;
}

// What the kernel leaves: a place less than a cell outside the grid.
void NearDisks::finish_outside(const VoxelTool& tool) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (!std::isnan(lower_[i])) continue;
    SurfaceDisk outside = disk(i);
    outside.at = sample_field(tool, outside.p_T);
    distance_[i] = outside.at.distance_m;
    gradient_T_.x[i] = outside.at.gradient_T.x();
    gradient_T_.y[i] = outside.at.gradient_T.y();
    gradient_T_.z[i] = outside.at.gradient_T.z();
    slope_[i] = std::nan("");
    lower_[i] = lower_bound_m(outside);
    cell_[i] = cell_and_octant(outside.p_T, -outside.at.gradient_T, cells_per_m_);
  }
}

}  // namespace remote_touch
