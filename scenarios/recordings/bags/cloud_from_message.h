// Reads the points of a PointCloud2 with any layout of its fields.
#pragma once

#include <string>

#include "core/geometry/point_cloud.h"
#include "scenarios/recordings/bags/messages.h"

namespace remote_touch {

// Reads the fields x, y, z (float32 or float64, metres) and, if present, rgb or rgba (4 bytes, 0xAARRGGBB).
// Alpha is dropped, but see colour_of_float() for rgb as float32. Other fields are skipped. The message's
// frame is the world frame. A point with a coordinate that is not finite, or at exactly (0, 0, 0), is a
// missing measurement: it keeps its index, and its three coordinates are NaN.
//
// height > 1: the cloud is organised. It gets cloud.image if a pinhole camera explains it, as for a PCD file.
// height = 1: the points are in no order.
//
// Throws InputError about the subject when a field is missing, of another type or of several values, or the
// data are shorter than width, height and steps claim. At most 2^24 points.
PointCloud cloud_from_message(const PointCloudMessage& message, const std::string& subject);

}  // namespace remote_touch
