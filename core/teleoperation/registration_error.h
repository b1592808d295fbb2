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
  Vec3 centre_m = Vec3::Zero();
};

Parameters parameters(RegistrationError& s);
inline std::string validate(const RegistrationError&) {
  return {};
}

// Returns X with X p = R (p - o) + o + t, the position to which the slave moves if the command is p, both in
// the world frame. R is a rotation by rotation_deg, o is centre_m, and t has the length offset_m. So the
// rotation displaces a command at the distance d from o by up to 2 d sin(rotation_deg / 2). The axis of R and
// the direction of t are random, independent, uniform on the sphere, and the same for the whole run. They are
// functions of the seed and the replicate, not of the cell of a sweep, so the runs of one replicate differ
// only in what the sweep varies.
RigidTransform registration_of(const RegistrationError& error, const NoiseKey& key);

}  // namespace remote_touch
