#include "core/tool/contact/near_disks.h"

#include <algorithm>
#include <cmath>

#include "core/tool/contact/contact_thinning.h"

namespace remote_touch {

namespace {

constexpr double kMaxSearch_m = kFieldMargin_m - 1e-4;

PosedField posed(const VoxelTool& tool, const ToolPose& pose) {
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
  return field;
}

}  // namespace

void NearDisks::on_frame(const TiledCloud& cloud) {
  cloud_ = &cloud;
  reserve(cloud.padded_size());
}

void NearDisks::reserve(std::size_t padded_size) {
  for (Columns* columns : {&p_W_, &n_W_, &p_T_, &n_T_, &gradient_T_, &contact_r_T_, &contact_n_T_})
    for (auto* column : {&columns->x, &columns->y, &columns->z}) column->grow(padded_size);
  for (auto* column :
       {&spacing_, &extent_, &radius_, &distance_, &slope_, &lower_, &contact_depth_, &contact_side_})
    column->grow(padded_size);
  cell_.grow(padded_size);
  count_ = 0, is_known_ = false, searched_m_ = -1;
}

// No point that was left out can be within reach_m: the field there was larger than searched_m_, and has
// changed by no more than its slope times the way of the point through it.
bool NearDisks::is_covered(const TouchFinder& finder, const ToolPose& pose, double reach_m) const {
  const double turn =
      2 * (pose.q_WT * searched_at_.q_WT.conjugate()).vec().norm();  // 2 sin of half the angle
  const double way_m = (pose.p_W - searched_at_.p_W).norm() + turn * finder.grid_reach_m();
  return searched_m_ - finder.max_slope() * way_m > reach_m;
}

void NearDisks::search(const TouchFinder& finder, const ToolPose& pose, double reach_m) {
  searched_at_ = pose, searched_m_ = std::max(reach_m, std::min(reach_m + kSpare_m, kMaxSearch_m));
  const std::span<const std::uint32_t> points = finder.within(*cloud_, pose, searched_m_);
  const PointColumns all = cloud_->columns();
  count_ = points.size();
  for (std::size_t k = 0; k < count_; ++k) {
    const std::uint32_t i = points[k];
    p_W_.x[k] = all.x[i], p_W_.y[k] = all.y[i], p_W_.z[k] = all.z[i];
    n_W_.x[k] = all.nx[i], n_W_.y[k] = all.ny[i], n_W_.z[k] = all.nz[i];
    spacing_[k] = all.spacing[i], extent_[k] = all.extent[i];
  }
  for (std::size_t k = count_; k % kLanes != 0; ++k)
    for (Buffer<double>* column : {&p_W_.x, &p_W_.y, &p_W_.z, &n_W_.x, &n_W_.y, &n_W_.z, &spacing_, &extent_})
      (*column)[k] = kFarAway;
}

void NearDisks::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                      double reach_m) {
  if (!cloud_ || (is_known_ && pose == pose_ && reach_m <= reach_m_)) return;
  const VoxelTool& tool = finder.tool();
  field_ = posed(tool, pose);
  if (!is_covered(finder, pose, reach_m)) search(finder, pose, reach_m);
  const PointColumns points{p_W_.x.data(), p_W_.y.data(), p_W_.z.data(),   n_W_.x.data(),
                            n_W_.y.data(), n_W_.z.data(), spacing_.data(), extent_.data()};
  kernels.tool.disks_in_field(points, count_, disk_radius_ratio_, cells_per_m_, field_, columns());
  finish_outside(tool);
  is_known_ = true, pose_ = pose, reach_m_ = reach_m;
}

DiskColumns NearDisks::columns() const {
  return {{p_T_.x.data(), p_T_.y.data(), p_T_.z.data()},
          {n_T_.x.data(), n_T_.y.data(), n_T_.z.data()},
          radius_.data(),
          distance_.data(),
          {gradient_T_.x.data(), gradient_T_.y.data(), gradient_T_.z.data()},
          slope_.data(),
          lower_.data(),
          cell_.data(),
          extent_.data()};
}

void NearDisks::append_contacts(std::span<const std::uint32_t> numbers, const TouchFinder& finder,
                                const Kernels& kernels, double search_m, double side,
                                std::vector<ToolContact>& contacts) {
  kernels.tool.disk_contacts(columns(), numbers.data(), numbers.size(), field_, search_m, side,
                             {{contact_r_T_.x.data(), contact_r_T_.y.data(), contact_r_T_.z.data()},
                              {contact_n_T_.x.data(), contact_n_T_.y.data(), contact_n_T_.z.data()},
                              contact_depth_.data(),
                              contact_side_.data()});
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (std::isnan(contact_depth_[k])) {  // the search has left the grid
      const SurfaceDisk outside = disk(numbers[k]);
      contacts.push_back(near_contact(finder.tool(), outside, nearest_place(finder.tool(), outside), side));
    } else {
      contacts.push_back({contact_r_T_.at(k), contact_n_T_.at(k), contact_depth_[k], contact_side_[k]});
    }
  }
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
