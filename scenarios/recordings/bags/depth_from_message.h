// Converts an Image or a CompressedImage to depths.
#pragma once

#include <string>

#include "core/geometry/camera.h"
#include "scenarios/recordings/bags/messages.h"

namespace remote_touch {

// Factors that convert the values of a depth image to metres, for integers and for floats.
struct DepthUnits {
  double of_integers_m = 0.001;
  double of_floats_m = 1;
};

// Returns true for the encodings of depth images: integers as 16UC1, mono16 and Z16, floats as 32FC1.
bool is_depth_encoding(const std::string& encoding);
inline constexpr const char* kDepthEncodings = "16UC1, mono16, Z16 or 32FC1";

// Converts an image to depths in metres. A depth that is 0, negative, not finite or beyond max_depth_m
// becomes NaN. Throws InputError about the subject for another encoding, or if the data are shorter than
// height and step claim. At most 2^26 pixels.
DepthImage depth_from_message(const ImageMessage& message, const DepthUnits& units, double max_depth_m,
                              const std::string& subject);

// Converts an image of the transport compressedDepth: 12 bytes (a format, then two floats a and b), then a
// 16-bit PNG. The format "16UC1; ..." holds integers. The format "32FC1; ..." holds integers q: the float is
// a / (q - b), and q = 0 means no measurement. Throws InputError also if the PNG is damaged or of another
// kind.
DepthImage depth_from_message(const CompressedImageMessage& message, const DepthUnits& units,
                              double max_depth_m, const std::string& subject);

}  // namespace remote_touch
