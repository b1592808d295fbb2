#include "runners/experiment/hand/scan_row.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "runners/experiment/hand/nearest_object.h"

namespace remote_touch {

namespace {

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

ScanRow find_scan_row(const DepthImage& image, const CameraIntrinsics& camera,
                      const ScanRowRequest& request) {
  return RowSearch(image, camera, request).best();
}

}  // namespace remote_touch
