#include "runners/experiment/hand/image_press.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "runners/experiment/hand/image_surface.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

namespace {

constexpr const char* kSubject = "trajectory.name = image-press";

std::string pixel_text(int row, int column) {
  return "row " + std::to_string(row) + ", column " + std::to_string(column);
}

}  // namespace

Parameters parameters(ImagePress::Settings& s) {
  return {
      {"row", &s.row, -1, 4095,
       "image row; -1: row of the pixel nearest to the middle of the nearest large object, among those that can be "
       "touched"},
      {"column", &s.column, -1, 4095, "image column; -1: as for row"},
      {"depth_m", &s.depth_m, -1, 1,
       "depth of the HIP behind the surface of the newest frame, along the axis of the camera"},
      {"clearance_m", &s.clearance_m, 0, 10,
       "distance in front of the surface while waiting and lifted, along the axis of the camera"},
      {"press_at_s", &s.press_at_s, 0, 1e6, "time at which the approach starts"},
      {"approach_m_per_s", &s.approach_m_per_s, 1e-6, 100,
       "speed of the approach, along the axis of the camera"},
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
  FrameImage first = first_image(scenario, kSubject);
  image_ = first.layout;
  if (settings.row >= image_.camera.height || settings.column >= image_.camera.width)
    refuse("trajectory.row, column", "expected below ", image_.camera.height, " and ", image_.camera.width);
  BridgeableImage image(std::move(first.depth), image_.camera, settings.bridge_m);
  const NearestObject object = choose_pixel(image);
  const double surface_m = seen(0).supported_m;
  if (std::isnan(surface_m)) refuse_pixel(image);
  if (!object.pixels.empty()) note_missed_object(object, image.measured());
  if (!(settings.clearance_m < surface_m && -settings.depth_m < surface_m)) refuse_behind_camera(surface_m);
}

bool ImagePress::has_support(const DepthImage& image, int pixel) const {
  const int u = pixel % image.width, v = pixel / image.width;
  return std::isfinite(supported_depth(image, u, v, image_.camera, support()));
}

// Sets row_ and column_ to the pixel to press: the pixel of the nearest large object that can be touched and
// is nearest to the middle of the object. Pixels that can be touched without closed holes are preferred. A
// row or a column that the settings give is kept. If there is no such pixel, the middle is set, which cannot
// be touched or does not belong to the object. Returns the object; it has no pixels if the settings give both
// row and column.
NearestObject ImagePress::choose_pixel(BridgeableImage& image) {
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
    break;
  }
  return object;
}

// Throws InputError, because the first frame shows no surface at the pixel. A pixel or the object is proposed
// only if it can be touched.
void ImagePress::refuse_pixel(BridgeableImage& image) const {
  std::string expected = "a smaller margin_m or a larger bridge_m";
  for (const bool bridges : {false, true}) {
    const DepthImage& surface = bridges ? image.closed() : image.measured();
    const auto nearest = nearest_supported(surface, {row_, column_}, image_.camera, support());
    if (!nearest) continue;
    expected = "the nearest pixel that can be touched, " + pixel_text(nearest->row, nearest->column) +
               ", or " + expected;
    const std::vector<int> object = nearest_large_object(image, image_.camera).pixels;
    if (settings_.row >= 0 && settings_.column >= 0 &&
        std::any_of(object.begin(), object.end(), [&](int pixel) { return has_support(surface, pixel); }))
      expected = "-1 for both (the nearest object), " + expected;
    break;
  }
  refuse(
      "trajectory.row = " + std::to_string(row_) + ", column = " + std::to_string(column_),
      "the first frame has no surface that can be touched at this pixel (without edges, without holes above ",
      millimetres(settings_.bridge_m), "): expected ", expected);
}

// Sets missed_object_ if a pixel that was chosen from the image presses something other than the nearest
// object.
void ImagePress::note_missed_object(const NearestObject& object, const DepthImage& measured) {
  const int pixel = row_ * image_.camera.width + column_;
  const std::string pressed = pixel_text(row_, column_) + " is pressed, but ";
  if (object.is_whole_scene) {
    const auto nearer = nearer_small_object(measured, image_.camera, {pixel}, seen(0).supported_m);
    if (nearer) missed_object_ = pressed + text_of_nearer(*nearer);
  } else if (std::find(object.pixels.begin(), object.pixels.end(), pixel) == object.pixels.end()) {
    missed_object_ = pressed + "the nearest object is around " + pixel_text(object.row, object.column) +
                     ", and cannot be touched there";
  }
}

const ImagePress::Seen& ImagePress::seen(int frame) const {
  const auto known = seen_.find(frame);
  if (known != seen_.end()) return known->second;
  const CameraIntrinsics& camera = image_.camera;
  const FrameImage image = image_of(scenario_, frame, image_, kSubject);
  const DepthImage& measured = image.depth;
  Seen now;
  now.X_WC = image.layout.X_WC;
  now.supported_m = supported_depth(bridges_holes_ ? bridged(measured, camera, settings_.bridge_m) : measured,
                                    column_, row_, camera, support());
  // A later frame with a hole at the pixel uses the depth of the first frame, to convert the margins to
  // pixels.
  double z = measured.z_m[static_cast<std::size_t>(row_) * measured.width + column_];
  if (!std::isfinite(z) && frame != 0) z = seen(0).supported_m;
  const auto around = [&](double radius_m) {
    const int across = reach_px(measured, camera.fx, radius_m, z);
    const int down = reach_px(measured, camera.fy, radius_m, z);
    return PixelWindow{column_ - across, column_ + across, row_ - down, row_ + down};
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
  const double allowed_m = std::max(settings_.depth_m, 0.0) + settings_.edge_jump_m;  // see surface_plan()
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
  return {seen(newest).X_WC * unproject(image_.camera, column_, row_, z)};
}

std::optional<SurfacePlan> ImagePress::surface_plan(double time_s) const {
  // A hand that lifts off or comes back moves along the ray by depth_m and clearance_m in one tick. The
  // surface may have moved meanwhile: by up to 46 mm in the recordings of a camera that is carried by hand.
  constexpr double kSurfaceMoves_m = 0.1;
  const double step_m = std::abs(settings_.depth_m) + settings_.clearance_m + kSurfaceMoves_m;
  return SurfacePlan{travelled_m(time_s) >= settings_.clearance_m,
                     std::min(settings_.depth_m, 0.0) - settings_.edge_jump_m,
                     std::max(settings_.depth_m, 0.0) + settings_.edge_jump_m, 0.5 * settings_.bridge_m,
                     step_m * unproject(image_.camera, column_, row_, 1).norm()};
}

std::string ImagePress::aim() const {
  return "image-press, " + pixel_text(row_, column_) + formatted(" at depth %.3f m", seen(0).supported_m);
}

std::vector<Note> ImagePress::notes() const {
  std::vector<Note> notes;
  if (bridges_holes_)
    notes.push_back(
        holes_bridged("pixel " + std::to_string(column_) + ", " + std::to_string(row_), settings_.bridge_m));
  if (!missed_object_.empty()) notes.push_back({"object not pressed", missed_object_});
  return notes;
}

}  // namespace remote_touch
