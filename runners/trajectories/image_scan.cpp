#include "runners/trajectories/image_scan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parameters/input_error.h"
#include "runners/trajectories/nearest_object.h"
#include "runners/trajectories/surface_support.h"

namespace remote_touch {

Parameters parameters(ImageScan::Settings& s) {
  return {
      {"row", &s.row, -1, 4095, "image row; -1: the middle of the nearest large object"},
      {"first_column", &s.first_column, -1, 4095,
       "first image column; -1: as far left as the depth stays within span_m"},
      {"last_column", &s.last_column, -1, 4095,
       "last image column; -1: as far right as the depth stays within span_m"},
      {"depth_m", &s.depth_m, -1, 1,
       "depth of the HIP behind the surface of the first frame, along the viewing ray"},
      {"speed_m_per_s", &s.speed_m_per_s, 1e-6, 100, "speed along the HIP's path"},
      {"clearance_m", &s.clearance_m, 0, 10, "distance in front of the surface at the start and at the end"},
      {"span_m", &s.span_m, 1e-3, 100,
       "the scan ends where the depth differs by more than this from that of the object"},
      {"edge_jump_m", &s.edge_jump_m, 1e-4, 10,
       "depth difference of neighbouring pixels within margin_m above which there is an edge; doubled up to twice if no pixel is left"},
      {"margin_m", &s.margin_m, 1e-3, 1, "minimum distance of the HIP from holes and depth edges"},
  };
}

std::string validate(const ImageScan::Settings& s) {
  const bool reversed = s.first_column >= 0 && s.last_column >= 0 && s.first_column >= s.last_column;
  return reversed ? "first_column = " + std::to_string(s.first_column) + ": expected below last_column" : "";
}

namespace {

// The column farthest from the middle, in one direction, whose depth is within the span of the object's.
int last_within_span(const std::vector<double>& depth, int from, int direction, double reference,
                     double span_m) {
  int last = from;
  for (int u = from; u >= 0 && u < static_cast<int>(depth.size()); u += direction) {
    const double z = depth[static_cast<std::size_t>(u)];
    if (std::isfinite(z) && std::abs(z - reference) <= span_m) last = u;
  }
  return last;
}

// Runs of columns with support, at least as long as the margin.
std::vector<ScanPatch> supported_patches(const std::vector<double>& depth, int first, int last, double focal,
                                         double margin_m) {
  std::vector<ScanPatch> patches;
  for (int u = first; u <= last; ++u) {
    if (std::isnan(depth[static_cast<std::size_t>(u)])) continue;
    ScanPatch patch{u, u};
    while (patch.last_column < last && std::isfinite(depth[static_cast<std::size_t>(patch.last_column + 1)]))
      ++patch.last_column;
    const double pixels = focal * margin_m / depth[static_cast<std::size_t>(u)];
    if (patch.last_column - patch.first_column >= pixels) patches.push_back(patch);
    u = patch.last_column;
  }
  return patches;
}

}  // namespace

ImageScan::ImageScan(const Settings& s, const Scenario& scenario) : path_(Vec3::Zero()) {
  const PointCloud cloud = scenario.cloud(0);
  if (!cloud.image)
    throw InputError("trajectory.name = image-scan",
                     "the frames are not images: expected a scenario with a camera");
  const CameraIntrinsics& camera = cloud.image->camera;
  const DepthImage image = depth_image(cloud);
  const NearestObject object = nearest_large_object(image, camera);
  row_ = s.row >= 0 ? s.row : object.row;
  if (row_ >= camera.height || s.first_column >= camera.width || s.last_column >= camera.width)
    throw InputError(
        "trajectory.row, first_column, last_column",
        "expected below " + std::to_string(camera.height) + " and " + std::to_string(camera.width));

  // A coarse sensor steps further from pixel to pixel than a proxy can bridge; better a rough scan than none.
  std::vector<double> depth;
  for (double jump = s.edge_jump_m; patches_.empty() && jump <= 4 * s.edge_jump_m; jump *= 2) {
    depth.clear();
    for (int u = 0; u < camera.width; ++u)
      depth.push_back(supported_depth(image, u, row_, camera.fx, {jump, s.margin_m}));
    const auto automatic = [&](int direction) {
      return last_within_span(depth, object.column, direction, object.nearest_depth_m, s.span_m);
    };
    patches_ = supported_patches(depth, s.first_column >= 0 ? s.first_column : automatic(-1),
                                 s.last_column >= 0 ? s.last_column : automatic(+1), camera.fx, s.margin_m);
  }
  if (patches_.empty())
    throw InputError("trajectory.row = " + std::to_string(row_),
                     "no surface without holes in this row: expected another row or a smaller margin_m");

  const auto place = [&](int u, double offset) {
    return Vec3(cloud.image->X_WC * unproject(camera, u, row_, depth[static_cast<std::size_t>(u)] + offset));
  };
  path_ = PolylinePath(place(patches_.front().first_column, -s.clearance_m));
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const ScanPatch& patch = patches_[i];
    for (int u = patch.first_column; u <= patch.last_column; ++u)
      path_.go_to(place(u, s.depth_m), s.speed_m_per_s);
    path_.go_to(place(patch.last_column, -s.clearance_m), s.speed_m_per_s);
    if (i + 1 == patches_.size()) break;
    // Across in front of both patches: towards the camera first, where the next one is nearer.
    const int from = patch.last_column, to = patches_[i + 1].first_column;
    const double step = depth[static_cast<std::size_t>(to)] - depth[static_cast<std::size_t>(from)];
    path_.go_to(place(from, std::min(step, 0.0) - s.clearance_m), s.speed_m_per_s);
    path_.go_to(place(to, std::min(-step, 0.0) - s.clearance_m), s.speed_m_per_s);
    path_.go_to(place(to, -s.clearance_m), s.speed_m_per_s);
  }
}

}  // namespace remote_touch
