// Fixture rule that selects the points whose pixels are marked in a mask: an image that any segmentation may
// have made.
#pragma once

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

class ImageMask final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    std::string path;
  };
  // Reads the mask: a PNG of any kind that read_colour_png() accepts, of the size of the frames. A pixel that
  // is neither black nor fully transparent selects its point. Throws InputError if the file cannot be read.
  explicit ImageMask(const Settings& settings);
  // Throws InputError unless the cloud is an image of the size of the mask.
  void require(const PointCloud& cloud) const override;
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  std::string path_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> mask_;
};

Parameters parameters(ImageMask::Settings& s);
std::string validate(const ImageMask::Settings& s);
InputPart input_files(const ImageMask::Settings& s);

}  // namespace remote_touch
