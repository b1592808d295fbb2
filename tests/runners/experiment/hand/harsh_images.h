// Harsh depth images for the tests of hands that are planned on images: sparse, with holes, with objects that
// move. The oracle is the analytic surface of each scene along the hand's viewing ray, never the image.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "runners/experiment/hand/image_motions.h"
#include "tests/support/depth_scenes.h"
#include "tests/support/note_kinds.h"
#include "tests/support/scenes.h"

namespace remote_touch::harsh_images {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kEdge_m = 0.006;  // default of edge_jump_m

// Depth that is seen along the ray (x, y, 1); NaN: nothing.
using Surface = std::function<double(double x, double y)>;
// True for a pixel that is measured.
using Mask = std::function<bool(int u, int v)>;

inline const CameraIntrinsics kCamera = scenes::kinect();

inline DepthImage photographed(const Surface& surface, const Mask& is_measured) {
  DepthImage image{kCamera.width, kCamera.height, {}};
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      const Vec3 ray = scenes::ray(kCamera, u, v);
      image.z_m.push_back(is_measured(u, v) ? surface(ray.x(), ray.y()) : kNaN);
    }
  return image;
}

class Views final : public Scenario {
 public:
  explicit Views(std::vector<DepthImage> frames) : frames_(std::move(frames)) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return static_cast<int>(frames_.size()); }
  PointCloud cloud(int frame) const override {
    const int last = frame_count() - 1;
    return cloud_from_depth(frames_[static_cast<std::size_t>(std::min(frame, last))], kCamera,
                            RigidTransform::Identity());
  }
  double signed_distance(const Vec3&, double) const override { return kNaN; }

 private:
  const std::vector<DepthImage> frames_;
};

inline bool everywhere(int, int) {
  return true;
}

// Each pixel is measured with probability p, the same pixels each time.
inline Mask scattered(double p, unsigned seed) {
  auto measured = std::make_shared<std::vector<bool>>();
  std::mt19937 random(seed);
  for (int i = 0; i < kCamera.width * kCamera.height; ++i) measured->push_back(random() < p * 4294967296.0);
  return [measured](int u, int v) { return (*measured)[static_cast<std::size_t>(v * kCamera.width + u)]; };
}

inline double wall(double z_m) {
  return z_m;
}

// An upright cylinder in front of the camera: radius 4 cm, height 10 cm, front at 0.5 m.
inline double mug(double x, double y) {
  const double radius = 0.04, centre = 0.54, a = x * x + 1;
  const double root = centre * centre - a * (centre * centre - radius * radius);
  const double z = (centre - std::sqrt(root)) / a;  // x^2 z^2 + (z - c)^2 = r^2
  return std::abs(z * y) <= 0.05 ? z : kNaN;        // NaN too where the root is of a negative number
}

inline double nearer(double a, double b) {
  return std::isnan(a) || b < a ? b : a;
}

inline double mug_before_wall(double x, double y) {
  return nearer(mug(x, y), wall(0.7));
}

// A plate that fills a rectangle, at one depth.
inline double plate(double x, double y, double z, double x_from, double x_to, double y_half) {
  return z * x >= x_from && z * x <= x_to && std::abs(z * y) <= y_half ? z : kNaN;
}

struct Course {
  double deepest_m = -1e9;   // farthest behind the surface
  double on_object_s = 0;    // time spent 5 mm or more inside the object of is_object()
  double farthest_m = -1e9;  // largest depth of the hand
};

// Follows the path in steps of 1 ms.
inline Course course(const Trajectory& hand, double duration_s,
                     const std::function<Surface(double)>& surface_at,
                     const std::function<bool(double, double)>& is_object) {
  Course course;
  for (double t = 0; t < duration_s; t += 0.001) {
    const Vec3 p = hand.at(t).position_W;
    const double x = p.x() / p.z(), y = p.y() / p.z(), behind = p.z() - surface_at(t)(x, y);
    if (behind > course.deepest_m) course.deepest_m = behind;  // false if nothing is seen there
    if (behind > 0.005 && is_object(x, y)) course.on_object_s += 0.001;
    course.farthest_m = std::max(course.farthest_m, p.z());
  }
  return course;
}

inline Course course(const ImageScan& hand, const Surface& surface,
                     const std::function<bool(double, double)>& is_object) {
  return course(
      hand, hand.duration_s() + 0.1, [&](double) { return surface; }, is_object);
}

inline bool is_mug(double x, double y) {
  return std::isfinite(mug(x, y));
}

inline Kinds kinds(const Trajectory& hand) {
  return kinds_of(hand.notes());
}

}  // namespace remote_touch::harsh_images
