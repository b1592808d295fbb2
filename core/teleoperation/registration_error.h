// The error of the registration of the slave to the camera, whose cloud the operator touches.
#pragma once

#include <string>

#include "core/geometry/vector.h"
#include "core/numeric/noise.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

struct RegistrationError {
  double offset_m = 0;
  double rotation_deg = 0;
};

Parameters parameters(RegistrationError& s);
inline std::string validate(const RegistrationError&) {
  return {};
}

// Returns X with X p = R p + t, the position to which the slave moves if the command is p, both in the world
// frame. R is a rotation by rotation_deg about an axis through the origin of the world, and t has the length
// offset_m. The axis of R and the direction of t are random, independent, uniform on the sphere, and the same
// for the whole run. They are functions of the seed and the replicate, not of the cell of a sweep, so the
// runs of one replicate differ only in what the sweep varies.
RigidTransform registration_of(const RegistrationError& error, const NoiseKey& key);

}  // namespace remote_touch
