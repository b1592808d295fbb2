#include "core/neighbourhood.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace remote_touch {

namespace {
// A cube's edge in units of the reach: smaller means fewer useless points in a list, larger fewer new lists.
constexpr double kPitch = 0.125;
// A tube is searched in at most so many hops, however far the HIP jumped.
constexpr double kMostHops = 64;
}  // namespace

Neighbourhood::Neighbourhood(double reach, const Kernels& kernels)
    : reach_(reach), pitch_(kPitch * reach), kernels_(kernels) {}

void Neighbourhood::set_points(std::shared_ptr<const NeighbourSearch> points) {
  points_ = std::move(points);
  list_valid_ = false;
  for (GatheredPoints* columns : {&list_, &tube_})
    columns->reserve(points_->size(), points_->has_fixture_radius(), points_->has_stiffness());
}

const GatheredPoints& Neighbourhood::around(const Vec3& p) {
  const Vec3 centre = (p / pitch_).array().round().matrix() * pitch_;
  if (list_valid_ && centre == list_centre_) return list_;
  list_centre_ = centre;
  // 0.8661 > sqrt(3)/2: from the cube's centre to its corner, with room for rounding.
  list_radius_ = reach_ + points_->largest_fixture_radius() + 0.8661 * pitch_;
  list_.clear();
  points_->gather({list_centre_, list_radius_}, kernels_, list_);
  list_.finish();
  list_valid_ = true;
  sum_grid_ = 1.5 * static_cast<double>(std::bit_ceil(list_.size() + 1));
  return list_;
}

double Neighbourhood::first_hit(const Vec3& p, const Vec3& u, double radius, double limit) {
  const double girth = radius + points_->largest_fixture_radius();
  const bool covered = list_valid_ && (p - list_centre_).norm() + limit + girth <= list_radius_;
  if (covered) return std::min(limit, kernels_.first_hit(list_.view(), p.data(), u.data(), radius));

  // A point first met between two hops lies within girth of that part of the axis, so it is in that hop's
  // ball; the root is taken from p itself, whatever the hop, so the result does not depend on the hops.
  const double hop = std::max(2 * reach_, limit / kMostHops);
  for (double start = 0; start < limit; start += hop) {
    const double end = std::min(start + hop, limit);
    const double rounding = 1e-9 * (1 + end);
    tube_.clear();
    points_->gather({p + 0.5 * (start + end) * u, 0.5 * (end - start) + girth + rounding}, kernels_, tube_);
    tube_.finish();
    const double hit = kernels_.first_hit(tube_.view(), p.data(), u.data(), radius);
    if (hit <= end) return hit;
  }
  return limit;
}

}  // namespace remote_touch
