// Measures of images: the errors of depth images, and the agreement of masks.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "analysis/trace/interval_estimates.h"
#include "core/points/point_cloud.h"

namespace remote_touch {

// Statistics of the errors of depth images: noise, steps of depth, and holes beside depth edges. They use the
// images alone, so that simulated and real sensors are measured by one code.

// Sensors that triangulate measure the inverse depth 1 / z: a disparity is focal length times baseline times
// 1 / z. Therefore noise and steps are those of the inverse depth, in 1/m. Times z^2 they are metres of
// depth, times focal length and baseline they are pixels of disparity.
struct DepthNoise {
  double depth_m = kNoValue;
  double per_m = kNoValue;  // standard deviation of 1 / z
  double in_m() const { return per_m * depth_m * depth_m; }
};

// Returns the noise over time of each pixel that every frame measured, from its frames. Throws
// std::invalid_argument unless there are two frames or more, of one size.
std::vector<DepthNoise> temporal_noise(std::span<const DepthImage> frames);

// A square of measured pixels, and the plane nearest to it: planes are linear in 1 / z over the pixels.
struct FittedWindow {
  int u = 0, v = 0, width_px = 0;           // (u, v): the first pixel
  double inverse_per_m = 0;                 // inverse depth of the plane, in the middle of the window
  double across_per_m = 0, down_per_m = 0;  // change of 1 / z from pixel to pixel
  DepthNoise noise;  // rms of the pixels about the plane, with width_px^2 - 3 degrees of freedom

  double depth_at(int column, int row) const;  // depth of the plane; columns and rows of the image
};
// Divides the image into squares from its first pixel on, and fits a plane to each square without holes.
// Pre: width_px >= 2.
std::vector<FittedWindow> fitted_windows(const DepthImage& depth, int width_px);

// Returns the noise that the given share of the samples with a depth in [near_m, far_m) does not exceed, and
// the mean of their depths. NaN if there are fewer than 20 samples.
DepthNoise noise_quantile(std::span<const DepthNoise> samples, double near_m, double far_m, double share);

// Returns the step of 1 / z between the depths in [near_m, far_m) that occur: the mean over the steps that
// are at most twice the median step, because depths that no pixel shows leave gaps. NaN if fewer than 10
// depths occur. If depths are also rounded to a unit that is larger than the step, it is the step of that
// unit.
double depth_step_per_m(std::span<const DepthImage> frames, double near_m, double far_m);

// Two successive measured pixels of a row at different depths, with the holes between them.
struct DepthEdge {
  bool is_left_of_near = false;  // true: the nearer surface is on the right, and the holes to its left
  double jump_per_m = 0;         // difference of 1 / z, positive
  int hole_px = 0;
};
// Returns the edges with a jump of min_jump_per_m or more, in the order of rows and columns.
std::vector<DepthEdge> depth_edges(const DepthImage& depth, double min_jump_per_m);

// Returns the edges on one side of the nearer surface with a jump in [low_per_m, high_per_m).
std::vector<DepthEdge> edges_between(std::span<const DepthEdge> edges, bool is_left_of_near, double low_per_m,
                                     double high_per_m);
// Returns the share of the edges at which the pixel so many pixels beyond the nearer surface, counted from 1,
// is a hole. NaN without edges.
double hole_fraction(std::span<const DepthEdge> edges, int distance_px);
// Returns the median of the widths of holes. NaN if there are fewer than 20 edges.
double median_hole_px(std::span<const DepthEdge> edges);

// Score of the agreement of a pixel mask with the true class of each pixel.

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
