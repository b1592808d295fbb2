// Two published ways from a depth image to normals, written from their equations: 3F2N (Fan, Wang, Xue, Huang
// and Liu, Three-Filters-to-Normal, 2021) and D2NT (Feng, Xue, Liu, Chen and Fan, D2NT, 2023). The file also
// has the box filter that a user would put before them. They use one thread, and loops that a compiler turns
// into vectors.
#pragma once

#include <vector>

namespace remote_touch::peers {

struct DepthOfCamera {
  int width, height;
  float focal, cx, cy;
  std::vector<float> z_m;  // all pixels are measured
};

// The mean over window x window pixels by running sums, whose time does not depend on the window. The window
// ends with the image at the border. It is odd, and 1 leaves the image as it is.
class BoxFilter {
 public:
  void run(const DepthOfCamera& from, int window, std::vector<float>& to);

 private:
  std::vector<double> columns_;
};

// 3F2N: n_x = f d(1/Z)/du, n_y = f d(1/Z)/dv by central differences, and n_z the mean, or the median, of
// -(n_x dX + n_y dY) / dZ over the 8 neighbours.
// D2NT: n = (f dZ/du, f dZ/dv, -(Z + (u - cx) dZ/du + (v - cy) dZ/dv)). If the gradients are aware of
// discontinuities, each derivative is the mean of the differences to the pixel on either side, weighted by
// the inverse of the second difference at that pixel. If it is refined, every pixel then receives the normal
// of that pixel, among itself and its 4 neighbours, whose depth is nearest to the mean of its own 4
// neighbours (the paper's Markov random field).
enum class Translator { three_filters_mean, three_filters_median, d2nt, d2nt_discontinuities, d2nt_refined };

class NormalTranslator {
 public:
  // normals has three numbers per pixel, unit length, any sign. It is NaN in the outermost two rows and
  // columns (three if refined). pre: normals is empty, or holds the output of run() for an image of the same
  // size in the same way.
  void run(Translator how, const DepthOfCamera& camera, const std::vector<float>& z_m,
           std::vector<float>& normals);

 private:
  void refine(const DepthOfCamera& camera, const std::vector<float>& z_m, std::vector<float>& normals);

  std::vector<float> unrefined_;  // normals
  std::vector<float> bend_m_;  // three rows: distance of a depth from the mean of its 4 neighbours, times 4
  std::vector<int> away_;      // one row: offset to the pixel whose normal is used
};

}  // namespace remote_touch::peers
