// A sensor's frame as an organised cloud.
#pragma once

#include "runners/sessions/sensor_frame.h"

namespace remote_touch {

// As many points or pixels as the view promises, with colours if it promises them.
bool is_complete(const SensorFrame& frame, const SensorView& view);

// X_WC: pose of the camera in the world. The same bits for the same frame, live and from a recording of it.
PointCloud cloud_of(const SensorFrame& frame, const SensorView& view, const RigidTransform& X_WC);

}  // namespace remote_touch
