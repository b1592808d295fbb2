#include "core/rivals/plane_constraints.h"

#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

// Planes whose normals span less than this (squared sine, or volume) are not combined, because their
// intersection is far away or does not exist. The choices without one of them remain.
constexpr double kParallel = 1e-9;

// Tries motions from the goal onto planes, and keeps the shortest one that obeys all planes.
class Search {
 public:
  // rise: distance by which the goal must rise along each normal.
  Search(const std::array<Vec3, PlaneConstraints::kMaxCount>& normal,
         const std::array<double, PlaneConstraints::kMaxCount>& rise, std::size_t count, double slack)
      : normal_(normal), rise_(rise), count_(count), slack_(slack) {}

  void on_plane(std::size_t i) { offer(rise_[i] * normal_[i], 1); }
  // y - goal = l_i n_i + l_j n_j, with the multipliers from the equations of both planes.
  void on_line(std::size_t i, std::size_t j) {
    const double between = normal_[i].dot(normal_[j]), rest = normal_[i].cross(normal_[j]).squaredNorm();
    if (!(rest > kParallel)) return;
    const double l_i = (rise_[i] - between * rise_[j]) / rest, l_j = (rise_[j] - between * rise_[i]) / rest;
    offer(l_i * normal_[i] + l_j * normal_[j], 2);
  }
  // The three equations are solved by Cramer's rule.
  void on_corner(std::size_t i, std::size_t j, std::size_t k) {
    const Vec3 jk = normal_[j].cross(normal_[k]), ki = normal_[k].cross(normal_[i]),
               ij = normal_[i].cross(normal_[j]);
    const double volume = normal_[i].dot(jk);
    if (!(std::abs(volume) > kParallel)) return;
    offer((rise_[i] * jk + rise_[j] * ki + rise_[k] * ij) / volume, 3);
  }
  void offer(const Vec3& motion, int active_planes) {
    const double squared = motion.squaredNorm();
    if (!(squared < shortest_)) return;
    for (std::size_t i = 0; i < count_; ++i)
      if (!(normal_[i].dot(motion) >= rise_[i] - slack_)) return;
    shortest_ = squared, best_ = motion, active_planes_ = active_planes;
  }

  bool found() const { return shortest_ < std::numeric_limits<double>::infinity(); }
  const Vec3& best() const { return best_; }
  int active_planes() const { return active_planes_; }

 private:
  const std::array<Vec3, PlaneConstraints::kMaxCount>& normal_;
  const std::array<double, PlaneConstraints::kMaxCount>& rise_;
  std::size_t count_;
  double slack_, shortest_ = std::numeric_limits<double>::infinity();
  Vec3 best_ = Vec3::Zero();
  int active_planes_ = 0;
};

}  // namespace

bool PlaneConstraints::add(const Vec3& normal, const Vec3& point, double offset_m) {
  if (count_ == kMaxCount) return false;
  planes_[count_++] = {normal, point, offset_m};
  return true;
}

PlaneConstraints::Nearest PlaneConstraints::nearest(const Vec3& goal) const {
  std::array<Vec3, kMaxCount> normal;
  std::array<double, kMaxCount> rise;
  for (std::size_t i = 0; i < count_; ++i) {
    normal[i] = planes_[i].normal;
    rise[i] = planes_[i].normal.dot(planes_[i].point - goal) + planes_[i].offset_m;
  }
  Search search(normal, rise, count_, slack_m_);
  search.offer(Vec3::Zero(), 0);
  for (std::size_t i = 0; i < count_; ++i) {
    search.on_plane(i);
    for (std::size_t j = i + 1; j < count_; ++j) {
      search.on_line(i, j);
      for (std::size_t k = j + 1; k < count_; ++k) search.on_corner(i, j, k);
    }
  }
  return {search.found(), goal + search.best(), search.active_planes()};
}

}  // namespace remote_touch
