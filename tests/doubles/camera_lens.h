// The lens of a camera double: that of Brown and Conrady, with a rational part. It is written from the
// equations, without the vendors' sources.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <optional>

namespace remote_touch {

struct CameraLens {
  int width = 640, height = 480;
  double fx = 500, fy = 502, cx = 321.3, cy = 238.6;
  std::array<double, 6> k{};  // radial: three of the numerator, three of the denominator
  double p1 = 0, p2 = 0;      // tangential
  double max_radius = 1.7;    // rays farther from the axis are not seen

  using Point = Eigen::Vector2d;

  // Returns the position on the plane z = 1 where the lens shows this ray.
  Point distorted(const Point& ray) const {
    const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
    const double radial =
        (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))) / (1 + r2 * (k[3] + r2 * (k[4] + r2 * k[5])));
    return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  }
  std::optional<Point> pixel_of(const Point& ray) const {
    if (ray.norm() > max_radius) return {};
    const Point at = distorted(ray);
    return Point(cx + fx * at.x(), cy + fy * at.y());
  }
  // Newton's method with differences solves it.
  std::optional<Point> ray_of(const Point& pixel) const {
    const Point wanted((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
    Point ray = wanted;
    for (int i = 0; i < 30; ++i) {
      const Point error = distorted(ray) - wanted;
      if (error.norm() < 1e-12) return ray.norm() > max_radius ? std::nullopt : std::optional(ray);
      constexpr double kStep = 1e-6;
      Eigen::Matrix2d slope;
      slope.col(0) = (distorted(ray + Point(kStep, 0)) - distorted(ray - Point(kStep, 0))) / (2 * kStep);
      slope.col(1) = (distorted(ray + Point(0, kStep)) - distorted(ray - Point(0, kStep))) / (2 * kStep);
      ray -= slope.inverse() * error;
    }
    return {};
  }
};

}  // namespace remote_touch
