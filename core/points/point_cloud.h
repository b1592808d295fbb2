// A point cloud in columns, the colours of its points, and the pinhole camera and depth image that a cloud
// may come from. Camera frame C: x right, y down, z forward along the optical axis, metres; pixel (u, v) =
// (column, row), the centre of the first pixel is (0, 0).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/points/vector.h"

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
  std::vector<std::uint32_t> colour;      // 0xRRGGBB, or kNoColour; empty: no point has a colour
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

// The largest allowed distance of a scene and a hand from the origin of the world, along each axis. The
// method has absolute tolerances down to 1e-9 m. The spacing of doubles is 1e-13 m at this limit, but 1e-10 m
// at 1e6 m.
inline constexpr double kMaxCoordinate_m = 1000;

inline bool is_near_origin(const Vec3& p_W) {
  return p_W.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
}

// Returns true if there are measured points and all of them are beyond the limit. A few points beyond it do
// no harm.
inline bool is_far_from_origin(const PointCloud& cloud) {
  bool any = false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    if (is_near_origin(cloud.point(i))) return false;
    any = true;
  }
  return any;
}

// Returns the error message. what: the subject of the message, such as the scene.
inline std::string far_from_origin(const std::string& what) {
  return what + " more than " + std::to_string(static_cast<int>(kMaxCoordinate_m)) +
         " m from the origin along an axis: expected a scene and a hand near the origin";
}

// The value in the colour column of a cloud for a point whose colour is unknown.
inline constexpr std::uint32_t kNoColour = 0xFF000000;
// Returns the colour, 0xRRGGBB, in which a point is shown: a grey if its colour is unknown.
constexpr std::uint32_t shown_colour(std::uint32_t colour) {
  return colour == kNoColour ? 0x808080 : colour;
}

// Converts the bits of a 32-bit float, in which files and messages of clouds store 0xAARRGGBB, to 0xRRGGBB.
// The alpha value A is 0, or 255 where colours are opaque; many opaque colours are a NaN when they are read
// as a float. Another alpha value means that the float holds no colour, or is the NaN of a point without a
// colour: the result is kNoColour. 0xFFC00000 is kNoColour too, although it could be an opaque dark red: it
// is the NaN that an x86 processor computes, for example for 0.0 / 0.0.
std::uint32_t colour_of_float(std::uint32_t bits);

// The double cone (HSL). A grey has saturation 0 and no hue; its hue_deg is 0.
struct HueSaturationLightness {
  double hue_deg = 0;     // 0 red, 120 green, 240 blue; [0, 360)
  double saturation = 0;  // 0 to 1
  double lightness = 0;   // 0 black to 1 white
};

// rgb is 0xRRGGBB as the sensor reports it, without gamma correction or a colour profile.
HueSaturationLightness hue_saturation_lightness(std::uint32_t rgb);
// Returns the nearest colour with 8 bits per channel, 0xRRGGBB. pre: the values are in the ranges above; a
// hue of 360 is allowed and means 0.
std::uint32_t rgb(const HueSaturationLightness& colour);

// z_m[v * width + u] is the distance along the optical axis; NaN where the sensor measured nothing.
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<double> z_m;
};

// Returns the point that pixel (u, v) sees at depth z_m: x = (u - cx) z / fx, y = (v - cy) z / fy.
Vec3 unproject(const CameraIntrinsics& camera, double u, double v, double z_m);

// Returns the image size as text, such as "640 x 480 pixels".
std::string size_text(const CameraIntrinsics& camera);

// Returns the organised cloud of a depth image, in the world frame. A pixel without a measurement becomes a
// NaN point, never the origin. Throws std::invalid_argument if the image does not have the camera's size, or
// another number of depths than pixels.
PointCloud cloud_from_depth(const DepthImage& depth, const CameraIntrinsics& camera,
                            const RigidTransform& X_WC);

}  // namespace remote_touch
