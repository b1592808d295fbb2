#include "scenarios/noisy_grid_search.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {
// Made beyond what was asked for, so that the next queries of a moving proxy find their points ready.
constexpr double kSpareMargin_m = 0.004;

int clamped(double place, int count) {
  return static_cast<int>(std::clamp(place, -1.0, static_cast<double>(count)));
}
}  // namespace

NoisyGridSearch::NoisyGridSearch(const Grid& grid, double height_m, double sigma_m, const NoiseStream& stream)
    : grid_(grid), height_m_(height_m), sigma_m_(sigma_m), stream_(stream) {
  index_.reserve(size());
  for (auto* column : {&x_, &y_, &z_, &nx_, &ny_, &nz_}) column->reserve(size());
}

// The part of the grid from which a point can reach the ball; empty when the plane itself is out of reach.
NoisyGridSearch::Window NoisyGridSearch::window(const Ball& ball, double margin_m) const {
  const double reach = ball.radius + kLargestNormal * sigma_m_ + margin_m + 1e-9;
  Window w;
  if (std::abs(ball.centre.y() - height_m_) > reach) return w;
  w.first_column = std::max(
      0, clamped(std::ceil((ball.centre.x() - reach - grid_.x(0)) / grid_.spacing_m), grid_.columns));
  w.last_column =
      std::min(grid_.columns - 1,
               clamped(std::floor((ball.centre.x() + reach - grid_.x(0)) / grid_.spacing_m), grid_.columns));
  w.first_row =
      std::max(0, clamped(std::ceil((ball.centre.z() - reach - grid_.z(0)) / grid_.spacing_m), grid_.rows));
  w.last_row =
      std::min(grid_.rows - 1,
               clamped(std::floor((ball.centre.z() + reach - grid_.z(0)) / grid_.spacing_m), grid_.rows));
  return w;
}

void NoisyGridSearch::make(const Window& w, const Kernels& kernels) const {
  made_ = w;
  index_.clear(), x_.clear(), y_.clear(), z_.clear();
  for (int row = w.first_row; row <= w.last_row; ++row)
    for (int column = w.first_column; column <= w.last_column; ++column) {
      index_.push_back(static_cast<std::uint32_t>(row * grid_.columns + column));
      x_.push_back(grid_.x(column)), y_.push_back(height_m_), z_.push_back(grid_.z(row));
    }
  if (sigma_m_ == 0) return;
  for (auto* column : {&nx_, &ny_, &nz_}) column->resize(index_.size());
  kernels.normals(stream_, index_.data(), index_.size(), nx_.data(), ny_.data(), nz_.data());
  for (std::size_t i = 0; i < index_.size(); ++i)
    x_[i] += sigma_m_ * nx_[i], y_[i] += sigma_m_ * ny_[i], z_[i] += sigma_m_ * nz_[i];
}

void NoisyGridSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  const Window needed = window(ball, 0);
  if (needed.first_column > needed.last_column || needed.first_row > needed.last_row) return;
  if (!made_.holds(needed)) make(window(ball, kSpareMargin_m), kernels);
  out.add({x_.data(), y_.data(), z_.data(), nullptr, nullptr, index_.data(), 0, index_.size()}, ball,
          kernels);
}

}  // namespace remote_touch
