#include "runners/trajectories/image_press.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/parameters/input_error.h"
#include "runners/trajectories/nearest_object.h"

namespace remote_touch {

Parameters parameters(ImagePress::Settings& s) {
  return {
      {"row", &s.row, -1, 4095,
       "image row; -1: of the nearest large object, the pixel nearest to its middle that can be touched"},
      {"column", &s.column, -1, 4095, "image column; -1: as for row"},
      {"depth_m", &s.depth_m, -1, 1,
       "depth of the HIP behind the surface of the newest frame, along the viewing ray"},
      {"clearance_m", &s.clearance_m, 0, 10, "distance in front of the surface while waiting and lifted"},
      {"press_at_s", &s.press_at_s, 0, 1e6, "time at which the approach starts"},
      {"approach_m_per_s", &s.approach_m_per_s, 1e-6, 100, "speed of the approach"},
      {"edge_jump_m", &s.edge_jump_m, 1e-4, 10,
       "a depth difference larger than this within margin_m is an edge"},
      {"bridge_m", &s.bridge_m, 0, 1,
       "used only if the first frame has no surface without holes there, for sparse depth: diameter of the largest "
       "hole that is taken as closed; a closed hole has the depth of the nearest pixel at its rim"},
      {"margin_m", &s.margin_m, 1e-3, 1, "minimum distance of the HIP from holes and depth edges"},
  };
}

ImagePress::ImagePress(const Settings& settings, const Scenario& scenario)
    : settings_(settings), scenario_(scenario) {
  const PointCloud cloud = scenario.cloud(0);
  if (!cloud.image)
    throw InputError("trajectory.name = image-press",
                     "the frames are not images: expected a scenario with a camera");
  image_ = *cloud.image;
  if (settings.row >= image_.camera.height || settings.column >= image_.camera.width)
    throw InputError("trajectory.row, column", "expected below " + std::to_string(image_.camera.height) +
                                                   " and " + std::to_string(image_.camera.width));
  choose_pixel(BridgeableImage(depth_image(cloud), image_.camera.fx, settings.bridge_m));
  const double surface_m = seen(0).supported_m;
  if (std::isnan(surface_m))
    throw InputError("trajectory.row = " + std::to_string(row_) + ", column = " + std::to_string(column_),
                     "no surface without edges and with holes of at most " + millimetres(settings.bridge_m) +
                         " at this pixel of the first frame: expected another pixel, a smaller margin_m or a "
                         "larger bridge_m");
  if (!(settings.clearance_m < surface_m && -settings.depth_m < surface_m))
    throw InputError("trajectory.clearance_m, depth_m", "the hand would be behind the camera, which is " +
                                                            millimetres(surface_m) +
                                                            " from the surface: expected smaller values");
}

bool ImagePress::has_support(const DepthImage& image, int pixel) const {
  const int u = pixel % image.width, v = pixel / image.width;
  return std::isfinite(
      supported_depth(image, u, v, image_.camera.fx, {settings_.edge_jump_m, settings_.margin_m}));
}

// The pixel of the nearest large object that is nearest to its middle and can be touched, without closed
// holes if possible. A row or a column that is given is kept. Without such a pixel: the middle, which cannot
// be touched or is not of the object.
void ImagePress::choose_pixel(BridgeableImage image) {
  row_ = settings_.row, column_ = settings_.column;
  NearestObject object;
  if (row_ < 0 || column_ < 0) object = nearest_large_object(image, image_.camera);
  if (row_ < 0) row_ = object.row;
  if (column_ < 0) column_ = object.column;

  const int width = image_.camera.width;
  std::vector<int> candidates;
  std::copy_if(object.pixels.begin(), object.pixels.end(), std::back_inserter(candidates), [&](int pixel) {
    return (settings_.row < 0 || pixel / width == row_) && (settings_.column < 0 || pixel % width == column_);
  });
  if (candidates.empty()) candidates.push_back(row_ * width + column_);
  std::sort(candidates.begin(), candidates.end(), [&](int a, int b) {
    const auto square_distance = [&](int pixel) {
      const int across = pixel % width - column_, down = pixel / width - row_;
      return across * across + down * down;
    };
    return std::pair(square_distance(a), a) < std::pair(square_distance(b), b);
  });
  for (const bool bridges : {false, true}) {
    const DepthImage& surface = bridges ? image.closed() : image.measured();
    const auto found = std::find_if(candidates.begin(), candidates.end(),
                                    [&](int pixel) { return has_support(surface, pixel); });
    if (found == candidates.end()) continue;
    row_ = *found / width, column_ = *found % width;
    bridges_holes_ = bridges;
    return;
  }
}

const ImagePress::Seen& ImagePress::seen(int frame) const {
  const auto known = seen_.find(frame);
  if (known != seen_.end()) return known->second;
  const double focal_px = image_.camera.fx;
  const DepthImage measured = depth_image(scenario_.cloud(frame));
  Seen now;
  now.supported_m =
      supported_depth(bridges_holes_ ? bridged(measured, focal_px, settings_.bridge_m) : measured, column_,
                      row_, focal_px, {settings_.edge_jump_m, settings_.margin_m});
  // A frame that shows a hole there has the margin of the first frame.
  double z = measured.z_m[static_cast<std::size_t>(row_) * measured.width + column_];
  if (!std::isfinite(z) && frame != 0) z = seen(0).supported_m;
  const auto around = [&](double radius_m) {
    const int half = std::isfinite(z) ? std::max(1, static_cast<int>(focal_px * radius_m / z)) : 1;
    return PixelWindow{column_ - half, column_ + half, row_ - half, row_ + half};
  };
  now.shown_m = median_depth(measured, around(0.5 * settings_.bridge_m));
  now.nearest_m = nearest_depth(measured, around(std::max(settings_.margin_m, 0.5 * settings_.bridge_m)));
  return seen_[frame] = now;
}

double ImagePress::travelled_m(double time_s) const {
  return settings_.approach_m_per_s * std::max(0.0, time_s - settings_.press_at_s);
}

double ImagePress::lifted_depth(double planned_m, const Seen& newest) const {
  const double surface_m = std::isnan(newest.shown_m) ? newest.nearest_m : newest.shown_m;
  const double allowed_m = std::max(settings_.depth_m, 0.0) + settings_.edge_jump_m;  // as in surface_plan()
  if (planned_m - surface_m <= allowed_m) return planned_m;
  return in_front_of(newest.nearest_m, settings_.clearance_m);
}

DeviceState ImagePress::at(double time_s) const {
  const int newest = scenario_.newest_frame(time_s);
  int frame = newest;
  while (std::isnan(seen(frame).supported_m)) --frame;  // ends at frame 0, which the constructor checked
  const double surface_m = seen(frame).supported_m;
  const bool is_lifted = frame != newest;
  const double offset_m = is_lifted
                              ? -settings_.clearance_m
                              : std::min(travelled_m(time_s) - settings_.clearance_m, settings_.depth_m);
  double z = surface_m + offset_m;
  if (!(z > 0)) z = 0.5 * surface_m;  // the surface came so near that the clearance does not fit
  if (is_lifted) z = lifted_depth(z, seen(newest));
  return {image_.X_WC * unproject(image_.camera, column_, row_, z)};
}

std::optional<SurfacePlan> ImagePress::surface_plan(double time_s) const {
  return SurfacePlan{travelled_m(time_s) >= settings_.clearance_m,
                     std::min(settings_.depth_m, 0.0) - settings_.edge_jump_m,
                     std::max(settings_.depth_m, 0.0) + settings_.edge_jump_m, 0.5 * settings_.bridge_m};
}

std::vector<Note> ImagePress::notes() const {
  if (!bridges_holes_) return {};
  return {{"holes bridged", "pixel " + std::to_string(column_) + ", " + std::to_string(row_) +
                                ": holes up to trajectory.bridge_m = " + millimetres(settings_.bridge_m) +
                                " wide are taken as closed"}};
}

}  // namespace remote_touch
