#include "runners/experiment/hand/nearest_object.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/numeric/order_statistic.h"

namespace remote_touch {

namespace {

constexpr int kTrials = 300;  // planes tried; one with a fifth of the points is found with probability 0.91
constexpr int kStride = 4;    // every 4th pixel in both directions is sampled
constexpr double kPlaneFraction = 0.2;    // least share of the measured points in the scene's plane
constexpr double kObjectFraction = 0.01;  // least share of the image in a large object
constexpr double kContinuous_m = 0.01;    // depth difference between neighbouring pixels of one object

struct Plane {
  Vec3 normal;
  double offset;
  // True if p is near enough to belong to the plane: sensor noise grows with the square of the depth.
  bool holds(const Vec3& p) const { return std::abs(normal.dot(p) - offset) < 0.008 + 0.005 * p.z() * p.z(); }
  // True if p is on the side of the camera, which is at the origin.
  bool is_camera_side(const Vec3& p) const { return (normal.dot(p) - offset) * offset < 0; }
};

std::vector<Vec3> sample(const DepthImage& image, const CameraIntrinsics& camera) {
  std::vector<Vec3> points;
  for (int v = 0; v < image.height; v += kStride)
    for (int u = 0; u < image.width; u += kStride) {
      const double z = image.z_m[static_cast<std::size_t>(v) * image.width + u];
      if (std::isfinite(z)) points.push_back(unproject(camera, u, v, z));
    }
  return points;
}

// Returns the plane with the most points, if it has more than kPlaneFraction of them. It is found by random
// sample consensus with a fixed sequence (a linear congruential generator).
std::optional<Plane> dominant_plane(const std::vector<Vec3>& points) {
  if (points.size() < 3) return std::nullopt;
  std::uint64_t state = 1;
  const auto pick = [&]() -> const Vec3& {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return points[(state >> 33) % points.size()];
  };
  std::optional<Plane> best;
  std::size_t max = static_cast<std::size_t>(kPlaneFraction * static_cast<double>(points.size()));
  for (int trial = 0; trial < kTrials; ++trial) {
    const Vec3 &a = pick(), &b = pick(), &c = pick();
    const Vec3 across = (b - a).cross(c - a);
    if (!(across.norm() > 1e-4)) continue;  // nearly in line
    const Plane plane{across.normalized(), across.normalized().dot(a)};
    const auto inliers = static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [&](const Vec3& p) { return plane.holds(p); }));
    if (inliers > max) max = inliers, best = plane;
  }
  return best;
}

enum class Joined { by_sides, also_diagonally };

// Returns the pixels of the patch of continuous depth that contains `seed`, and removes them from `open`.
std::vector<int> take_patch(const DepthImage& image, int seed, std::vector<char>& open,
                            Joined joined = Joined::by_sides) {
  std::vector<int> patch{seed};
  open[static_cast<std::size_t>(seed)] = 0;
  for (std::size_t next = 0; next < patch.size(); ++next) {
    const int i = patch[next], u = i % image.width;
    const auto visit = [&](int neighbour) {
      const auto n = static_cast<std::size_t>(neighbour);
      if (!open[n] || std::abs(image.z_m[n] - image.z_m[static_cast<std::size_t>(i)]) > kContinuous_m) return;
      open[n] = 0;
      patch.push_back(neighbour);
    };
    if (u > 0) visit(i - 1);
    if (u + 1 < image.width) visit(i + 1);
    if (i >= image.width) visit(i - image.width);
    const bool has_below = i + image.width < image.width * image.height;
    if (has_below) visit(i + image.width);
    if (joined == Joined::by_sides) continue;
    for (const int step : {-1, 1}) {
      if (u + step < 0 || u + step >= image.width) continue;
      if (i >= image.width) visit(i - image.width + step);
      if (has_below) visit(i + image.width + step);
    }
  }
  return patch;
}

// Returns the area that the pixels see, computed as if the surface faced the camera.
double area_m2(const DepthImage& image, const CameraIntrinsics& camera, const std::vector<int>& patch) {
  double area = 0;
  for (const int i : patch) {
    const double z = image.z_m[static_cast<std::size_t>(i)];
    area += z * z / (camera.fx * camera.fy);
  }
  return area;
}

// Returns true if more than half of the pixels are on the camera's side of the plane.
bool is_patch_in_front(const Plane& plane, const DepthImage& image, const CameraIntrinsics& camera,
                       const std::vector<int>& patch) {
  const auto is_on_camera_side = [&](int i) {
    const int row = i / image.width, column = i % image.width;
    return plane.is_camera_side(unproject(camera, column, row, image.z_m[static_cast<std::size_t>(i)]));
  };
  const auto count = std::count_if(patch.begin(), patch.end(), is_on_camera_side);
  return 2 * static_cast<std::size_t>(count) > patch.size();
}

NearestObject describe(const DepthImage& image, const std::vector<int>& patch) {
  std::vector<double> depth, rows, columns;
  for (const int i : patch) {
    depth.push_back(image.z_m[static_cast<std::size_t>(i)]);
    const int row = i / image.width, column = i % image.width;
    rows.push_back(row), columns.push_back(column);
  }
  return {quantile_in_place(depth, 0.05), static_cast<int>(median_in_place(rows)),
          static_cast<int>(median_in_place(columns)), patch, false};
}

}  // namespace

NearestObject nearest_large_object(const DepthImage& image, const CameraIntrinsics& camera) {
  const std::optional<Plane> plane = dominant_plane(sample(image, camera));
  std::vector<char> open(image.z_m.size(), 0);
  std::vector<int> measured;
  for (int i = 0; i < image.width * image.height; ++i) {
    const double z = image.z_m[static_cast<std::size_t>(i)];
    if (!std::isfinite(z)) continue;
    measured.push_back(i);
    const int row = i / image.width, column = i % image.width;
    open[static_cast<std::size_t>(i)] = !plane || !plane->holds(unproject(camera, column, row, z));
  }
  if (measured.empty()) return {0, 0, 0, {}, true};

  std::optional<NearestObject> in_front, behind;
  for (const int seed : measured) {
    if (!open[static_cast<std::size_t>(seed)]) continue;
    const std::vector<int> patch = take_patch(image, seed, open);
    if (static_cast<double>(patch.size()) < kObjectFraction * static_cast<double>(image.z_m.size())) continue;
    NearestObject object = describe(image, patch);
    object.is_behind_plane = plane && !is_patch_in_front(*plane, image, camera, patch);
    std::optional<NearestObject>& nearest = object.is_behind_plane ? behind : in_front;
    if (!nearest || object.nearest_depth_m < nearest->nearest_depth_m) nearest = std::move(object);
  }
  if (in_front) return *in_front;
  if (behind) return *behind;
  NearestObject scene = describe(image, measured);
  scene.is_whole_scene = true;
  return scene;
}

NearestObject nearest_large_object(BridgeableImage& image, const CameraIntrinsics& camera) {
  NearestObject object = nearest_large_object(image.measured(), camera);
  NearestObject closed = nearest_large_object(image.closed(), camera);
  if (closed.is_whole_scene || object.is_whole_scene) return closed.is_whole_scene ? object : closed;
  if (closed.is_behind_plane != object.is_behind_plane) return closed.is_behind_plane ? object : closed;
  // An object is nearer only if the difference is larger: closing the holes of one and the same object moves
  // its nearest part by less.
  return closed.nearest_depth_m < object.nearest_depth_m - kContinuous_m ? closed : object;
}

std::string text_of_nearer(const NearestObject& object) {
  return "an object at row " + std::to_string(object.row) + ", column " + std::to_string(object.column) +
         " is nearer, at " + millimetres(object.nearest_depth_m) +
         "; it does not fill 1 % of the image without gaps";
}

std::optional<NearestObject> nearer_small_object(const DepthImage& image, const CameraIntrinsics& camera,
                                                 const std::vector<int>& touched, double touched_depth_m) {
  constexpr double kMinArea_m2 = 0.02 * 0.02;
  const std::optional<Plane> plane = dominant_plane(sample(image, camera));
  const auto is_in_front = [&](const Vec3& p) {
    return !plane || (plane->is_camera_side(p) && !plane->holds(p));
  };
  std::vector<char> open(image.z_m.size(), 0);
  for (int i = 0; i < image.width * image.height; ++i) {
    const int u = i % image.width, v = i / image.width;
    const double z = image.z_m[static_cast<std::size_t>(i)];
    open[static_cast<std::size_t>(i)] = std::isfinite(z) && is_in_front(unproject(camera, u, v, z));
  }
  for (const int pixel : touched)
    if (open[static_cast<std::size_t>(pixel)]) take_patch(image, pixel, open, Joined::also_diagonally);

  std::optional<NearestObject> nearest;
  for (int i = 0; i < image.width * image.height; ++i) {
    if (!open[static_cast<std::size_t>(i)]) continue;
    const std::vector<int> patch = take_patch(image, i, open, Joined::also_diagonally);
    if (area_m2(image, camera, patch) < kMinArea_m2) continue;
    NearestObject object = describe(image, patch);
    if (object.nearest_depth_m < (nearest ? nearest->nearest_depth_m : touched_depth_m - kContinuous_m))
      nearest = std::move(object);
  }
  return nearest;
}

}  // namespace remote_touch
