#include "runners/experiment/hand/image_motions.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

constexpr const char* kSubject = "trajectory.name = image-press";

std::string pixel_text(int row, int column) {
  return "row " + std::to_string(row) + ", column " + std::to_string(column);
}

// Returns the runs of columns that have a depth, if they are at least margin_m long.
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

class RowSearch {
 public:
  RowSearch(const DepthImage& image, const CameraIntrinsics& camera, const ScanRowRequest& request)
      : image_(image, camera, request.bridge_m), camera_(camera), request_(request) {
    first_ = request.first_column >= 0 ? request.first_column : 0;
    last_ = request.last_column >= 0 ? request.last_column : image.width - 1;
    object_ = nearest_large_object(image_, camera);
    is_object_.assign(image.z_m.size(), 0);
    for (const int pixel : object_.pixels) is_object_[static_cast<std::size_t>(pixel)] = 1;
  }

  ScanRow best() {
    std::optional<ScanRow> first_found;
    for (const double factor : {1, 2, 4})
      for (const bool bridges : {false, true}) {
        if (bridges && !(request_.bridge_m > 0)) continue;
        for (const int row : rows()) {
          if (first_found && !can_touch_object(row, factor * request_.edge_jump_m, bridges)) continue;
          ScanRow found = attempt(row, factor * request_.edge_jump_m, bridges);
          if (found.patches.empty()) continue;
          if (found.is_on_object || !on_object(row, {first_, last_})) return found;
          if (!first_found) first_found = std::move(found);
        }
      }
    return first_found.value_or(
        ScanRow{request_.row >= 0 ? request_.row : object_.row, {}, {}, 0, false, false, false});
  }

 private:
  bool on_object(int row, const ScanPatch& patch) const {
    const auto begin = is_object_.begin() + static_cast<std::ptrdiff_t>(row) * camera_.width;
    return std::find(begin + patch.first_column, begin + patch.last_column + 1, 1) !=
           begin + patch.last_column + 1;
  }

  std::vector<int> rows() const {
    if (request_.row >= 0) return {request_.row};
    std::vector<int> rows;
    for (int row = 0; row < camera_.height; ++row)
      if (on_object(row, {first_, last_})) rows.push_back(row);
    std::stable_sort(rows.begin(), rows.end(),
                     [&](int a, int b) { return std::abs(a - object_.row) < std::abs(b - object_.row); });
    return rows.empty() ? std::vector<int>{object_.row} : rows;
  }

  bool is_within_span(double depth_m) const {
    const bool is_given = request_.first_column >= 0 && request_.last_column >= 0;
    return is_given || std::abs(depth_m - object_.nearest_depth_m) <= request_.span_m;
  }

  double surface_depth(int u, int row, double edge_jump_m, bool bridges) {
    const DepthImage& image = bridges ? image_.closed() : image_.measured();
    const double z = supported_depth(image, u, row, camera_, {edge_jump_m, request_.margin_m});
    return is_within_span(z) ? z : std::nan("");
  }

  // Returns true if the row has a pixel of the object that can be touched. The test is cheap for an object
  // without a surface, because supported_depth() returns at the first hole.
  bool can_touch_object(int row, double edge_jump_m, bool bridges) {
    for (int u = first_; u <= last_; ++u)
      if (is_object_[static_cast<std::size_t>(row) * camera_.width + u] &&
          std::isfinite(surface_depth(u, row, edge_jump_m, bridges)))
        return true;
    return false;
  }

  ScanRow attempt(int row, double edge_jump_m, bool bridges) {
    ScanRow found{row, {}, {}, edge_jump_m, bridges, false, object_.is_whole_scene};
    for (int u = 0; u < camera_.width; ++u)
      found.depth_m.push_back(surface_depth(u, row, edge_jump_m, bridges));
    found.patches = supported_patches(found.depth_m, first_, last_, camera_.fx, request_.margin_m);
    found.is_on_object = std::any_of(found.patches.begin(), found.patches.end(),
                                     [&](const ScanPatch& patch) { return on_object(row, patch); });
    return found;
  }

  BridgeableImage image_;
  const CameraIntrinsics& camera_;
  const ScanRowRequest& request_;
  int first_ = 0, last_ = 0;
  NearestObject object_;
  std::vector<char> is_object_;
};

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

ScanRow find_scan_row(const DepthImage& image, const CameraIntrinsics& camera,
                      const ScanRowRequest& request) {
  return RowSearch(image, camera, request).best();
}

Parameters parameters(ImageScan::Settings& s) {
  return {
      {"row", &s.row, -1, 4095,
       "image row; -1: the row nearest to the middle of the nearest large object, among those that can be touched"},
      {"first_column", &s.first_column, -1, 4095,
       "first image column; -1: as far left as the depth stays within span_m"},
      {"last_column", &s.last_column, -1, 4095,
       "last image column; -1: as far right as the depth stays within span_m"},
      {"depth_m", &s.depth_m, -1, 1,
       "depth of the HIP behind the surface of the first frame, along the axis of the camera"},
      {"speed_m_per_s", &s.speed_m_per_s, 1e-6, 100, "speed along the HIP's path"},
      {"clearance_m", &s.clearance_m, 0, 10,
       "distance in front of the surface at the start, at the end and over edges and holes, along the axis of the "
       "camera"},
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
  const FrameImage first = first_image(scenario, "trajectory.name = image-scan");
  const CameraIntrinsics& camera = first.layout.camera;
  if (s.row >= camera.height || s.first_column >= camera.width || s.last_column >= camera.width)
    refuse("trajectory.row, first_column, last_column", "expected below ", camera.height, " and ",
           camera.width);
  scan_ = find_scan_row(first.depth, camera, s);
  if (scan_.patches.empty()) refuse_row(first.depth, camera);
  if (s.row < 0) note_missed_object(first.depth, camera);
  plan_path(first.depth, first.layout);
}

// Throws InputError, because the row has no patch to touch. The row -1 is proposed only if it gives a patch.
void ImageScan::refuse_row(const DepthImage& image, const CameraIntrinsics& camera) const {
  std::string expected = "a smaller margin_m or a larger bridge_m";
  if (settings_.row < 0) {
    expected = "another row, " + expected;
  } else {
    ScanRowRequest request = settings_;
    request.row = -1;
    const ScanRow other = find_scan_row(image, camera, request);
    expected = (other.patches.empty() ? "another row, "
                                      : "-1 (the nearest object: row " + std::to_string(other.row) + "), ") +
               expected;
  }
  refuse("trajectory.row = " + std::to_string(scan_.row),
         "the first frame has no surface that can be touched in this row",
         settings_.row < 0 ? " or another of the nearest object" : "",
         " (without edges, without holes above ", millimetres(settings_.bridge_m), "): expected ", expected);
}

// Sets missed_object_ for a row that was chosen from the image, in two cases. The row touches other surfaces
// but not the nearest object. Or there is no large object, and a small object is nearer than everything that
// the row touches.
void ImageScan::note_missed_object(const DepthImage& image, const CameraIntrinsics& camera) {
  const std::string row = "row " + std::to_string(scan_.row);
  if (!scan_.is_on_object) {
    missed_object_ =
        row + ": the nearest object has no surface without holes and edges; only others are touched";
  } else if (scan_.is_whole_scene) {
    std::vector<int> touched;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const ScanPatch& patch : scan_.patches)
      for (int u = patch.first_column; u <= patch.last_column; ++u) {
        touched.push_back(scan_.row * camera.width + u);
        nearest_m = std::min(nearest_m, scan_.depth_m[static_cast<std::size_t>(u)]);
      }
    const auto nearer = nearer_small_object(image, camera, touched, nearest_m);
    if (nearer) missed_object_ = row + " is scanned, but " + text_of_nearer(*nearer);
  }
}

// Plans a path that approaches the first patch, follows each patch, and flies to the next one in front of
// everything between them.
void ImageScan::plan_path(const DepthImage& image, const ImageLayout& layout) {
  const Settings& s = settings_;
  const CameraIntrinsics& camera = layout.camera;
  const auto depth_at = [&](int u) { return scan_.depth_m[static_cast<std::size_t>(u)]; };
  const auto position = [&](int u, double offset) {
    const double z = depth_at(u) + offset;
    if (!(z > 0)) refuse_behind_camera(depth_at(u));
    return Vec3(layout.X_WC * unproject(camera, u, scan_.row, z));
  };
  // Returns the offset from the surface at column u, which is `from` or `to`, for a flight between these two
  // columns. The flight is in front of both surfaces and of all pixels between them.
  const auto flight_offset = [&](int u, int from, int to) {
    const double other = depth_at(u == from ? to : from);
    const double planned = std::min(other - depth_at(u), 0.0) - s.clearance_m;
    const int half = reach_px(image, camera.fy, s.margin_m, std::min(depth_at(from), depth_at(to)));
    const double nearest = nearest_depth(image, {from, to, scan_.row - half, scan_.row + half});
    // No detour is needed if the hand is at least edge_jump_m in front of the nearest pixel. A hand that is
    // nearer could touch it.
    if (nearest - (depth_at(u) + planned) >= s.edge_jump_m) return planned;
    return in_front_of(nearest, s.clearance_m) - depth_at(u);
  };

  path_ = PolylinePath(position(scan_.patches.front().first_column, -s.clearance_m));
  for (std::size_t i = 0; i < scan_.patches.size(); ++i) {
    const ScanPatch& patch = scan_.patches[i];
    for (int u = patch.first_column; u <= patch.last_column; ++u) {
      path_.go_to(position(u, s.depth_m), s.speed_m_per_s);
      if (u == patch.first_column) touches_.push_back({path_.duration_s(), 0});
    }
    touches_.back().ends_s = path_.duration_s();
    path_.go_to(position(patch.last_column, -s.clearance_m), s.speed_m_per_s);
    if (i + 1 == scan_.patches.size()) break;
    const int from = patch.last_column, to = scan_.patches[i + 1].first_column;
    path_.go_to(position(from, flight_offset(from, from, to)), s.speed_m_per_s);
    path_.go_to(position(to, flight_offset(to, from, to)), s.speed_m_per_s);
    path_.go_to(position(to, -s.clearance_m), s.speed_m_per_s);
  }
}

// The path follows the median of the depths over the margin. The depth of a single pixel may differ from it
// by edge_jump_m, so this tolerance is added to the plan.
std::optional<SurfacePlan> ImageScan::surface_plan(double time_s) const {
  const bool touches = std::ranges::any_of(
      touches_, [&](const Interval& touch) { return touch.begins_s <= time_s && time_s <= touch.ends_s; });
  return SurfacePlan{touches, std::min(settings_.depth_m, 0.0) - scan_.edge_jump_m,
                     std::max(settings_.depth_m, 0.0) + scan_.edge_jump_m, 0.5 * settings_.bridge_m};
}

std::string ImageScan::aim() const {
  constexpr std::size_t kMostPatches = 8;  // a noisy row may have many: the line stays readable
  std::string text = "image-scan, row " + std::to_string(scan_.row);
  for (std::size_t i = 0; i < std::min(kMostPatches, scan_.patches.size()); ++i) {
    const ScanPatch& patch = scan_.patches[i];
    const auto begin = scan_.depth_m.begin();
    const auto [least, most] = std::minmax_element(begin + patch.first_column, begin + patch.last_column + 1);
    text += formatted(", columns %d to %d at depth %.3f to %.3f m", patch.first_column, patch.last_column,
                      *least, *most);
  }
  if (scan_.patches.size() > kMostPatches)
    text += ", and " + std::to_string(scan_.patches.size() - kMostPatches) + " more parts of the row";
  return text;
}

std::vector<Note> ImageScan::notes() const {
  std::vector<Note> notes;
  const std::string row = "row " + std::to_string(scan_.row);
  if (scan_.bridges_holes) notes.push_back(holes_bridged(row, settings_.bridge_m));
  if (scan_.edge_jump_m > settings_.edge_jump_m)
    notes.push_back({"edges bridged", row + ": depth jumps up to " + millimetres(scan_.edge_jump_m) +
                                          " between neighbouring pixels are taken as surface, more than "
                                          "trajectory.edge_jump_m = " +
                                          millimetres(settings_.edge_jump_m)});
  if (!missed_object_.empty()) notes.push_back({"object not scanned", missed_object_});
  return notes;
}

}  // namespace remote_touch
