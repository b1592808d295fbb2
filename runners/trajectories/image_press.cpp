#include "runners/trajectories/image_press.h"

#include <algorithm>
#include <cmath>

#include "core/parameters/input_error.h"
#include "runners/trajectories/nearest_object.h"
#include "runners/trajectories/surface_support.h"

namespace remote_touch {

Parameters parameters(ImagePress::Settings& s) {
  return {
      {"row", &s.row, -1, 4095, "image row; -1: the middle of the nearest large object"},
      {"column", &s.column, -1, 4095, "image column; -1: the middle of the nearest large object"},
      {"depth_m", &s.depth_m, -1, 1,
       "depth of the HIP behind the surface of the newest frame, along the viewing ray"},
      {"clearance_m", &s.clearance_m, 0, 10, "distance in front of the surface while waiting and lifted"},
      {"press_at_s", &s.press_at_s, 0, 1e6, "time at which the approach starts"},
      {"approach_m_per_s", &s.approach_m_per_s, 1e-6, 100, "speed of the approach"},
      {"edge_jump_m", &s.edge_jump_m, 1e-4, 10,
       "a depth difference larger than this within margin_m is an edge"},
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
  const NearestObject object = nearest_large_object(depth_image(cloud), image_.camera);
  row_ = settings.row >= 0 ? settings.row : object.row;
  column_ = settings.column >= 0 ? settings.column : object.column;
  if (row_ >= image_.camera.height || column_ >= image_.camera.width)
    throw InputError("trajectory.row, column", "expected below " + std::to_string(image_.camera.height) +
                                                   " and " + std::to_string(image_.camera.width));
  if (std::isnan(surface_depth(0)))
    throw InputError(
        "trajectory.row = " + std::to_string(row_) + ", column = " + std::to_string(column_),
        "no surface without holes at this pixel of the first frame: expected another pixel or a smaller margin_m");
}

double ImagePress::surface_depth(int frame) const {
  const auto known = depths_.find(frame);
  if (known != depths_.end()) return known->second;
  const Support support{settings_.edge_jump_m, settings_.margin_m};
  return depths_[frame] =
             supported_depth(depth_image(scenario_.cloud(frame)), column_, row_, image_.camera.fx, support);
}

DeviceState ImagePress::at(double time_s) const {
  const double travelled = settings_.approach_m_per_s * std::max(0.0, time_s - settings_.press_at_s);
  double offset = std::min(travelled - settings_.clearance_m, settings_.depth_m);
  int frame = scenario_.newest_frame(time_s);
  if (std::isnan(surface_depth(frame))) offset = -settings_.clearance_m;
  while (std::isnan(surface_depth(frame))) --frame;  // ends at frame 0, which the constructor checked
  return {image_.X_WC * unproject(image_.camera, column_, row_, surface_depth(frame) + offset)};
}

}  // namespace remote_touch
