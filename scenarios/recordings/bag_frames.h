// The frames in a bag of ROS: the messages of one topic, in the order of their stamps, as clouds.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"
#include "scenarios/recordings/bag_file.h"
#include "scenarios/recordings/frames_from_messages.h"
#include "scenarios/recordings/messages.h"

namespace remote_touch {

// Settings that choose the frames of a recording from a bag of ROS.

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

// Fixed transforms between the coordinate frames of a robot, as in tf_static: each frame has at most one
// parent.

// Removes the leading / that older programs write in front of the name of a frame.
std::string plain_frame(const std::string& frame);

class StaticTransforms {
 public:
  // A frame that is added again gets its new parent and transform. Throws InputError about the subject for
  // more than 10000 frames.
  void add(const std::vector<StampedTransform>& transforms, const std::string& subject = "tf_static");
  // p_to = X * p_from. Throws InputError about the subject when the two are not connected, or a frame is its
  // own ancestor.
  RigidTransform between(const std::string& to, const std::string& from, const std::string& subject) const;

 private:
  struct Parent {
    std::string name;
    RigidTransform X;
  };
  // Returns the transform from the frame to its root, the ancestor without a parent, and writes the root's
  // name. Throws InputError about the subject if a frame is its own ancestor.
  RigidTransform to_root(std::string frame, std::string& root, const std::string& subject) const;

  std::map<std::string, Parent> parent_of_;
};

// Reads sensor_msgs/PointCloud2, Image and CompressedImage (compressedDepth). The first CameraInfo is used
// for all frames, see camera_change(). Integers of depth images are in units of 1 mm, or in the unit that the
// option Depth Units of a RealSense recording states. Floats are metres. BagChoice::depth_unit_m replaces
// these units. All messages must name the same coordinate frame.
//
// The frames are in the order of the stamps in the messages' headers; captured_s counts from the first stamp.
// If several messages have the same stamp, the first one is used. If a stamp is 0, all times are those of the
// recorder. Only one message at a time is in memory. Several threads may read at once.
class BagFrames {
 public:
  // Throws InputError about the path or a topic in these cases: there is no topic of frames or more than one,
  // the chosen topic has no frames, or the camera or the transform is missing or cannot be used. For depth
  // images the constructor reads the first one.
  BagFrames(const std::filesystem::path& path, const BagChoice& choice);

  const std::vector<double>& captured_s() const { return captured_s_; }
  // Stamp of the first frame.
  double first_stamp_s() const { return first_stamp_s_; }
  // Camera of the depth images; all 0 for clouds.
  CameraIntrinsics camera() const { return rays_ ? rays_->camera() : CameraIntrinsics{}; }
  // Pose of the messages' coordinate frame in the chosen one.
  const RigidTransform& pose() const { return X_chosen_; }
  std::string kind() const { return topic().type + " " + topic().name; }
  // Empty, or one line that says what was wrong with the bag and what was done about it.
  const std::string& remark() const { return remark_; }
  // One line that names the first CameraInfo and the first depth unit that differ from those in use. Empty if
  // none differs.
  const std::string& camera_change() const { return camera_change_; }

  // Path, topic and number of the message of a frame, for a message to the user about it.
  std::string name_of(std::size_t frame) const { return subject(topic_, frames_[frame]); }

  // Returns a frame in the coordinate frame of the messages. Pixels of an image whose depth z is above
  // max_depth_m are NaN; the limit does not apply to clouds that are no image. Throws InputError about the
  // message if it cannot be used.
  PointCloud cloud(std::size_t frame, double max_depth_m) const;

 private:
  const BagTopic& topic() const { return bag_->topics()[topic_]; }
  std::string subject(std::size_t topic, const MessagePlace& place) const;
  DepthImage depth_of(const MessagePlace& place, double max_depth_m) const;
  void refuse_image_settings(const BagChoice& choice) const;
  void choose_camera(const BagChoice& choice);
  template <class IsSame>
  void note_changes(std::size_t topic, IsSame&& is_same);
  void choose_unit(double chosen_m);
  void choose_frame_id(const std::string& frame_id);
  void order_frames();
  void check_frame_id(const MessageHeader& header, const std::string& subject) const;

  std::string path_;
  std::unique_ptr<BagFile> bag_;
  std::size_t topic_ = 0;
  std::vector<MessagePlace> frames_;
  std::vector<double> captured_s_;
  double first_stamp_s_ = 0;
  std::optional<ImageRays> rays_;  // only for depth images
  DepthUnits units_;
  std::string frame_id_;  // coordinate frame of the first frame, and so of all
  RigidTransform X_chosen_ = RigidTransform::Identity();
  std::string remark_, camera_change_;
};

}  // namespace remote_touch
