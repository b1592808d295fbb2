// A point cloud in columns, and the image layout of a cloud that comes from an image.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// Pinhole intrinsics in pixels; no distortion.
struct CameraIntrinsics {
  int width = 0;
  int height = 0;
  double fx = 0, fy = 0;
  double cx = 0, cy = 0;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  bool operator==(const CameraIntrinsics&) const = default;
};

// Promises that point v * width + u lies on the viewing ray of pixel (u, v), within pixel_slack pixels.
struct ImageLayout {
  CameraIntrinsics camera;
  RigidTransform X_WC = RigidTransform::Identity();
  double pixel_slack = 0;
};

// Columns of equal length. Positions are metres in the world frame; a missing measurement is NaN in all three
// coordinates, so that it fails every distance test. Optional columns are empty or as long as the positions.
struct PointCloud {
  std::vector<double> x, y, z;
  std::vector<double> fixture_radius_m;   // r_f of (5.2), 0 or more; empty: 0, which is chapter 4
  std::vector<double> stiffness_N_per_m;  // k_s of (5.3), 0 to 2^20; empty or NaN: the renderer's own
  std::vector<std::uint32_t> colour;      // 0xRRGGBB, or kNoColour of colour.h; empty: no point has a colour
  // Unit normals of the surface, towards the side that the sensor sees, 6.2.1; empty: none. NaN in all three
  // where a point has no normal.
  std::vector<double> nx, ny, nz;
  std::optional<ImageLayout> image;  // set when the points are the pixels of one image
  // Number of columns if the points form a grid, stored row by row like the pixels of an image. 0 means
  // unorganised: it is not known which points are neighbours.
  int grid_columns = 0;

  std::size_t size() const { return x.size(); }
  bool is_measured(std::size_t i) const {
    return std::isfinite(x[i]) && std::isfinite(y[i]) && std::isfinite(z[i]);
  }
  bool has_measured_point() const {
    for (std::size_t i = 0; i < size(); ++i)
      if (is_measured(i)) return true;
    return false;
  }
  bool has_normals() const { return !nx.empty(); }
  // Number of columns of the image or grid; 0: unorganised.
  int columns() const { return image ? image->camera.width : grid_columns; }
  Vec3 point(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }
  void append(const Vec3& p) { x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z()); }
  void append(const Vec3& p, const Vec3& normal) {
    append(p);
    nx.push_back(normal.x()), ny.push_back(normal.y()), nz.push_back(normal.z());
  }
};

}  // namespace remote_touch
