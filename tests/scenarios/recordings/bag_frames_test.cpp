// The frames of a bag: topics, cameras, order, coordinate frames, and what is refused.
#include "scenarios/recordings/bag_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/kernels/kernels.h"
#include "scenarios/recordings/camera_path.h"
#include "scenarios/recordings/recorded_scene.h"
#include "tests/support/bag_files.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::bag_frames_test {
namespace {

using Format = MessageBytes::Format;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000, kStep_ns = 31'250'000;
const std::string kCloud = "sensor_msgs/msg/PointCloud2", kImage = "sensor_msgs/msg/Image",
                  kCamera = "sensor_msgs/msg/CameraInfo", kTransforms = "tf2_msgs/msg/TFMessage";

// A cloud of 4 x 3 points at 1 m + 0.1 m a frame.
BagMessage cloud(int frame, int logged, const std::string& topic = "/points",
                 std::int64_t start_ns = kStart_ns) {
  return {
      topic, kCloud, kStart_ns + logged * kStep_ns,
      cloud_message(Format::cdr, start_ns + frame * kStep_ns, 4, 3, 1 + 0.1f * static_cast<float>(frame))};
}

BagMessage depth(int frame, const std::string& topic) {
  const std::int64_t stamp_ns = kStart_ns + frame * kStep_ns;
  return {topic, kImage, stamp_ns,
          depth_message(stamp_ns, 4, 3, static_cast<std::uint16_t>(1000 + 100 * frame))};
}

BagMessage camera(const std::string& topic, int width = 4) {
  return {topic, kCamera, kStart_ns, camera_message(width, 3, {-0.1, 0, 0, 0, 0})};
}

// A camera message with another coordinate frame. Its name must be as long as "optical", so that the bytes
// that follow stay at their offset.
BagMessage camera_of(const std::string& topic, const std::string& frame_id) {
  BagMessage message = camera(topic);
  const std::size_t rest = MessageBytes().header(1, "optical").done().size();
  message.bytes = MessageBytes().header(1, frame_id).done() + message.bytes.substr(rest);
  return message;
}

BagMessage cloud_in(const std::string& frame_id) {
  return {"/points", kCloud, kStart_ns + kStep_ns,
          cloud_message(Format::cdr, kStart_ns + kStep_ns, 4, 3, 1, frame_id)};
}

// A cloud of which only the first bytes are there.
BagMessage cut_cloud(std::size_t bytes) {
  BagMessage cut = cloud(1, 1);
  cut.bytes.resize(bytes);
  return cut;
}

BagMessage colours(const std::string& encoding) {
  MessageBytes bytes;
  bytes.header(1, "").add(1).add(1).text(encoding).add(std::uint8_t{0}).add(3).bytes("xyz");
  return {"/" + encoding, kImage, 1, bytes.done()};
}

// The depth image of a RealSense with this unit.
std::vector<BagMessage> realsense(float unit_m) {
  const std::string sensor = "/device_0/sensor_0/";
  return {{sensor + "option/Depth Units/value", "std_msgs/msg/Float32", 1, MessageBytes().add(unit_m).done()},
          camera(sensor + "Depth_0/info/camera_info"),
          depth(0, sensor + "Depth_0/image/data")};
}

// Frames of tf_static: pairs of parent and child, each turned about y by 180 degrees, and moved by x, 2 x,
// ...
BagMessage transforms(const std::vector<std::pair<std::string, std::string>>& pairs, double x = 0) {
  MessageBytes bytes;
  bytes.add(static_cast<std::uint32_t>(pairs.size()));
  double way = 0;
  for (const auto& [parent, child] : pairs) {
    bytes.header(0, parent).text(child);
    for (const double value : {way += x, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0}) bytes.add(value);
  }
  return {"/tf_static", kTransforms, 1, bytes.done()};
}

class Frames : public ::testing::Test {
 protected:
  BagFrames frames(const std::vector<BagMessage>& messages, const BagChoice& choice = {}) const {
    folder_.write("x.mcap", mcap_file(messages));
    return BagFrames(folder_ / "x.mcap", choice);
  }
  std::string error(const std::vector<BagMessage>& messages, const BagChoice& choice = {}) const {
    return refusal([&] {
      const BagFrames all = frames(messages, choice);
      for (std::size_t i = 0; i < all.captured_s().size(); ++i) all.cloud(i, kNoLimit);
    });
  }

  const TestFolder folder_{"bag_frames_test"};
};

TEST_F(Frames, AreInTheOrderOfTheirStamps) {
  const BagFrames all = frames({cloud(0, 0), cloud(2, 1), cloud(1, 2), cloud(1, 3), cloud(4, 4)});
  EXPECT_EQ(all.captured_s(), (std::vector<double>{0, 0.03125, 0.0625, 0.125}));
  for (const std::size_t i : {3u, 0u, 2u, 1u}) {
    const double z_m = 1 + 0.1 * std::array{0, 1, 2, 4}[i];
    EXPECT_NEAR(all.cloud(i, kNoLimit).z[5], z_m, 1e-6);
  }
  EXPECT_EQ(all.remark(),
            "has messages out of order: they were sorted by their stamps; has 1 message(s) with the stamp of "
            "another: not used");
  EXPECT_TRUE(std::isnan(all.cloud(3, 1.39).z[5]));
}

TEST_F(Frames, HaveTheTimesOfTheRecorderIfStampsAreMissing) {
  const BagFrames all =
      frames({cloud(0, 0, "/points", 0), cloud(1, 3, "/points", 0), cloud(2, 5, "/points", 0)});
  EXPECT_EQ(all.captured_s(), (std::vector<double>{0, 3 * 0.03125, 5 * 0.03125}));
  EXPECT_HAS(all.remark(), "has messages without a stamp");
}

// Frames at 0, 31.25 and 93.75 ms, poses at 0, 62.5 and 125 ms. x is the time since the first frame, m for s.
TEST_F(Frames, StampedPosesBelongToTheirTimes) {
  folder_.write("x.mcap", mcap_file({cloud(0, 0), cloud(1, 1), cloud(3, 2)}));
  const RecordingIndex recording = index_recording(folder_ / "x.mcap");
  const auto path = [&](const std::string& name, double start_s) {
    std::string text;
    for (const double x : {0.0, 0.0625, 0.125})
      text += std::to_string(start_s + x) + " " + std::to_string(x) + " 0 0 0 0 0 1\n";
    folder_.write(name, text);
    return CameraPath(RigidTransform::Identity(), name, PoseDirection::camera_to_world, recording,
                      folder_ / ".");
  };
  const CameraPath poses = path("poses.txt", 1.7e9);
  for (const auto& [frame, x] : {std::pair(0, 0.0), {1, 0.03125}, {2, 0.09375}})
    EXPECT_NEAR(poses.pose(frame).translation().x(), x, 1e-6) << frame;
  EXPECT_TRUE(poses.notes().empty());
}

TEST_F(Frames, PosesFarApartAreReported) {
  folder_.write("x.mcap", mcap_file({cloud(0, 0), cloud(1, 1), cloud(8, 2)}));
  folder_.write("gap.txt", "1700000000 0 0 0 0 0 0 1\n1700000000.3 0.1 0 0 0 0 0 1\n");
  const CameraPath path(RigidTransform::Identity(), "gap.txt", PoseDirection::camera_to_world,
                        index_recording(folder_ / "x.mcap"), folder_ / ".");
  ASSERT_EQ(path.notes().size(), 1u);
  EXPECT_HAS(path.notes()[0].text,
             "3 of 3 frames lie between poses that are more than 0.1 s apart, at most 0.3 s");
}

// The first CameraInfo is used. A later one that differs, as after a change of zoom, is reported.
TEST_F(Frames, DepthFramesReportACameraThatChanges) {
  const BagMessage first = camera("/x/camera_info");
  BagMessage later = first, other = first;
  later.bytes = camera_message(4, 3, {-0.1, 0, 0, 0, 0});
  other.bytes = camera_message(4, 3, {-0.2, 0, 0, 0, 0});
  EXPECT_EQ(frames({first, depth(0, "/x/image_raw"), later}).camera_change(), "");
  const BagFrames all = frames({first, depth(0, "/x/image_raw"), later, other, other});
  EXPECT_HAS(all.camera_change(),
             "x.mcap: /x/camera_info, message 2, differs from message 0, which is used for all frames");
  EXPECT_EQ(all.cloud(0, kNoLimit).x, frames({first, depth(0, "/x/image_raw")}).cloud(0, kNoLimit).x);
  other.bytes.resize(20);
  EXPECT_HAS(frames({first, depth(0, "/x/image_raw"), other}).camera_change(), "message 1, differs");
}

TEST_F(Frames, AreOfTheOnlyTopicThatFits) {
  EXPECT_EQ(frames({cloud(0, 0, "/a"), cloud(0, 0, "/b"), cloud(1, 1, "/b")}, {"/b", "", {}, ""})
                .captured_s()
                .size(),
            2u);
  EXPECT_EQ(frames({cloud(0, 0), colours("rgb8")}).captured_s().size(), 1u) << "colour images are no frames";
}

TEST_F(Frames, DepthFramesHaveTheCameraBesideThem) {
  const BagFrames raw_ones =
      frames({camera("/x/camera_info"), camera("/y/camera_info"), depth(0, "/x/image_raw")});
  EXPECT_EQ(raw_ones.camera().fx, 10);
  EXPECT_GT(raw_ones.cloud(0, kNoLimit).image->pixel_slack, 1e-4);
  const BagFrames rectified = frames({camera("/x/camera_info"), depth(0, "/x/image_rect")});
  EXPECT_EQ(rectified.camera().fx, 20);
  EXPECT_LE(rectified.cloud(0, kNoLimit).image->pixel_slack, 1e-6);
  EXPECT_NEAR(rectified.cloud(0, kNoLimit).z[0], 1, 1e-12);
  BagChoice choice;
  choice.depth_unit_m = 0.00025, choice.images = BagChoice::Images::measured;
  const BagFrames chosen = frames({camera("/x/camera_info"), depth(0, "/x/image_rect")}, choice);
  EXPECT_EQ(chosen.camera().fx, 10);
  EXPECT_NEAR(chosen.cloud(0, kNoLimit).z[0], 0.25, 1e-12);
  for (const BagMessage& other : {camera("/y/camera_info"), camera_of("/y/camera_info", "colours")})
    EXPECT_EQ(frames({other, depth(0, "/x/image_raw")}, {"", "/y/camera_info", {}, ""}).camera().width, 4)
        << "the user knows that it is theirs";
}

TEST_F(Frames, ComeToTheChosenCoordinateFrame) {
  const std::vector<BagMessage> bag = {cloud(0, 0), transforms({{"base", "body"}, {"body", "optical"}}, 1)};
  EXPECT_TRUE((frames(bag, {"", "", {}, "body"}).pose() * Vec3(1, 2, 3)).isApprox(Vec3(1, 2, -3)));
  EXPECT_TRUE((frames(bag, {"", "", {}, "base"}).pose() * Vec3(1, 2, 3)).isApprox(Vec3(0, 2, 3)));
  EXPECT_TRUE(frames(bag, {"", "", {}, "/optical"}).pose().matrix().isIdentity(0));
}

// One row for each refusal, and some that are none.
TEST_F(Frames, WithoutAClearMeaningAreRefused) {
  struct Row {
    std::vector<BagMessage> bag;
    BagChoice choice;
    std::string text = "no InputError";
  };
  const std::string several =
      "has several topics of clouds or depth images: expected scenario.topic as one of ";
  const std::string none =
      "has no topic of clouds or depth images: expected a topic of sensor_msgs/PointCloud2, "
      "sensor_msgs/Image (16UC1, mono16, Z16 or 32FC1) or sensor_msgs/CompressedImage "
      "(compressedDepth); there are ";
  const BagMessage image = depth(0, "/x/image_raw"), tf = transforms({{"base", "body"}, {"body", "optical"}});
  BagMessage no_rotation = transforms({{"base", "optical"}});
  no_rotation.bytes.replace(no_rotation.bytes.size() - 24, 24, std::string(24, '\0'));  // y, z and w
  BagChoice unit, measured;
  unit.depth_unit_m = 0.001, measured.images = BagChoice::Images::measured;
  const BagChoice in_base{"", "", {}, "base"};
  std::vector<std::pair<std::string, std::string>> most, too_many;  // coordinate frames
  for (int i = 0; i < 10000; ++i) too_many.push_back({"base", "frame_" + std::to_string(i)});
  most.assign(too_many.begin(), too_many.end() - 2);
  const Row rows[] = {
      {{cloud(0, 0, "/a"), cloud(0, 0, "/b"), cloud(1, 1, "/b")},
       {},
       several + "/a (sensor_msgs/PointCloud2, 1 messages), /b (sensor_msgs/PointCloud2, 2 messages)"},
      {{cloud(0, 0)}, {"/c", "", {}, ""}, "scenario.topic = /c: expected a topic of"},
      {{}, {}, "there are none"},
      {{colours("rgb8"), colours("mono8")},
       {},
       none + "/rgb8 (sensor_msgs/Image rgb8, 1 messages), /mono8 (sensor_msgs/Image mono8, 1 messages)"},
      {{camera("/y/camera_info"), image},
       {},
       "has no camera beside /x/image_raw: expected scenario.camera_info as one of /y/camera_info (sensor_msgs"},
      {{camera_of("/x/camera_info", "colours"), image},
       {},
       "x.mcap: /x/camera_info has frame_id = \"colours\" where the images have \"optical\": expected "
       "scenario.camera_info as one of /x/camera_info"},
      {{camera("/x/camera_info"), image},
       {"", "/z", {}, ""},
       "scenario.camera_info = /z: expected a topic of"},
      {{camera("/x/camera_info", 5), image},
       {},
       "/x/image_raw, message 0: has 4 x 3 pixels: expected 5 x 3, as its CameraInfo has"},
      {{cloud(0, 0), cloud_in("elsewhere")}, {}, "message 1: frame_id = elsewhere: expected optical"},
      {{cloud(0, 0), cloud_in("/optical")}, {}},  // as older programs write it
      {{cloud(0, 0), cloud_in("elsewhere"), tf}, in_base, "frame_id = elsewhere: expected optical"},
      {realsense(1e-9f), {}},
      {realsense(4e-10f), {}, "depth unit = 4e-10 m: expected 1e-9 to 1"},  // rounded to 0
      {realsense(2), {}, "depth unit = 2 m: expected 1e-9 to 1"},
      {{cloud(0, 0)}, unit, "/points holds clouds, in metres: expected scenario.depth_unit_m = 0"},
      {{cloud(0, 0)}, measured, "/points holds clouds: expected scenario.images = by-name"},
      {{cloud(0, 0)}, {"", "/x", {}, ""}, "/points holds clouds: expected scenario.camera_info = \"\""},
      {{cloud(0, 0), tf}, {"", "", {}, "moon"}, "it has body in base, optical in body"},
      {{cloud(0, 0)}, in_base, "it has none"},
      {{cloud(0, 0), transforms({{"optical", "body"}, {"body", "optical"}})}, in_base, "as its own ancestor"},
      {{cloud(0, 0), no_rotation},
       in_base,
       "to 'base': expected finite numbers and a quaternion of length 1"},
      {{cloud(0, 0), tf, transforms(most)}, in_base},
      {{cloud(0, 0), tf, transforms(too_many)},
       in_base,
       "/tf_static, message 1: has too many coordinate frames: expected at most 10000"},
      {{cloud(0, 0), cut_cloud(100)}, {}, "/points, message 1: ends after 100 bytes"},
      {{cloud(0, 0), cut_cloud(7)}, {}, "/points: ends after 7 bytes"},
  };
  for (const Row& row : rows) EXPECT_HAS(error(row.bag, row.choice), row.text);
  folder_.write("x.pcd", "");
  const std::pair<BagChoice, std::string> only_for_bags[] = {
      {unit, "depth_unit_m = 0"}, {{"/points", "", {}, ""}, "topic = \"\""}, {measured, "images = by-name"}};
  for (const auto& row : only_for_bags)
    EXPECT_HAS(refusal([&] { index_recording(folder_ / "x.pcd", row.first); }),
               "is not a ROS bag: expected scenario." + row.second);
}

// The messages have two sizes. One is empty, which is an image without a measurement.
TEST_F(Frames, AFrameOfAnotherSizeIsRefusedWithItsMessage) {
  BagMessage smaller = cloud(1, 1), empty = cloud(2, 2);
  smaller.bytes = cloud_message(Format::cdr, kStart_ns + kStep_ns, 3, 2, 1);
  empty.bytes = cloud_message(Format::cdr, kStart_ns + 2 * kStep_ns, 0, 1, 1);
  folder_.write("x.mcap", mcap_file({cloud(0, 0), smaller, empty}));
  RecordedScene::Settings settings;
  settings.path = (folder_ / "x.mcap").string();
  const RecordedScene scene(settings, {}, scenes::kernels());
  EXPECT_HAS(refusal([&] { scene.points(1); }),
             "x.mcap: /points, message 1: has 3 x 2 points: expected 4 x 3 points, as the first frame");
  ASSERT_TRUE(scene.cloud(2).image);
  EXPECT_TRUE(std::isnan(scene.cloud(2).z[11]));
}

// The whole chain: a bag of ROS 1 as a scenario, from a RealSense with units of half a millimetre.
TEST_F(Frames, MakeAScenario) {
  const std::string sensor = "/device_0/sensor_0/";
  const auto ros1 = [&](std::uint16_t value, std::int64_t stamp_ns) {
    MessageBytes bytes(Format::ros1);
    bytes.header(stamp_ns, "0").add(3).add(4).text("mono16").add(std::uint8_t{0}).add(8);
    std::string data;
    for (int i = 0; i < 12; ++i) data += raw(value);
    return bytes.bytes(data).done();
  };
  MessageBytes info(Format::ros1);
  info.header(0, "0").add(3).add(4).text("None").add(0);
  for (const double k : {10.0, 0.0, 1.5, 0.0, 10.0, 1.0, 0.0, 0.0, 1.0}) info.add(k);
  for (int i = 0; i < 21; ++i) info.add(0.0);
  for (int i = 0; i < 6; ++i) info.add(std::uint32_t{0});  // binning, region of interest
  info.add(std::uint8_t{0});
  folder_.write("x.bag",
                ros1_file({{sensor + "option/Depth Units/value", "std_msgs/msg/Float32", 1, raw(0.0005f)},
                           {sensor + "Depth_0/info/camera_info", kCamera, 1, info.done()},
                           {sensor + "Depth_0/image/data", kImage, 1, ros1(2000, kStart_ns)},
                           {sensor + "option/Depth Units/value", "std_msgs/msg/Float32", 2, raw(0.001f)},
                           {sensor + "Depth_0/image/data", kImage, 2, ros1(3000, kStart_ns + kStep_ns)}}));
  RecordedScene::Settings settings;
  settings.path = (folder_ / "x.bag").string();
  const RecordedScene scene(settings, {}, scenes::kernels());
  EXPECT_EQ(scene.frame_count(), 2);
  EXPECT_EQ(scene.frame_rate_hz(), 32);
  EXPECT_EQ(scene.captured_s(1), 0.03125);
  EXPECT_TRUE(scene.cloud(1).point(0).isApprox(Vec3(-0.225, -0.15, 1.5)));
  ASSERT_EQ(scene.input_notes().size(), 2u);
  EXPECT_EQ(scene.input_notes()[0].kind, "frames apart") << "a wall 1 m away, and one 1.5 m away";
  EXPECT_EQ(scene.input_notes()[1].kind, "camera changes");
  EXPECT_HAS(scene.input_notes()[1].text, "Depth Units/value, message 1, differs from message 0");
  EXPECT_EQ(scene.cloud(0).z[0], 1);
  EXPECT_NEAR(scene.signed_distance(Vec3(0, 0, 0.99), 0), 0.01, 1e-9);
  EXPECT_TRUE(scene.true_normal(Vec3(0, 0, 0.99), 0).array().isNaN().all()) << "no independent truth";
}

}  // namespace
}  // namespace remote_touch::bag_frames_test
