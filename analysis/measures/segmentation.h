// How well a mask of pixels agrees with the true class of each.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace remote_touch {

// Counts of pixels with depth; those without cannot be points of a fixture and are counted apart.
struct SegmentationScore {
  int right = 0;   // of the class, and picked
  int missed = 0;  // of the class, not picked
  int wrong = 0;   // picked, of another class
  int of_class_without_depth = 0;

  SegmentationScore& operator+=(const SegmentationScore& other);

  int picked() const { return right + wrong; }
  // Shares; NaN where there is nothing to share: no pixel of the class, nothing picked.
  double recall() const;          // of the pixels of the class with depth: picked
  double precision() const;       // of the pixels picked: of the class
  double depth_fraction() const;  // of all pixels of the class: with depth
  // Wilson's 95 % intervals of the first two, as if each pixel were decided by itself. They tell how many
  // pixels were counted; a hue at the edge of a range errs for a whole surface at once, and the same pixel in
  // several frames is not several pixels.
  std::pair<double, double> recall_interval() const;
  std::pair<double, double> precision_interval() const;
};

// An entry for each pixel in all three. Throws std::invalid_argument where they differ in length.
SegmentationScore score_segmentation(const std::vector<char>& picked, const std::vector<char>& of_class,
                                     const std::vector<char>& has_depth);

}  // namespace remote_touch
