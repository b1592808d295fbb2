// Where a camera is and looks, as a page shows it.
#pragma once

#include "core/geometry/vector.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

Json json_of(const Vec3& v);
// Position, and the directions in which it looks and which is up in its image, world frame.
Json sensor_json(const RigidTransform& X_WC);

}  // namespace remote_touch
