// Settings that choose the frames of a recording from a bag of ROS.
#pragma once

#include <string>

namespace remote_touch {

// The part of a bag that is used. topic and camera_info are names of topics. If a name is empty, the program
// chooses the topic.
struct BagChoice {
  enum class Images { by_name, measured, rectified };
  std::string topic;                // topic of clouds or depth images; empty: the only one that has them
  std::string camera_info;          // topic of their camera; empty: found by the name of the images' topic
  Images images = Images::by_name;  // `by_name`: rectified if the last part of the topic's name has "rect"
  std::string frame_id;             // coordinate frame of tf_static; empty: that of the messages
  // Size of one unit of depth images. 0: floats are in metres, and integers are in the unit that a RealSense
  // recorded, or else in 0.001 m.
  double depth_unit_m = 0;
};

}  // namespace remote_touch
