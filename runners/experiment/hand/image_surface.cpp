#include "runners/experiment/hand/image_motions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/points/number_columns.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {
namespace {

// Returns the depth image of the cloud. All pixels are NaN if the cloud does not have a point per pixel.
DepthImage depth_of(const PointCloud& cloud, const ImageLayout& layout) {
  const CameraIntrinsics& camera = layout.camera;
  const RigidTransform X_CW = layout.X_WC.inverse();
  DepthImage depth{camera.width, camera.height, std::vector<double>(camera.pixels(), std::nan(""))};
  if (cloud.size() != depth.z_m.size()) return depth;
  for (std::size_t i = 0; i < cloud.size(); ++i) depth.z_m[i] = (X_CW * cloud.point(i)).z();
  return depth;
}

// Returns why the first frame of the scenario is no image, and what is expected.
std::string no_image_text(const Scenario& scenario, const PointCloud& cloud) {
  if (scenario.input().empty())
    return "the scene has no camera: expected a scenario with one (recording, mesh-scene, camera-scene, "
           "beating-heart, valve-tank)";
  if (cloud.grid_columns == 0) return "the frames are not images: expected a recording with a camera";
  return "the rows and columns of the recording are no image of a camera: expected clouds in the frame of "
         "the camera that are not mirrored";
}

bool is_measured(const DepthImage& image, int u, int v) {
  return std::isfinite(image.z_m[static_cast<std::size_t>(v) * image.width + u]);
}

// Returns the finite depths in the part of the window that is in the image.
std::vector<double> depths_in(const DepthImage& image, const PixelWindow& window) {
  std::vector<double> depths;
  for (int v = std::max(0, window.first_row); v <= std::min(image.height - 1, window.last_row); ++v)
    for (int u = std::max(0, window.first_column); u <= std::min(image.width - 1, window.last_column); ++u)
      if (is_measured(image, u, v))
        depths.push_back(image.z_m[static_cast<std::size_t>(v) * image.width + u]);
  return depths;
}

// Returns true if a hole in the image is at most one pixel away, also diagonally.
bool is_rim(const DepthImage& image, int u, int v) {
  for (int y = std::max(0, v - 1); y <= std::min(image.height - 1, v + 1); ++y)
    for (int x = std::max(0, u - 1); x <= std::min(image.width - 1, u + 1); ++x)
      if (!is_measured(image, x, y)) return true;
  return false;
}

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

FrameImage first_image(const Scenario& scenario, const std::string& subject) {
  const PointCloud cloud = scenario.cloud(0);
  if (!cloud.image) refuse(subject, no_image_text(scenario, cloud));
  if (cloud.size() != cloud.image->camera.pixels())
    refuse(subject, "frame 0 has ", cloud.size(), " points: expected ", size_text(cloud.image->camera));
  if (!cloud.has_measured_point())
    refuse(subject, "no pixel of the first frame has a depth: expected a camera that sees a surface");
  return {*cloud.image, depth_of(cloud, *cloud.image)};
}

void require_image_of(const ImageLayout& first, const PointCloud& frame, int number,
                      const std::string& subject) {
  constexpr double kFits_px = 1;
  const auto refuse_frame = [&](const std::string& problem) {
    refuse(subject, "frame ", number, " ", problem);
  };
  const CameraIntrinsics& camera = first.camera;
  if (!frame.has_measured_point()) return;
  const bool has_size = !frame.image || (frame.image->camera.width == camera.width &&
                                         frame.image->camera.height == camera.height);
  if (!has_size || frame.size() != camera.pixels())
    refuse_frame("has " +
                 (has_size ? std::to_string(frame.size()) + " points" : size_text(frame.image->camera)) +
                 ": expected " + size_text(camera) + ", as frame 0 has");
  if (frame.image && frame.image->camera == camera) return;  // the layout promises that the points fit
  const RigidTransform& X_WC = frame.image ? frame.image->X_WC : first.X_WC;
  const double error_px = largest_error_px(frame, X_WC.inverse(), camera);
  if (error_px <= kFits_px + first.pixel_slack + (frame.image ? frame.image->pixel_slack : 0)) return;
  if (!frame.image)
    refuse_frame("is not an image: expected an image of the camera of frame 0 in every frame");
  refuse_frame(formatted(
      "has another camera (f = %.6g, %.6g, c = %.6g, %.6g): expected that of frame 0 (f = %.6g, %.6g, "
      "c = %.6g, %.6g)",
      frame.image->camera.fx, frame.image->camera.fy, frame.image->camera.cx, frame.image->camera.cy,
      camera.fx, camera.fy, camera.cx, camera.cy));
}

FrameImage image_of(const Scenario& scenario, int frame, const ImageLayout& first,
                    const std::string& subject) {
  const PointCloud cloud = scenario.cloud(frame);
  require_image_of(first, cloud, frame, subject);
  ImageLayout layout = first;
  if (cloud.image) layout.X_WC = cloud.image->X_WC;
  return {layout, depth_of(cloud, layout)};
}

double supported_depth(const DepthImage& image, int u, int v, const CameraIntrinsics& camera,
                       const Support& support) {
  if (u < 0 || v < 0 || u >= image.width || v >= image.height) return std::nan("");
  const double z = image.z_m[static_cast<std::size_t>(v) * image.width + u];
  if (!(std::isfinite(z) && z > 0)) return std::nan("");
  const int across = reach_px(image, camera.fx, support.margin_m, z);
  const int down = reach_px(image, camera.fy, support.margin_m, z);
  if (u <= across || v <= down || u + across >= image.width || v + down >= image.height) return std::nan("");
  std::vector<double> seen;
  for (int y = v - down; y <= v + down; ++y) {
    for (int x = u - across; x <= u + across; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * image.width + x;
      // NaN fails both comparisons, so a hole ends the search too.
      const bool joined = std::abs(image.z_m[i] - image.z_m[i - 1]) <= support.edge_jump_m &&
                          std::abs(image.z_m[i] - image.z_m[i - image.width]) <= support.edge_jump_m;
      if (!joined) return std::nan("");
      seen.push_back(image.z_m[i]);
    }
  }
  return median_in_place(seen);
}

int reach_px(const DepthImage& image, double focal_px, double length_m, double depth_m) {
  if (!(depth_m > 0)) return 1;
  const double most = std::max({1, image.width, image.height});
  return static_cast<int>(std::clamp(focal_px * length_m / depth_m, 1.0, most));
}

std::optional<ImagePixel> nearest_supported(const DepthImage& image, const ImagePixel& to,
                                            const CameraIntrinsics& camera, const Support& support) {
  std::optional<ImagePixel> nearest;
  long least = std::numeric_limits<long>::max();
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const long across = u - to.column, down = v - to.row, squared = across * across + down * down;
      if (squared >= least || std::isnan(supported_depth(image, u, v, camera, support))) continue;
      least = squared;
      nearest = ImagePixel{v, u};
    }
  return nearest;
}

// Distances are in pixels along a row.
DepthImage bridged(const DepthImage& image, const CameraIntrinsics& camera, double hole_m) {
  constexpr double kMaxReach_px = 64;  // bounds the work for points close to the lens
  const double row_distance = camera.fx / camera.fy;
  DepthImage closed = image;
  std::vector<double> distance_squared(image.z_m.size(), std::numeric_limits<double>::infinity());
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const double z = image.z_m[static_cast<std::size_t>(v) * image.width + u];
      if (!(std::isfinite(z) && z > 0) || !is_rim(image, u, v)) continue;
      const double reach = std::min(0.5 * hole_m * camera.fx / z, kMaxReach_px);
      const int across = static_cast<int>(reach);
      const int down = static_cast<int>(std::min(reach / row_distance, kMaxReach_px));
      for (int y = std::max(0, v - down); y <= std::min(image.height - 1, v + down); ++y)
        for (int x = std::max(0, u - across); x <= std::min(image.width - 1, u + across); ++x) {
          const double below = (y - v) * row_distance, squared = (x - u) * (x - u) + below * below;
          const std::size_t i = static_cast<std::size_t>(y) * image.width + x;
          if (squared > reach * reach || std::isfinite(image.z_m[i]) || squared > distance_squared[i])
            continue;
          if (squared == distance_squared[i] && z >= closed.z_m[i]) continue;
          distance_squared[i] = squared, closed.z_m[i] = z;
        }
    }
  return closed;
}

const DepthImage& BridgeableImage::closed() {
  if (!closed_) closed_ = bridged(measured_, camera_, hole_m_);
  return *closed_;
}

double nearest_depth(const DepthImage& image, const PixelWindow& window) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const double z : depths_in(image, window)) nearest = std::min(nearest, z);
  return nearest;
}

double median_depth(const DepthImage& image, const PixelWindow& window) {
  std::vector<double> depths = depths_in(image, window);
  return depths.empty() ? std::nan("") : median_in_place(depths);
}

double in_front_of(double depth_m, double clearance_m) {
  return std::max(depth_m - clearance_m, 0.5 * depth_m);
}

std::string millimetres(double length_m) {
  return formatted("%.4g mm", 1e3 * length_m);
}

void refuse_behind_camera(double surface_m) {
  refuse("trajectory.clearance_m, depth_m", "the hand would be behind the camera, which is ",
         millimetres(surface_m), " from the surface: expected smaller values");
}

Note holes_bridged(const std::string& where, double bridge_m) {
  return {"holes bridged", where + ": holes up to trajectory.bridge_m = " + millimetres(bridge_m) +
                               " wide are taken as closed"};
}

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
