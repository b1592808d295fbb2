// Normals of pixels whose own window extends over an edge, taken from windows beside the pixel: the planes on
// both sides of a crease or an occlusion edge are fitted best by windows that end there. A choice among
// shifted windows has been used to keep edges in images since Kuwahara, Hachimura, Eiho and Kinoshita (1976).
// The kernel computes 16, 8 or 4 pixels of a row at a time.
#include "core/kernels/depth_kernels.h"
#include "core/kernels/float_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

// The limit of the ratio of two mean square errors. Noise alone seldom makes the error of one window a
// quarter of another's, and on a ball the errors are similar.
constexpr float kClearlyLess = 0.25f;

struct Choice {
  Floats error, x, y, z;
};

}  // namespace

void sharp_normals(int width, int shift, const float* z, const PointPlanes& normals, const FitPlanes& fits,
                   const PointPlanes& sharp) {
  for (int u = 0; u < width; u += kFloats) {
    const Floats z0 = load(z + u);
    // An error below 1 means that the plane is in front of the camera, so that its normal points towards the
    // sensor. A pixel without a plane of its own keeps NaN, because no error is less than NaN.
    Choice best = {smaller(Floats{} + 1.0f, kClearlyLess * load(fits.error + u)), load(normals.x + u),
                   load(normals.y + u), load(normals.z + u)};
    const auto offer = [&](int i, int j) __attribute__((always_inline)) {
      const std::ptrdiff_t at = u + shift * (j * normals.stride + i);
      const Floats here = load(fits.c + at) - static_cast<float>(shift * i) * load(fits.a + at) -
                          static_cast<float>(shift * j) * load(fits.b + at);
      const Floats beside = z0 * here - 1.0f, error = load(fits.error + at) + beside * beside;
      const auto is_better = error < best.error;  // false if there is no plane
      best = {is_better ? error : best.error, is_better ? load(normals.x + at) : best.x,
              is_better ? load(normals.y + at) : best.y, is_better ? load(normals.z + at) : best.z};
    };
    offer(-1, -1), offer(0, -1), offer(1, -1), offer(-1, 0), offer(1, 0), offer(-1, 1), offer(0, 1),
        offer(1, 1);
    store(sharp.x + u, best.x), store(sharp.y + u, best.y), store(sharp.z + u, best.z);
  }
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
