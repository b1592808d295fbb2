// Two published ways from a depth image to normals, written from their equations: 3F2N (Fan, Wang, Xue, Huang
// and Liu, Three-Filters-to-Normal, 2021) and D2NT (Feng, Xue, Liu, Chen and Fan, D2NT, 2023). With
// the box filter that a user would put before them. One thread; loops that a compiler turns into vectors.
#pragma once

#include <vector>

namespace remote_touch::peers {

struct DepthOfCamera {
  int width, height;
  float focal, cx, cy;
  std::vector<float> z_m;  // all measured
};

// Mean over window x window pixels by running sums: its time does not depend on the window. At the border the
// window ends with the image. window odd; 1 leaves the image as it is.
class BoxFilter {
 public:
  void run(const DepthOfCamera& from, int window, std::vector<float>& to);

 private:
  std::vector<double> columns_;
};

// 3F2N: n_x = f d(1/Z)/du, n_y = f d(1/Z)/dv by central differences, and n_z the mean, or the median, of
// -(n_x dX + n_y dY) / dZ over the 8 neighbours.
// D2NT: n = (f dZ/du, f dZ/dv, -(Z + (u - cx) dZ/du + (v - cy) dZ/dv)); with the discontinuity-aware
// gradients each derivative is the mean of the differences to the pixel on either side, weighted by the
// inverse of the second difference at that pixel. Refined: every pixel then takes the normal of that pixel,
// among itself and its 4 neighbours, whose depth is nearest to the mean of its own 4 neighbours (the paper's
// Markov random field).
enum class Translator { three_filters_mean, three_filters_median, d2nt, d2nt_discontinuities, d2nt_refined };

class NormalTranslator {
 public:
  // normals: three numbers a pixel, unit length, any sign; NaN in the outermost two rows and columns
  // (refined: three). pre: normals is empty, or what run() wrote for an image of the same size in the same
  // way.
  void run(Translator how, const DepthOfCamera& camera, const std::vector<float>& z_m,
           std::vector<float>& normals);

 private:
  void refine(const DepthOfCamera& camera, const std::vector<float>& z_m, std::vector<float>& normals);

  std::vector<float> unrefined_;  // normals
  std::vector<float> bend_m_;  // three rows: distance of a depth from the mean of its 4 neighbours, times 4
  std::vector<int> away_;      // one row: offset to the pixel whose normal is taken
};

}  // namespace remote_touch::peers
