// A sensor's frame as an organised cloud.
#pragma once

#include "runners/experiment/sessions/sensor_frame.h"

namespace remote_touch {

// True if the frame has as many points or pixels as the view promises, and colours if the view promises them.
bool is_complete(const SensorFrame& frame, const SensorView& view);

// Returns the points of the frame. X_WC: pose of the camera in the world. The same frame gives the same bits,
// live and from a recording of it.
PointCloud cloud_of(const SensorFrame& frame, const SensorView& view, const RigidTransform& X_WC);

}  // namespace remote_touch
