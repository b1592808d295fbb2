#include "scenarios/recordings/bag_frames.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/parameters/input_error.h"
#include "scenarios/recordings/bag_topics.h"
#include "scenarios/recordings/bags/cloud_from_message.h"
#include "scenarios/recordings/bags/depth_from_message.h"
#include "scenarios/recordings/frame_layout.h"
#include "scenarios/recordings/static_transforms.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

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
  const auto same = std::find_if(places.begin(), places.end(), [&](const MessagePlace& other) {
    return other.part == place.part && other.at == place.at;
  });
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
  if (!(rounded_m > 0 && unit_m <= 1)) {
    char unit_text[40];
    std::snprintf(unit_text, sizeof unit_text, "%g", unit_m);
    refuse(name, "depth unit = ", unit_text, " m: expected 1e-9 to 1");
  }
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
  if (!std::is_sorted(stamped.begin(), stamped.end(), earlier)) {
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
