// Converts depth images of a lens that distorts to those of a pinhole camera at the same position.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"

namespace remote_touch {

// A lens as the library of its camera describes it. A ray is (x / z, y / z) in the optical frame; integers
// are the centres of pixels. A map returns none if the lens sees nothing there.
struct Lens {
  using Map = std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d&)>;
  Map pixel_of_ray, ray_of_pixel;
};

// The pinhole image has the size of the camera's, and both have the same rays at the ends of the middle row
// and of the middle column. So a lens without distortion changes nothing. The corners of a wide lens may be
// lost, and the middle of its image has fewer pixels than in the camera's image.
class Undistortion {
 public:
  // Throws InputError with this name if the lens maps rays and pixels in ways that contradict each other.
  Undistortion(const std::string& name, int width, int height, const Lens& lens);

  const CameraIntrinsics& camera() const { return camera_; }
  // Converts the camera's depth along its axis to that of the pinhole image, in the same unit; 0: nothing
  // measured. On a surface the depth is interpolated between the four nearest pixels. If one of them is
  // missing or on another surface, the nearest is used, so that no point lies between two surfaces. seen: one
  // number for each pixel of the camera.
  void apply(const std::vector<std::uint16_t>& seen, std::vector<std::uint16_t>& depth) const;

 private:
  // The upper left one of four pixels, and the distance from it to the position, right and down, in pixels.
  struct Place {
    std::int32_t pixel;  // below 0: the lens sees nothing there
    float right, down;
  };

  void choose_camera(const std::string& name, const Lens& lens);
  std::optional<Eigen::Vector2d> seen_at(int u, int v, const Lens& lens) const;
  Place place_of(const std::optional<Eigen::Vector2d>& seen) const;
  std::uint16_t depth_at(const std::vector<std::uint16_t>& seen, const Place& place) const;

  CameraIntrinsics camera_;
  std::vector<Place> places_;  // one for every pixel; empty: the two images are the same
};

}  // namespace remote_touch
