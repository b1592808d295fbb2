// The depths of an Image or a CompressedImage.
#pragma once

#include <string>

#include "core/geometry/camera.h"
#include "scenarios/recordings/bags/messages.h"

namespace remote_touch {

// The factors from the values of a depth image to metres, for integers and for floats.
struct DepthUnits {
  double of_integers_m = 0.001;
  double of_floats_m = 1;
};

// The encodings of depth images: integers 16UC1, mono16 and Z16, floats 32FC1.
bool is_depth_encoding(const std::string& encoding);
inline constexpr const char* kDepthEncodings = "16UC1, mono16, Z16 or 32FC1";

// A depth that is 0, negative, not finite or beyond max_depth_m becomes NaN. Throws InputError about the
// subject for another encoding, or when the data are shorter than height and step claim. At most 2^26 pixels.
DepthImage depth_from_message(const ImageMessage& message, const DepthUnits& units, double max_depth_m,
                              const std::string& subject);

// The transport compressedDepth: 12 bytes (a format, then two floats a and b), then a 16-bit PNG. Format
// "16UC1; ..." holds integers; "32FC1; ..." holds q where the float is a / (q - b), and 0 where there is
// none. Throws InputError also when the PNG is damaged or of another kind.
DepthImage depth_from_message(const CompressedImageMessage& message, const DepthUnits& units,
                              double max_depth_m, const std::string& subject);

}  // namespace remote_touch
