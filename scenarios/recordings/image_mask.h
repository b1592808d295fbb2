// The points whose pixels a mask marks: the result of any segmentation, as an image.
#pragma once

#include "core/dissertation/virtual_fixtures/fixture_rule.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

class ImageMask final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    std::string path;
  };
  // Reads the mask: a PNG of any kind that read_colour_png takes, of the size of the frames; a pixel that is
  // neither black nor fully transparent selects its point. Throws InputError when it cannot be read.
  explicit ImageMask(const Settings& settings);
  // An image of the size of the mask.
  void require(const PointCloud& cloud) const override;
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  std::string path_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> mask_;
};

Parameters parameters(ImageMask::Settings& s);
std::string validate(const ImageMask::Settings& s);
RecordingPart input_files(const ImageMask::Settings& s);

}  // namespace remote_touch
