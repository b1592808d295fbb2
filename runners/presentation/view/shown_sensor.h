// Position and directions of a camera, as a page shows them.
#pragma once

#include "core/geometry/vector.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

Json json_of(const Vec3& v);
// Returns the position, the viewing direction and the upward direction of the image, in the world frame.
Json sensor_json(const RigidTransform& X_WC);

}  // namespace remote_touch
