// What of a bag of ROS makes the frames of a recording.
#pragma once

#include <string>

namespace remote_touch {

// What of a bag is used. Names are those of topics, empty: chosen.
struct BagChoice {
  enum class Images { by_name, measured, rectified };
  std::string topic;                // clouds or depth images; chosen when one topic only has them
  std::string camera_info;          // the camera of depth images; chosen by the name of their topic
  Images images = Images::by_name;  // by_name: rectified if the last part of the topic's name has "rect"
  std::string frame_id;             // a coordinate frame of tf_static; empty: that of the messages
  // Metres in a unit of depth images; 0: 0.001 of integers, or what a RealSense recorded, and 1 of floats.
  double depth_unit_m = 0;
};

}  // namespace remote_touch
