#include "scenarios/recordings/bag_topics.h"

#include <algorithm>

#include "core/parameters/input_error.h"
#include "scenarios/recordings/bags/depth_from_message.h"
#include "scenarios/recordings/bags/messages.h"
#include "scenarios/recordings/static_transforms.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

std::vector<std::string> parts_of_name(const std::string& name) {
  std::vector<std::string> parts(1);
  for (const char c : name) {
    if (c == '/') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::string joined(std::vector<std::string> parts, std::size_t count, const std::string& end) {
  std::string name;
  for (std::size_t i = 0; i < count; ++i) name += parts[i] + "/";
  return name + end;
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

}  // namespace

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

bool is_wanted_topic(const BagTopic& topic) {
  const std::string& type = topic.type;
  const bool is_unit = type == "std_msgs/Float32" && topic.name.find("Depth") != std::string::npos;
  const bool is_known = type == kCloudType || type == kImageType || type == kCompressedType ||
                        type == kCameraType || is_tf_static(topic) || is_unit;
  return is_known && is_readable(topic);
}

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

std::size_t topic_of_camera(const std::string& path, const BagFile& bag, std::size_t images,
                            const std::string& name) {
  const auto cameras = topics_that(bag, [&](std::size_t t) {
    return bag.topics()[t].type == kCameraType && is_readable(bag.topics()[t]) && has_messages(bag, t);
  });
  const auto find = [&](const std::string& wanted) {
    const auto found = std::find_if(cameras.begin(), cameras.end(),
                                    [&](std::size_t t) { return bag.topics()[t].name == wanted; });
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

bool is_rectified_by_name(const std::string& topic) {
  return parts_without_transport(topic).back().find("rect") != std::string::npos;
}

}  // namespace remote_touch
