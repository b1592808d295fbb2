#include "runners/trajectories/image_scan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

Parameters parameters(ImageScan::Settings& s) {
  return {
      {"row", &s.row, -1, 4095,
       "image row; -1: of the nearest large object, the row nearest to its middle that can be touched"},
      {"first_column", &s.first_column, -1, 4095,
       "first image column; -1: as far left as the depth stays within span_m"},
      {"last_column", &s.last_column, -1, 4095,
       "last image column; -1: as far right as the depth stays within span_m"},
      {"depth_m", &s.depth_m, -1, 1,
       "depth of the HIP behind the surface of the first frame, along the viewing ray"},
      {"speed_m_per_s", &s.speed_m_per_s, 1e-6, 100, "speed along the HIP's path"},
      {"clearance_m", &s.clearance_m, 0, 10,
       "distance in front of the surface at the start, at the end and over edges and holes"},
      {"span_m", &s.span_m, 1e-3, 100,
       "surfaces whose depth differs by more than this from that of the object are not touched, unless "
       "first_column and last_column are both given"},
      {"edge_jump_m", &s.edge_jump_m, 1e-4, 10,
       "depth difference of neighbouring pixels within margin_m above which there is an edge; doubled up to "
       "twice if no patch is left on the object"},
      {"bridge_m", &s.bridge_m, 0, 1,
       "used only if no patch is left on the object, for sparse depth: diameter of the largest hole that is taken as "
       "closed; a closed hole has the depth of the nearest pixel at its rim"},
      {"margin_m", &s.margin_m, 1e-3, 1, "minimum distance of the HIP from holes and depth edges"},
  };
}

std::string validate(const ImageScan::Settings& s) {
  const bool reversed = s.first_column >= 0 && s.last_column >= 0 && s.first_column >= s.last_column;
  return reversed ? "first_column = " + std::to_string(s.first_column) + ": expected below last_column" : "";
}

ImageScan::ImageScan(const Settings& s, const Scenario& scenario) : settings_(s), path_(Vec3::Zero()) {
  const PointCloud cloud = scenario.cloud(0);
  if (!cloud.image)
    throw InputError("trajectory.name = image-scan",
                     "the frames are not images: expected a scenario with a camera");
  const CameraIntrinsics& camera = cloud.image->camera;
  if (s.row >= camera.height || s.first_column >= camera.width || s.last_column >= camera.width)
    throw InputError(
        "trajectory.row, first_column, last_column",
        "expected below " + std::to_string(camera.height) + " and " + std::to_string(camera.width));
  const DepthImage image = depth_image(cloud);
  scan_ = find_scan_row(
      image, camera, {s.row, s.first_column, s.last_column, s.span_m, s.edge_jump_m, s.bridge_m, s.margin_m});
  if (scan_.patches.empty())
    throw InputError("trajectory.row = " + std::to_string(scan_.row),
                     std::string("no surface without edges and with holes of at most ") +
                         millimetres(s.bridge_m) + " in this row" +
                         (s.row < 0 ? " or another of the nearest object" : "") +
                         ": expected another row, a smaller margin_m or a larger bridge_m");
  plan_path(image, *cloud.image);
}

// Approaches the first patch, follows each, and flies from one to the next in front of all that is between.
void ImageScan::plan_path(const DepthImage& image, const ImageLayout& layout) {
  const Settings& s = settings_;
  const CameraIntrinsics& camera = layout.camera;
  const auto depth_at = [&](int u) { return scan_.depth_m[static_cast<std::size_t>(u)]; };
  const auto place = [&](int u, double offset) {
    const double z = depth_at(u) + offset;
    if (!(z > 0))
      throw InputError("trajectory.clearance_m, depth_m", "the hand would be behind the camera, which is " +
                                                              millimetres(depth_at(u)) +
                                                              " from the surface: expected smaller values");
    return Vec3(layout.X_WC * unproject(camera, u, scan_.row, z));
  };
  // The offset from the surface at column u of a flight between two columns, in front of both surfaces and of
  // all pixels between them.
  const auto flight_offset = [&](int u, int from, int to) {
    const double other = depth_at(u == from ? to : from);
    const double planned = std::min(other - depth_at(u), 0.0) - s.clearance_m;
    const int half =
        std::max(1, static_cast<int>(camera.fx * s.margin_m / std::min(depth_at(from), depth_at(to))));
    const double nearest = nearest_depth(image, {from, to, scan_.row - half, scan_.row + half});
    // Nearer than an edge's jump the hand could touch; farther in front it needs no detour.
    if (nearest - (depth_at(u) + planned) >= s.edge_jump_m) return planned;
    return in_front_of(nearest, s.clearance_m) - depth_at(u);
  };

  path_ = PolylinePath(place(scan_.patches.front().first_column, -s.clearance_m));
  for (std::size_t i = 0; i < scan_.patches.size(); ++i) {
    const ScanPatch& patch = scan_.patches[i];
    for (int u = patch.first_column; u <= patch.last_column; ++u) {
      path_.go_to(place(u, s.depth_m), s.speed_m_per_s);
      if (u == patch.first_column) touches_.push_back({path_.duration_s(), 0});
    }
    touches_.back().ends_s = path_.duration_s();
    path_.go_to(place(patch.last_column, -s.clearance_m), s.speed_m_per_s);
    if (i + 1 == scan_.patches.size()) break;
    const int from = patch.last_column, to = scan_.patches[i + 1].first_column;
    path_.go_to(place(from, flight_offset(from, from, to)), s.speed_m_per_s);
    path_.go_to(place(to, flight_offset(to, from, to)), s.speed_m_per_s);
    path_.go_to(place(to, -s.clearance_m), s.speed_m_per_s);
  }
}

// The depth that is followed is the median over the margin; what one pixel shows may differ by an edge's
// jump.
std::optional<SurfacePlan> ImageScan::surface_plan(double time_s) const {
  const bool touches = std::any_of(touches_.begin(), touches_.end(), [&](const Interval& touch) {
    return touch.begins_s <= time_s && time_s <= touch.ends_s;
  });
  return SurfacePlan{touches, std::min(settings_.depth_m, 0.0) - scan_.edge_jump_m,
                     std::max(settings_.depth_m, 0.0) + scan_.edge_jump_m, 0.5 * settings_.bridge_m};
}

std::vector<Note> ImageScan::notes() const {
  std::vector<Note> notes;
  const std::string row = "row " + std::to_string(scan_.row);
  if (scan_.bridges_holes)
    notes.push_back({"holes bridged", row + ": holes up to trajectory.bridge_m = " +
                                          millimetres(settings_.bridge_m) + " wide are taken as closed"});
  if (scan_.edge_jump_m > settings_.edge_jump_m)
    notes.push_back({"edges bridged", row + ": depth jumps up to " + millimetres(scan_.edge_jump_m) +
                                          " between neighbouring pixels are taken as surface, more than "
                                          "trajectory.edge_jump_m = " +
                                          millimetres(settings_.edge_jump_m)});
  if (!scan_.is_on_object && settings_.row < 0)
    notes.push_back(
        {"object not scanned",
         row + ": the nearest object has no surface without holes and edges; only others are touched"});
  return notes;
}

}  // namespace remote_touch
