// Score of the agreement of a pixel mask with the true class of each pixel.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace remote_touch {

// found, missed and wrong count pixels with depth. Pixels of the class without depth cannot be points of a
// fixture and are counted separately.
struct SegmentationScore {
  int found = 0;   // pixels of the class that are selected
  int missed = 0;  // pixels of the class that are not selected
  int wrong = 0;   // selected pixels of another class
  int of_class_without_depth = 0;

  SegmentationScore& operator+=(const SegmentationScore& other);

  int selected() const { return found + wrong; }
  // Fractions; NaN if the denominator is 0: no pixel of the class, or none selected.
  double recall() const;          // selected fraction of the pixels of the class with depth
  double precision() const;       // fraction of the selected pixels that are of the class
  double depth_fraction() const;  // fraction of all pixels of the class that have a depth
  // Exact 95 % intervals of recall and precision, as if pixels were independent; [0, 1] if the denominator
  // is 0. They reflect the number of pixels only: a hue at the edge of a range is wrong for a whole surface
  // at once, and the same pixel in several frames is not several independent pixels.
  std::pair<double, double> recall_interval() const;
  std::pair<double, double> precision_interval() const;
};

// Counts the pixels. All three arguments have one entry for each pixel. Throws std::invalid_argument if their
// lengths differ.
SegmentationScore score_segmentation(const std::vector<char>& selected, const std::vector<char>& of_class,
                                     const std::vector<char>& has_depth);

}  // namespace remote_touch
