#include "core/teleoperation/frame_dead_band.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace remote_touch {

namespace {

constexpr std::size_t kFewestPoints = 3;

struct LocalPlane {
  Vec3 centre, normal;
};

double weight(double square_m2, double near_m) {
  const double rest = 1 - square_m2 / (near_m * near_m);
  return rest > 0 ? rest * rest : 0;
}

// The points of a frame around a position, as often as they are asked for.
class NearPoints {
 public:
  NearPoints(const NeighbourSearch& frame, const Ball& ball, const Kernels& kernels) {
    points_.reserve(frame.size(), frame.has_fixture_radius(), frame.has_stiffness());
    frame.gather(ball, kernels, points_);
    points_.finish();
  }
  // Returns the plane fitted with weights around q; none with too few points. gather() also finds points
  // whose regions meet the ball; their weight is 0.
  std::optional<LocalPlane> plane(const Vec3& q, double near_m) const {
    const PointsView view = points_.view();
    Vec3 sum = Vec3::Zero();
    double weights = 0;
    std::size_t count = 0;
    const auto each = [&](auto&& take) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vec3 p(view.x[i], view.y[i], view.z[i]);
        if (const double w = weight((p - q).squaredNorm(), near_m); w > 0) take(p, w);
      }
    };
    each([&](const Vec3& p, double w) { sum += w * p, weights += w, ++count; });
    if (count < kFewestPoints) return {};
    const Vec3 centre = sum / weights;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    each([&](const Vec3& p, double w) { spread += w * (p - centre) * (p - centre).transpose(); });
    return LocalPlane{centre, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0)};
  }

 private:
  GatheredPoints points_;
};

}  // namespace

Parameters parameters(FrameDeadBandSettings& s) {
  return {
      {"least_motion_m", &s.least_motion_m, 0, 1,
       "a frame is sent only if the surface near the slave is farther than this from that of the last frame that was sent; 0: every frame is sent"},
      {"near_m", &s.near_m, 0.001, 1, "radius around the slave in which the surfaces are compared"},
  };
}

double surface_motion_m(const NeighbourSearch& before, const NeighbourSearch& now, const Vec3& near_W,
                        double near_m, const Kernels& kernels) {
  const Ball ball{near_W, 2 * near_m};  // the foot is at most near_m away, and so are the points around it
  const NearPoints old_points(before, ball, kernels), new_points(now, ball, kernels);
  const std::optional<LocalPlane> around = old_points.plane(near_W, near_m);
  if (!around) return new_points.plane(near_W, near_m) ? std::numeric_limits<double>::infinity() : 0;
  const Vec3 foot = near_W - around->normal.dot(near_W - around->centre) * around->normal;
  const std::optional<LocalPlane> from = old_points.plane(foot, near_m), to = new_points.plane(foot, near_m);
  if (!from || !to) return from || to ? std::numeric_limits<double>::infinity() : 0;
  return std::abs(from->normal.dot(to->centre - from->centre));
}

bool FrameDeadBand::sends(std::shared_ptr<const NeighbourSearch> frame, const Vec3& slave_W,
                          const Kernels& kernels) {
  const bool is_needed = s_.least_motion_m == 0 || !last_ || !slave_W.allFinite() ||
                         surface_motion_m(*last_, *frame, slave_W, s_.near_m, kernels) > s_.least_motion_m;
  if (!is_needed) return false;
  ++sent_;
  if (s_.least_motion_m > 0) last_ = std::move(frame);
  return true;
}

}  // namespace remote_touch
