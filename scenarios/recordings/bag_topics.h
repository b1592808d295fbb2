// Finds the topics of a bag that come from a depth camera, and which of them belong together.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_file.h"

namespace remote_touch {

inline constexpr const char* kCloudType = "sensor_msgs/PointCloud2";
inline constexpr const char* kImageType = "sensor_msgs/Image";
inline constexpr const char* kCompressedType = "sensor_msgs/CompressedImage";
inline constexpr const char* kCameraType = "sensor_msgs/CameraInfo";

bool is_readable(const BagTopic& topic);  // plain CDR, or ROS 1
WireFormat wire_format(const BagTopic& topic);
// True for the topics whose messages are read: frames, cameras, fixed transforms, units of depth. Messages of
// other topics are not read.
bool is_wanted_topic(const BagTopic& topic);
bool is_tf_static(const BagTopic& topic);

// Returns the topic of that name, or, if the name is empty, the only topic that has frames. Throws InputError
// about the path, with a list of the topics (type, encoding, number of messages), if there is not exactly
// one.
std::size_t topic_of_frames(const std::string& path, const BagFile& bag, const std::string& name);

// The topic of the CameraInfo that belongs to a topic of depth images: that of the name; or the one beside
// it, unless its first message names another coordinate frame than the first image; or that of the RealSense
// sensor. A camera elsewhere may be another one, even the only one there is. Throws InputError with a list as
// above.
std::size_t topic_of_camera(const std::string& path, const BagFile& bag, std::size_t images,
                            const std::string& name);

// The option Depth Units of the RealSense sensor that recorded these images, or none: topics().size().
std::size_t topic_of_unit(const BagFile& bag, std::size_t images);

// True if images of a topic with that name are rectified, by the custom of ROS: image_rect.
bool is_rectified_by_name(const std::string& topic);

}  // namespace remote_touch
