#include "tests/benchmarks/peers/voxmap_pointshell.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace remote_touch::benchmarks {

VoxmapPointshell::VoxmapPointshell(const VoxelTool& tool, const PointCloud& cloud, double voxel_m,
                                   double disk_m)
    : voxel_m_(voxel_m) {
  make_map(cloud, disk_m);
  make_shell(tool);
}

VoxmapPointshell::Voxel VoxmapPointshell::voxel_of(const Vec3& p_W) const {
  const Vec3 u = (p_W - origin_W_) / voxel_m_;
  return {static_cast<int>(std::floor(u.x())), static_cast<int>(std::floor(u.y())),
          static_cast<int>(std::floor(u.z()))};
}

Vec3 VoxmapPointshell::centre_W(const Voxel& voxel) const {
  return origin_W_ + voxel_m_ * Vec3(voxel[0] + 0.5, voxel[1] + 0.5, voxel[2] + 0.5);
}

void VoxmapPointshell::make_map(const PointCloud& cloud, double disk_m) {
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 u = cloud.normal(i).unitOrthogonal(), v = cloud.normal(i).cross(u);
    const int steps = static_cast<int>(disk_m / (0.5 * voxel_m_));
    for (int a = -steps; a <= steps; ++a)
      for (int b = -steps; b <= steps; ++b)
        if (a * a + b * b <= steps * steps)
          places.push_back(cloud.point(i) + 0.5 * voxel_m_ * (a * u + b * v));
  }
  Vec3 low = places.front(), high = places.front();
  for (const Vec3& p : places) low = low.cwiseMin(p), high = high.cwiseMax(p);
  origin_W_ = low - Vec3::Constant(2 * voxel_m_);  // a free layer, and one of proximity
  for (int axis = 0; axis < 3; ++axis)
    size_[static_cast<std::size_t>(axis)] = static_cast<int>((high[axis] - low[axis]) / voxel_m_) + 5;
  type_.assign(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                   static_cast<std::size_t>(size_[2]),
               kFree);
  std::set<Voxel> surface;
  for (const Vec3& p : places) surface.insert(voxel_of(p));
  surface_.assign(surface.begin(), surface.end());
  const auto at = [&](int i, int j, int k) -> std::uint8_t& {
    return type_[(static_cast<std::size_t>(k) * static_cast<std::size_t>(size_[1]) +
                  static_cast<std::size_t>(j)) *
                     static_cast<std::size_t>(size_[0]) +
                 static_cast<std::size_t>(i)];
  };
  for (const Voxel& v : surface_)
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) at(v[0] + i, v[1] + j, v[2] + k) = kProximity;
  for (const Voxel& v : surface_) at(v[0], v[1], v[2]) = kSurface;
}

// Makes one point for each voxel, of this size, of the tool's grid that its surface passes: the point of the
// surface that is nearest to the centre by the field.
void VoxmapPointshell::make_shell(const VoxelTool& tool) {
  const Vec3 reach = Vec3::Constant(tool.reach_m);
  const int cells = static_cast<int>(2 * tool.reach_m / voxel_m_) + 1;
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        Vec3 p = -reach + voxel_m_ * Vec3(i + 0.5, j + 0.5, k + 0.5);
        const Vec3 centre = p;
        FieldSample at = sample_field(tool, p);
        if (std::abs(at.distance_m) > voxel_m_) continue;
        for (int step = 0; step < 4; ++step) {
          const double steep = std::max(0.1, at.gradient_T.squaredNorm());
          p -= at.distance_m / steep * at.gradient_T;
          at = sample_field(tool, p);
        }
        if ((p - centre).cwiseAbs().maxCoeff() > voxel_m_ / 2 || !(at.gradient_T.norm() > 0.3)) continue;
        const Vec3 n = -at.gradient_T.normalized();
        x_.push_back(p.x()), y_.push_back(p.y()), z_.push_back(p.z());
        nx_.push_back(n.x()), ny_.push_back(n.y()), nz_.push_back(n.z());
        shell_error_m_ = std::max(shell_error_m_, std::abs(at.distance_m));
      }
  count_ = x_.size();
  cell_.resize(count_);
}

void VoxmapPointshell::add_force(std::size_t point, const Eigen::Matrix3d& R_WT, const Vec3& at_W,
                                 const Voxel& voxel, const Vec3& origin_W, Touch& all) const {
  ++all.points;
  const Vec3 n_W = R_WT * Vec3(nx_[point], ny_[point], nz_[point]);
  const double depth_m = n_W.dot(centre_W(voxel) - at_W);  // depth below the plane through the voxel's centre
  if (!(depth_m > 0)) return;
  all.force_W += depth_m * n_W;
  all.torque_W += (at_W - origin_W).cross(depth_m * n_W);
}

// One loop finds the voxels of all points. A second one handles the few that touch.
VoxmapPointshell::Touch VoxmapPointshell::touch(const ToolPose& pose) {
  const Eigen::Matrix3d R = pose.q_WT.toRotationMatrix();
  const Vec3 from = pose.p_W - origin_W_;
  const double per_m = 1 / voxel_m_;
  double row[3][4];
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) row[axis][k] = R(axis, k) * per_m;
    row[axis][3] = from[axis] * per_m;
  }
  const double *x = x_.data(), *y = y_.data(), *z = z_.data();
  std::int32_t* cell = cell_.data();
  const double last[3] = {double(size_[0]), double(size_[1]), double(size_[2])};
  const std::int32_t columns = size_[0], rows = size_[1];
  for (std::size_t i = 0; i < count_; ++i) {
    const double u = row[0][0] * x[i] + row[0][1] * y[i] + row[0][2] * z[i] + row[0][3],
                 v = row[1][0] * x[i] + row[1][1] * y[i] + row[1][2] * z[i] + row[1][3],
                 w = row[2][0] * x[i] + row[2][1] * y[i] + row[2][2] * z[i] + row[2][3];
    const bool in = (u >= 0) & (u < last[0]) & (v >= 0) & (v < last[1]) & (w >= 0) & (w < last[2]);
    const std::int32_t number =
        (static_cast<std::int32_t>(w) * rows + static_cast<std::int32_t>(v)) * columns +
        static_cast<std::int32_t>(u);
    cell[i] = in ? number : 0;  // a corner, which is free
  }
  Touch all;
  for (std::size_t i = 0; i < count_; ++i) {
    if (type_[static_cast<std::size_t>(cell[i])] != kSurface) continue;
    const Voxel voxel{cell[i] % columns, cell[i] / columns % rows, cell[i] / columns / rows};
    add_force(i, R, pose.p_W + R * Vec3(x[i], y[i], z[i]), voxel, pose.p_W, all);
  }
  return all;
}

VoxmapPointshell::Touch VoxmapPointshell::plain_touch(const ToolPose& pose) const {
  const Eigen::Matrix3d R = pose.q_WT.toRotationMatrix();
  Touch all;
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3 at_W = pose.p_W + R * Vec3(x_[i], y_[i], z_[i]);
    const Voxel voxel = voxel_of(at_W);
    if (std::binary_search(surface_.begin(), surface_.end(), voxel))
      add_force(i, R, at_W, voxel, pose.p_W, all);
  }
  return all;
}

}  // namespace remote_touch::benchmarks
