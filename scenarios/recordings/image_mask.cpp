#include "scenarios/recordings/image_mask.h"

#include "scenarios/files/depth_images.h"

#include "scenarios/files/text_file.h"

namespace remote_touch {

Parameters parameters(ImageMask::Settings& s) {
  Parameters list = parameters(s.values);
  list.push_back(
      {"path", &s.path, 0, 0,
       "PNG file of the size of the frames; points at pixels that are neither black nor transparent are "
       "selected; up to 8 bits a channel"});
  return list;
}

std::string validate(const ImageMask::Settings& s) {
  if (s.path.empty()) return "path = \"\": expected a PNG file";
  return validate(s.values);
}

InputPart input_files(const ImageMask::Settings& s) {
  return {s.path};
}

ImageMask::ImageMask(const Settings& settings)
    : FixtureRule(settings.values),
      path_(settings.path),
      mask_(read_colour_png(find_input(settings.path), width_, height_)) {}

void ImageMask::require(const PointCloud& cloud) const {
  if (!cloud.image) refuse("image-mask", "the frame is not an image: expected a scenario with a camera");
  const CameraIntrinsics& camera = cloud.image->camera;
  if (camera.width != width_ || camera.height != height_)
    refuse(path_, width_, " x ", height_, " pixels: expected as many as the frames: ", camera.width, " x ",
           camera.height);
}

std::vector<double> ImageMask::weights(const PointCloud& cloud) const {
  require(cloud);
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    weights[i] = cloud.point(i).allFinite() && (mask_[i] & 0xFFFFFF) != 0 ? 1 : 0;
  return weights;
}

}  // namespace remote_touch
