#include "scenarios/recordings/bag_file.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/frames_from_messages.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

std::string plain_frame(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

void StaticTransforms::add(const std::vector<StampedTransform>& transforms, const std::string& subject) {
  constexpr std::size_t kMaxFrames = 10000;
  for (const StampedTransform& transform : transforms) {
    parent_of_[plain_frame(transform.child)] = {plain_frame(transform.parent), transform.X};
    if (parent_of_.size() > kMaxFrames)
      refuse(subject, "has too many coordinate frames: expected at most ", kMaxFrames);
  }
}

RigidTransform StaticTransforms::to_root(std::string frame, std::string& root,
                                         const std::string& subject) const {
  RigidTransform X = RigidTransform::Identity();
  for (std::size_t steps = 0; steps <= parent_of_.size(); ++steps) {
    const auto parent = parent_of_.find(frame);
    if (parent == parent_of_.end()) {
      root = frame;
      return X;
    }
    X = parent->second.X * X, frame = parent->second.name;
  }
  refuse(subject, "tf_static has '", frame, "' as its own ancestor");
}

RigidTransform StaticTransforms::between(const std::string& to, const std::string& from,
                                         const std::string& subject) const {
  if (plain_frame(to) == plain_frame(from)) return RigidTransform::Identity();
  std::string root_of_to, root_of_from;
  const RigidTransform X_root_to = to_root(plain_frame(to), root_of_to, subject);
  const RigidTransform X_root_from = to_root(plain_frame(from), root_of_from, subject);
  if (root_of_to == root_of_from) return X_root_to.inverse() * X_root_from;
  std::string known;
  for (const auto& [child, parent] : parent_of_) {
    if (known.size() > 500) break;
    known += (known.empty() ? "" : ", ") + child + " in " + parent.name;
  }
  refuse(subject, "scenario.frame_id = ", to, ": expected a frame that tf_static connects with '", from,
         "'; it has ", (known.empty() ? "none" : known));
}

namespace {

// Finds the topics of a bag that come from a depth camera, and determines which of them belong together.

constexpr const char* kCloudType = "sensor_msgs/PointCloud2";
constexpr const char* kImageType = "sensor_msgs/Image";
constexpr const char* kCompressedType = "sensor_msgs/CompressedImage";
constexpr const char* kCameraType = "sensor_msgs/CameraInfo";

std::vector<std::string> parts_of_name(const std::string& name) {
  std::vector<std::string> parts(1);
  for (const char c : name)
    if (c == '/')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::string joined(std::vector<std::string> parts, std::size_t count, const std::string& end) {
  std::string name;
  for (std::size_t i = 0; i < count; ++i) name += parts[i] + "/";
  return name + end;
}

// Plain CDR, or ROS 1.
bool is_readable(const BagTopic& topic) {
  return topic.encoding == "cdr" || topic.encoding == "ros1";
}

WireFormat wire_format(const BagTopic& topic) {
  return topic.encoding == "ros1" ? WireFormat::ros1 : WireFormat::cdr;
}

bool is_tf_static(const BagTopic& topic) {
  return parts_of_name(topic.name).back() == "tf_static" &&
         (topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage");
}

// Returns true for the topics whose messages are read: frames, cameras, fixed transforms, units of depth.
bool is_wanted_topic(const BagTopic& topic) {
  const std::string& type = topic.type;
  const bool is_unit = type == "std_msgs/Float32" && topic.name.find("Depth") != std::string::npos;
  const bool is_known = type == kCloudType || type == kImageType || type == kCompressedType ||
                        type == kCameraType || is_tf_static(topic) || is_unit;
  return is_known && is_readable(topic);
}

// A transport adds its name to that of the images: image_rect/compressedDepth.
std::vector<std::string> parts_without_transport(const std::string& name) {
  std::vector<std::string> parts = parts_of_name(name);
  if (parts.size() > 1 && parts.back() == "compressedDepth") parts.pop_back();
  return parts;
}

bool has_messages(const BagFile& bag, std::size_t topic) {
  return !bag.places(topic).empty();
}

// Returns the encoding of an image topic, from its first message. Empty for other topics and damaged
// messages.
std::string encoding_of(const BagFile& bag, std::size_t t) {
  const BagTopic& topic = bag.topics()[t];
  if (topic.type != kImageType || !is_readable(topic) || !has_messages(bag, t)) return {};
  constexpr std::uint64_t kBeforePixels = 512;
  const std::string start = bag.start(bag.places(t).front(), kBeforePixels);
  try {
    MessageCursor cursor(start, wire_format(topic), topic.name);
    read_header(cursor), cursor.u32(), cursor.u32();
    return cursor.text();
  } catch (const InputError&) {  // reported later, if the user chooses this topic
    return {};
  }
}

// Returns true for topics of clouds and of depth images. Colour images have the same type as depth images, so
// the encoding decides, or the name of a compressed topic.
bool has_frames(const BagFile& bag, std::size_t t) {
  const BagTopic& topic = bag.topics()[t];
  if (!is_wanted_topic(topic) || !has_messages(bag, t)) return false;
  if (topic.type == kCloudType) return true;
  if (topic.type == kCompressedType) return parts_of_name(topic.name).back() == "compressedDepth";
  return topic.type == kImageType && is_depth_encoding(encoding_of(bag, t));
}

// Returns the coordinate frame of the first message.
std::string frame_id_of(const std::string& path, const BagFile& bag, std::size_t t) {
  const BagTopic& topic = bag.topics()[t];
  constexpr std::uint64_t kLongestHeader = 1024;
  const std::string start = bag.start(bag.places(t).front(), kLongestHeader);
  MessageCursor cursor(start, wire_format(topic), path + ": " + topic.name);
  return plain_frame(read_header(cursor).frame_id);
}

std::string listed(const BagFile& bag, const std::vector<std::size_t>& topics) {
  constexpr std::size_t kMaxShown = 20;
  std::string list;
  for (std::size_t i = 0; i < topics.size() && i < kMaxShown; ++i) {
    const BagTopic& topic = bag.topics()[topics[i]];
    const std::string encoding = is_readable(topic) ? encoding_of(bag, topics[i]) : topic.encoding;
    list += (i > 0 ? ", " : "") + topic.name + " (" + topic.type + (encoding.empty() ? "" : " ");
    list += encoding.substr(0, 32) + ", " + std::to_string(topic.messages) + " messages)";
  }
  if (topics.size() > kMaxShown) list += ", and " + std::to_string(topics.size() - kMaxShown) + " more";
  return list.empty() ? "none" : list;
}

template <class Fits>
std::vector<std::size_t> topics_that(const BagFile& bag, Fits fits) {
  std::vector<std::size_t> found;
  for (std::size_t t = 0; t < bag.topics().size(); ++t)
    if (fits(t)) found.push_back(t);
  return found;
}

// Returns the topic of that name, or, if the name is empty, the only topic that has frames. Throws InputError
// about the path, with a list of the topics (type, encoding, number of messages), if there is not exactly
// one.
std::size_t topic_of_frames(const std::string& path, const BagFile& bag, const std::string& name) {
  const auto of_frames = topics_that(bag, [&](std::size_t t) { return has_frames(bag, t); });
  if (name.empty() && of_frames.size() == 1) return of_frames.front();
  if (name.empty() && of_frames.size() > 1)
    refuse(path, "has several topics of clouds or depth images: expected scenario.topic as one of ",
           listed(bag, of_frames));
  const auto named = topics_that(bag, [&](std::size_t t) {
    const std::string& type = bag.topics()[t].type;
    return bag.topics()[t].name == name && is_wanted_topic(bag.topics()[t]) && has_messages(bag, t) &&
           (type == kCloudType || type == kImageType || type == kCompressedType);
  });
  if (named.size() == 1) return named.front();
  const std::string damage = bag.remark().empty() ? "" : bag.remark() + "; ";
  const std::string problem =
      damage + (name.empty() ? "has no topic of clouds or depth images" : "scenario.topic = " + name);
  refuse(path, problem, ": expected a topic of ", kCloudType, ", ", kImageType, " (", kDepthEncodings,
         ") or ", kCompressedType, " (compressedDepth); there are ",
         listed(bag, of_frames.empty() ? topics_that(bag, [](std::size_t) { return true; }) : of_frames));
}

// Returns the topic of the CameraInfo that belongs to a topic of depth images. If `name` is not empty, it is
// the topic of that name. Otherwise it is the one that a RealSense sensor records with these images, or the
// topic camera_info beside them. The latter is refused if its first message and the first image name
// different coordinate frames. Other cameras are not used, not even if the bag has only one, because they may
// belong to another sensor. Throws InputError, with a list as above, if there is no such topic.
std::size_t topic_of_camera(const std::string& path, const BagFile& bag, std::size_t images,
                            const std::string& name) {
  const auto cameras = topics_that(bag, [&](std::size_t t) {
    return bag.topics()[t].type == kCameraType && is_readable(bag.topics()[t]) && has_messages(bag, t);
  });
  const auto find = [&](const std::string& wanted) {
    const auto found =
        std::ranges::find_if(cameras, [&](std::size_t t) { return bag.topics()[t].name == wanted; });
    return found == cameras.end() ? bag.topics().size() : *found;
  };
  const std::size_t none = bag.topics().size();
  if (!name.empty()) {
    if (find(name) != none) return find(name);
    refuse(path, "scenario.camera_info = ", name, ": expected a topic of ", kCameraType, "; there are ",
           listed(bag, cameras));
  }
  const std::string& name_of_images = bag.topics()[images].name;
  const std::vector<std::string> parts = parts_without_transport(name_of_images);
  // RealSense: .../Depth_0/image/data and .../Depth_0/info/camera_info, which name no coordinate frames.
  if (parts.size() > 2 && find(joined(parts, parts.size() - 2, "info/camera_info")) != none)
    return find(joined(parts, parts.size() - 2, "info/camera_info"));
  std::string problem = "has no camera beside " + name_of_images;
  if (const std::size_t beside = find(joined(parts, parts.size() - 1, "camera_info")); beside != none) {
    const std::string of_camera = frame_id_of(path, bag, beside), of_images = frame_id_of(path, bag, images);
    if (of_camera.empty() || of_images.empty() || of_camera == of_images) return beside;
    problem = bag.topics()[beside].name + " has frame_id = \"" + of_camera.substr(0, 64) +
              "\" where the images have \"" + of_images.substr(0, 64) + "\"";
  }
  refuse(path, problem, ": expected scenario.camera_info as one of ", listed(bag, cameras));
}

// Returns the topic of the option Depth Units of the RealSense sensor that recorded these images, or
// topics().size() if there is none.
std::size_t topic_of_unit(const BagFile& bag, std::size_t images) {
  const std::vector<std::string> parts = parts_of_name(bag.topics()[images].name);
  const std::size_t none = bag.topics().size();
  if (parts.size() < 4 || !parts[1].starts_with("device_")) return none;  // "", device_0, sensor_0, Depth_0
  const std::string sensor = joined(parts, 3, "option/");
  const auto found = topics_that(bag, [&](std::size_t t) {
    const BagTopic& topic = bag.topics()[t];
    const bool is_unit =
        topic.name == sensor + "Depth_Units/value" || topic.name == sensor + "Depth Units/value";
    return is_unit && topic.type == "std_msgs/Float32" && has_messages(bag, t);
  });
  return found.empty() ? none : found.front();
}

// Returns true if images of a topic with that name are rectified by the naming convention of ROS: image_rect.
bool is_rectified_by_name(const std::string& topic) {
  return parts_without_transport(topic).back().find("rect") != std::string::npos;
}

void check_image_size(const std::string& subject, const DepthImage& depth, std::uint32_t width,
                      std::uint32_t height) {
  if (static_cast<std::uint32_t>(depth.width) == width && static_cast<std::uint32_t>(depth.height) == height)
    return;
  refuse(subject, "has ", depth.width, " x ", depth.height, " pixels: expected ", width, " x ", height,
         ", as its CameraInfo has (width, height, binning, roi)");
}

// Returns true if the cameras agree in every field that affects how a depth image becomes a cloud.
bool same_camera(const CameraInfoMessage& a, const CameraInfoMessage& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model &&
         a.distortion == b.distortion && a.K == b.K && a.P == b.P && a.binning_x == b.binning_x &&
         a.binning_y == b.binning_y && a.region == b.region;
}

}  // namespace

BagFrames::BagFrames(const std::filesystem::path& path, const BagChoice& choice)
    : path_(path.string()), bag_(open_bag(path, is_wanted_topic)) {
  topic_ = topic_of_frames(path_, *bag_, choice.topic);
  remark_ = bag_->remark();
  order_frames();
  constexpr std::uint64_t kLongestHeader = 1024;
  const std::string first = bag_->start(frames_.front(), kLongestHeader);
  MessageCursor cursor(first, wire_format(topic()), subject(topic_, frames_.front()));
  frame_id_ = read_header(cursor).frame_id;
  if (topic().type == kCloudType) {
    refuse_image_settings(choice);
  } else {
    choose_unit(choice.depth_unit_m);
    choose_camera(choice);
  }
  if (!choice.frame_id.empty()) choose_frame_id(choice.frame_id);
}

// Throws InputError if the choice has settings for depth images, because a topic of clouds does not use them.
void BagFrames::refuse_image_settings(const BagChoice& choice) const {
  if (choice.depth_unit_m != 0)
    refuse(path_, topic().name, " holds clouds, in metres: expected scenario.depth_unit_m = 0");
  if (!choice.camera_info.empty())
    refuse(path_, topic().name, " holds clouds: expected scenario.camera_info = \"\"");
  if (choice.images != BagChoice::Images::by_name)
    refuse(path_, topic().name, " holds clouds: expected scenario.images = by-name");
}

std::string BagFrames::subject(std::size_t topic, const MessagePlace& place) const {
  const auto& places = bag_->places(topic);
  const auto same = std::ranges::find_if(
      places, [&](const MessagePlace& other) { return other.part == place.part && other.at == place.at; });
  return path_ + ": " + bag_->topics()[topic].name + ", message " + std::to_string(same - places.begin());
}

// Compares the image size that the CameraInfo states with the size of the first image, before ImageRays makes
// a table of that size.
void BagFrames::choose_camera(const BagChoice& choice) {
  const std::size_t camera = topic_of_camera(path_, *bag_, topic_, choice.camera_info);
  const MessagePlace& first = bag_->places(camera).front();
  const std::string name = subject(camera, first), message = bag_->message(first);
  const bool rectified = choice.images == BagChoice::Images::by_name
                             ? is_rectified_by_name(topic().name)
                             : choice.images == BagChoice::Images::rectified;
  const CameraInfoMessage info = read_camera_info({message, wire_format(bag_->topics()[camera]), name});
  const MessagePlace& image = frames_.front();
  const ImageSize size = image_size(info, name);
  check_image_size(subject(topic_, image), depth_of(image, 1), size.width, size.height);
  rays_.emplace(info, rectified, name);
  note_changes(camera, [&](const MessageCursor& from) { return same_camera(read_camera_info(from), info); });
}

// Records in camera_change_ the first message of a topic that differs from message 0. A message that cannot
// be read counts as different.
template <class IsSame>
void BagFrames::note_changes(std::size_t topic, IsSame&& is_same) {
  const std::vector<MessagePlace>& places = bag_->places(topic);
  for (std::size_t i = 1; i < places.size(); ++i) {
    const std::string name = path_ + ": " + bag_->topics()[topic].name + ", message " + std::to_string(i);
    try {
      const std::string message = bag_->message(places[i]);
      if (is_same({message, wire_format(bag_->topics()[topic]), name})) continue;
    } catch (const InputError&) {
    }
    camera_change_ += (camera_change_.empty() ? "" : "; ") + name +
                      ", differs from message 0, which is used for all frames";
    return;
  }
}

void BagFrames::choose_unit(double chosen_m) {
  if (chosen_m != 0) {
    units_ = {chosen_m, chosen_m};
    return;
  }
  const std::size_t unit = topic_of_unit(*bag_, topic_);
  if (unit == bag_->topics().size()) return;
  const MessagePlace& first = bag_->places(unit).front();
  const std::string name = subject(unit, first), message = bag_->message(first);
  const double unit_m = read_float32({message, wire_format(bag_->topics()[unit]), name});
  // The 32-bit float nearest to 0.001 would make 1000 units 1.00000005 m, so the unit is rounded to 1e-9 m.
  const double rounded_m = std::round(unit_m * 1e9) / 1e9;
  if (!(rounded_m > 0 && unit_m <= 1))
    refuse(name, formatted("depth unit = %g m: expected 1e-9 to 1", unit_m));
  units_.of_integers_m = rounded_m;
  note_changes(unit, [&](const MessageCursor& from) { return read_float32(from) == unit_m; });
}

// Sorts the frames by their messages' stamps. The stamps of all messages are in memory only in this function.
void BagFrames::order_frames() {
  frames_ = bag_->places(topic_);
  bool all_stamped = true;
  std::vector<std::pair<std::int64_t, MessagePlace>> stamped;
  for (const MessagePlace& place : frames_) {
    const std::string start = bag_->start(place, 4 + kStampBytes);
    MessageCursor cursor(start, wire_format(topic()), path_ + ": " + topic().name);
    stamped.emplace_back(read_stamp_ns(cursor), place);
    all_stamped &= stamped.back().first != 0;
  }
  const auto add_remark = [&](const std::string& text) { remark_ += (remark_.empty() ? "" : "; ") + text; };
  if (!all_stamped) {
    for (auto& [stamp_ns, place] : stamped) stamp_ns = place.logged_ns;
    add_remark("has messages without a stamp: the times of the recorder are used");
  }
  const auto earlier = [](const auto& a, const auto& b) { return a.first < b.first; };
  if (!std::ranges::is_sorted(stamped, earlier)) {
    std::stable_sort(stamped.begin(), stamped.end(), earlier);
    add_remark("has messages out of order: they were sorted by their stamps");
  }
  const auto last = std::unique(stamped.begin(), stamped.end(),
                                [](const auto& a, const auto& b) { return a.first == b.first; });
  if (last != stamped.end())
    add_remark("has " + std::to_string(stamped.end() - last) +
               " message(s) with the stamp of another: not used");
  stamped.erase(last, stamped.end());
  first_stamp_s_ = static_cast<double>(stamped.front().first) / 1e9;
  frames_.clear();
  for (const auto& [stamp_ns, place] : stamped) {
    frames_.push_back(place);
    // The stamps are sorted, so the difference is not negative. It can exceed the range of std::int64_t.
    const auto since_first =
        static_cast<std::uint64_t>(stamp_ns) - static_cast<std::uint64_t>(stamped.front().first);
    captured_s_.push_back(static_cast<double>(since_first) / 1e9);
  }
}

void BagFrames::choose_frame_id(const std::string& frame_id) {
  StaticTransforms transforms;
  for (std::size_t t = 0; t < bag_->topics().size(); ++t) {
    if (!is_tf_static(bag_->topics()[t])) continue;
    for (const MessagePlace& place : bag_->places(t)) {
      const std::string message = bag_->message(place);
      const std::string name = subject(t, place);
      transforms.add(read_transforms({message, wire_format(bag_->topics()[t]), name}), name);
    }
  }
  X_chosen_ = transforms.between(frame_id, frame_id_, path_);
}

void BagFrames::check_frame_id(const MessageHeader& header, const std::string& subject) const {
  if (plain_frame(header.frame_id) == plain_frame(frame_id_)) return;
  refuse(subject, "frame_id = ", header.frame_id, ": expected ", frame_id_, ", as the first message has");
}

DepthImage BagFrames::depth_of(const MessagePlace& place, double max_depth_m) const {
  const std::string name = subject(topic_, place), bytes = bag_->message(place);
  const MessageCursor cursor(bytes, wire_format(topic()), name);
  const auto depth = [&](const auto& message) {
    check_frame_id(message.header, name);
    return depth_from_message(message, units_, max_depth_m, name);
  };
  return topic().type == kImageType ? depth(read_image(cursor)) : depth(read_compressed_image(cursor));
}

PointCloud BagFrames::cloud(std::size_t frame, double max_depth_m) const {
  assert(frame < frames_.size());
  const MessagePlace& place = frames_[frame];
  const std::string name = subject(topic_, place);
  if (rays_) {
    const CameraIntrinsics camera = rays_->camera();
    const DepthImage depth = depth_of(place, max_depth_m);
    check_image_size(name, depth, static_cast<std::uint32_t>(camera.width),
                     static_cast<std::uint32_t>(camera.height));
    return rays_->cloud(depth);
  }
  const std::string bytes = bag_->message(place);
  const PointCloudMessage message = read_point_cloud({bytes, wire_format(topic()), name});
  check_frame_id(message.header, name);
  PointCloud cloud = cloud_from_message(message, name);
  drop_beyond(max_depth_m, cloud);
  return cloud;
}

}  // namespace remote_touch
