#include "core/teleoperation/registration_error.h"

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

enum Drawn : std::uint32_t { offset, axis };

// Returns a unit vector, by rejection: points in a cube are drawn until one lies in its inscribed ball.
// Unlike with sine and cosine, the bits do not depend on the C library.
Vec3 direction(const NoiseKey& key, Drawn which) {
  const NoiseKey of_all_cells{key.seed, 0, key.replicate};
  const NoiseStream stream = noise_stream(of_all_cells, NoiseUse::registration, which);
  for (std::uint32_t draw = 0;; ++draw) {
    const auto u = uniforms(stream, draw);
    const Vec3 p(2 * u[0] - 1, 2 * u[1] - 1, 2 * u[2] - 1);
    const double square = p.squaredNorm();
    if (square <= 1 && square > 1e-6) return p.normalized();
  }
}

}  // namespace

Parameters parameters(RegistrationError& s) {
  return {
      {"offset_m", &s.offset_m, 0, 1, "distance of the slave from its command, in a random direction"},
      {"rotation_deg", &s.rotation_deg, 0, 45,
       "rotation of the slave's frame about a random axis through centre_m"},
      {"centre_m", &s.centre_m, -100, 100,
       "the point that the rotation leaves where it is, world frame: the base of the robot, or the centroid of the points with which it was calibrated"},
  };
}

RigidTransform registration_of(const RegistrationError& error, const NoiseKey& key) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() = rotation(error.rotation_deg * kRadiansPerDegree * direction(key, axis)).toRotationMatrix();
  const Vec3 about_centre_m = error.centre_m - X.linear() * error.centre_m;
  X.translation() = about_centre_m + error.offset_m * direction(key, offset);
  return X;
}

}  // namespace remote_touch
