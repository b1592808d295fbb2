// The spatial bilateral filter (7.1), (7.2). It processes 16, 8 or 4 pixels of a row at a time. It sums
// differences to the depth of the pixel itself, so that the relative error of single precision, 1e-7, applies
// to them and not to the depths.
#include "core/kernels/depth_kernels.h"
#include "core/kernels/float_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

struct Point {
  Floats x, y, z;
};

inline Point point(const PointPlanes& planes, std::ptrdiff_t at) {
  return {load(planes.x + at), load(planes.y + at), load(planes.z + at)};
}

// Computes (7.2) from the squared distance s in filter units: e^-t with t = s / kFilterExponent, approximated
// by the 16th power of a cubic that falls to exactly 0 at t = 27.4. The cubic is the minimax fit of the
// weight: the error is below 8e-6 for every t, rounding included.
inline Floats gaussian(Floats s) {
  constexpr float kEnd = 0.9083625722727604f, kCentre = 0.4332450600460519f, kLift = 0.9131807121233679f;
  const Floats y = smaller(s, Floats{} + kEnd), from_centre = y - kCentre;
  const Floats p = (kEnd - y) * (from_centre * from_centre + kLift);
  const Floats p2 = p * p, p4 = p2 * p2, p8 = p4 * p4;
  return p8 * p8;
}

template <int kHalf>
void filter_row(const RowBand& band, int row, bool only_weights, const PointPlanes in, float* change) {
  const int half = kHalf ? kHalf : band.half, end = band.width + half;
  const PairWeights weights(band.weights, band.width, half, 1, row);
  for (int u = -half; u < end; u += kFloats) {
    const std::ptrdiff_t here = row * in.stride + u;
    const Point p0 = point(in, here);
    Floats sum = {}, total = Floats{} + 1.0f;  // weight of the point itself
    const auto pair = [&](int below, int across) {
      const Point p = point(in, here + below * in.stride + across);
      const Floats dx = p.x - p0.x, dy = p.y - p0.y, dz = p.z - p0.z;
      const Floats phi = gaussian(dx * dx + dy * dy + dz * dz);
      sum += phi * dz, total += phi;
      return phi;
    };
    const auto fresh = [&](int j, int i) { store(weights.fresh(j, i) + u, pair(j, i)); };
    const auto kept = [&](int j, int i) {
      const Floats phi = load(weights.kept(j, -i) + u + i);
      sum += phi * (load(in.z + here - j * in.stride + i) - p0.z), total += phi;
    };
    for (int j = 1; j <= half; ++j) {
      fresh(j, 0);
      for_each_step<kHalf>(half, [&](int i) { fresh(j, -i), fresh(j, i); });
    }
    if (only_weights) continue;
    for_each_step<kHalf>(half, [&](int i) { pair(0, -i), pair(0, i); });
    for (int j = 1; j <= half; ++j) {
      kept(j, 0);
      for_each_step<kHalf>(half, [&](int i) { kept(j, -i), kept(j, i); });
    }
    store(change + here, sum / total);
  }
}

}  // namespace

void filter_depth(const RowBand& band, const PointPlanes& in, float* change) {
  const auto work = band.half == 4   ? filter_row<4>
                    : band.half == 2 ? filter_row<2>
                    : band.half == 1 ? filter_row<1>
                                     : filter_row<0>;
  for (int row = band.first - band.half; row < band.last; ++row)
    work(band, row, row < band.first, in, change);
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
