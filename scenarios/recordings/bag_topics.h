// Finds the topics of a bag that come from a depth camera, and determines which of them belong together.
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
// Returns true for the topics whose messages are read: frames, cameras, fixed transforms, units of depth.
bool is_wanted_topic(const BagTopic& topic);
bool is_tf_static(const BagTopic& topic);

// Returns the topic of that name, or, if the name is empty, the only topic that has frames. Throws InputError
// about the path, with a list of the topics (type, encoding, number of messages), if there is not exactly
// one.
std::size_t topic_of_frames(const std::string& path, const BagFile& bag, const std::string& name);

// Returns the topic of the CameraInfo that belongs to a topic of depth images. If `name` is not empty, it is
// the topic of that name. Otherwise it is the one that a RealSense sensor records with these images, or the
// topic camera_info beside them. The latter is refused if its first message and the first image name
// different coordinate frames. Other cameras are not used, not even if the bag has only one, because they may
// belong to another sensor. Throws InputError, with a list as above, if there is no such topic.
std::size_t topic_of_camera(const std::string& path, const BagFile& bag, std::size_t images,
                            const std::string& name);

// Returns the topic of the option Depth Units of the RealSense sensor that recorded these images, or
// topics().size() if there is none.
std::size_t topic_of_unit(const BagFile& bag, std::size_t images);

// Returns true if images of a topic with that name are rectified by the naming convention of ROS: image_rect.
bool is_rectified_by_name(const std::string& topic);

}  // namespace remote_touch
