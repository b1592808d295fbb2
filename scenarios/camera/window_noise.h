// Noise of the pixels of an image that is correlated as the results of a matching window are: the windows of
// neighbouring pixels overlap.
#pragma once

#include <vector>

#include "core/kernels/kernels.h"
#include "core/kernels/noise_kernels.h"

namespace remote_touch {

// Standard normals of all pixels, row by row.
struct WindowNoise {
  // Correlated: two pixels that are (i, j) pixels apart have the correlation
  // (1 - |i| / window) (1 - |j| / window), and 0 from a distance of window on.
  std::vector<double> averaged;
  // Independent of each other, of other pixels and, for a window of 1, of averaged. Empty if not wanted.
  std::vector<double> across, down;
};

// The result is a pure function of its arguments. `averaged` is the sum of independent normals over the
// window's pixels, divided by the window's width. A window reaches beyond the image, so that pixels at the
// border have the same noise as others. Pre: width, height and window_px are 1 or more.
WindowNoise window_noise(int width, int height, int window_px, bool also_independent,
                         const NoiseStream& stream, const Kernels& kernels);

}  // namespace remote_touch
