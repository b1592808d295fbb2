// The error of the registration between the camera, in whose frame the operator works, and the slave.
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

// Returns where the slave goes, in the world frame, when it is sent to a position of the camera's cloud:
// X p = R p + t. R is a rotation by rotation_deg about the origin of the world. The direction of t, which has
// the length offset_m, and the axis of R are random, independent, and the same for the whole run: they are
// functions of the key, and uniform on the sphere.
RigidTransform registration_of(const RegistrationError& error, const NoiseKey& key);

}  // namespace remote_touch
