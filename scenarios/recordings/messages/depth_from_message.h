// The depths of an Image or a CompressedImage.
#pragma once

#include <string>

#include "core/cloud/camera.h"
#include "scenarios/recordings/messages/messages.h"

namespace remote_touch {

// Encodings 16UC1, mono16 and Z16 hold units of metres_per_unit, 32FC1 holds metres. What is 0, negative, not
// finite or beyond max_depth_m becomes NaN. Throws InputError about the subject for another encoding, or when
// the data are shorter than height and step claim. At most 2^26 pixels.
DepthImage depth_from_message(const ImageMessage& message, double metres_per_unit, double max_depth_m,
                              const std::string& subject);

// The transport compressedDepth: 12 bytes (a format, then two floats a and b), then a 16-bit PNG. Format
// "16UC1; ..." holds units as above; "32FC1; ..." holds q where the depth is a / (q - b), and 0 where there
// is none. Throws InputError also when the PNG is damaged or of another kind.
DepthImage depth_from_message(const CompressedImageMessage& message, double metres_per_unit,
                              double max_depth_m, const std::string& subject);

}  // namespace remote_touch
