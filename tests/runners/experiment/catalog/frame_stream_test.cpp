// Frames between capture and arrival: which frames a renderer receives, when, and with which fixtures.
#include "runners/experiment/catalog/frame_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "analysis/trace/columns.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "scenarios/recordings/recorded_scene.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/doubles/frame_recorder.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::frame_stream_test {
namespace {

enum class After { repeats, ends };

// One point, which is at x = j in frame j.
class Walk final : public Scenario {
 public:
  explicit Walk(int frames, After after = After::repeats) : frames_(frames), after_(after) {}
  bool ends() const override { return after_ == After::ends; }
  double frame_rate_hz() const override { return 100; }
  int frame_count() const override { return frames_; }
  PointCloud cloud(int frame) const override {
    EXPECT_TRUE(frame >= 0 && frame < frames_) << frame;
    PointCloud cloud;
    cloud.append({static_cast<double>(frame), 0, 0});
    return cloud;
  }
  double signed_distance(const Vec3&, double) const override { return 0; }

 private:
  int frames_;
  After after_;
};

const PointCloud& cloud_of(const Frame& frame) {
  return *frame.points->stored_cloud();
}

FixtureAssignment everywhere(double radius_m, std::vector<double> schedule = {}) {
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(std::make_unique<Everywhere>(Everywhere::Settings{{radius_m, -1, std::move(schedule)}}));
  return FixtureAssignment(std::move(rules));
}

std::vector<Frame> received(const Scenario& scenario, double until_s, const Transport& transport,
                            std::uint64_t seed = 1, FixtureAssignment fixtures = {}) {
  FrameStream stream(scenario, {nullptr, std::move(fixtures)}, transport, {seed}, false);
  return received(stream, until_s);
}

std::vector<int> indices(const std::vector<Frame>& frames) {
  std::vector<int> list;
  for (const Frame& frame : frames) list.push_back(frame.index);
  return list;
}

// --- delivery ---

TEST(FrameStream, LatencyIsAddedToTheTimeOfCapture) {
  for (const double latency_s : {0.0, 0.0525}) {
    const auto frames = received(Walk(50), 0.3, {latency_s});
    ASSERT_EQ(frames.size(), latency_s == 0 ? 31u : 25u);  // captured by 0.3 or 0.2475 s
    for (std::size_t j = 0; j < frames.size(); ++j) {
      const Frame& frame = frames[j];
      EXPECT_EQ(frame.index, static_cast<int>(j));
      EXPECT_EQ(frame.captured_s, frame.index / 100.0);
      EXPECT_EQ(frame.arrives_s, frame.captured_s + latency_s);
      EXPECT_EQ(cloud_of(frame).x, std::vector<double>{static_cast<double>(j)});
      EXPECT_FALSE(frame.points->has_fixture_radius() || frame.points->has_stiffness());
    }
  }
  EXPECT_TRUE(received(Walk(50), 0.05, {0.0525}).empty());
}

TEST(FrameStream, FramesArriveInTheOrderOfTheirArrival) {
  const Transport transport{0.02, 0.05};
  const auto frames = received(Walk(2000, After::ends), 21, transport);
  ASSERT_EQ(frames.size(), 2000u);
  double sum = 0;
  int overtaken = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double delay = frames[i].arrives_s - frames[i].captured_s;
    EXPECT_GE(delay, 0.02 - 1e-12);
    EXPECT_LE(delay, 0.07 + 1e-12);
    sum += delay;
    if (i == 0) continue;
    EXPECT_GE(frames[i].arrives_s, frames[i - 1].arrives_s);
    overtaken += frames[i].index < frames[i - 1].index ? 1 : 0;
  }
  EXPECT_GT(overtaken, 200);
  // Evenly spread: the mean is half the jitter, within 5 standard deviations of 2000 draws.
  EXPECT_NEAR(sum / 2000, 0.045, 5 * 0.05 / std::sqrt(12 * 2000.0));
  std::vector<int> sorted = indices(frames);
  std::sort(sorted.begin(), sorted.end());
  for (int j = 0; j < 2000; ++j) ASSERT_EQ(sorted[static_cast<std::size_t>(j)], j) << "each comes once";
}

// The frames come in the same order, however often the stream is polled.
TEST(FrameStream, DeliveryIsDrawnFromTheKey) {
  const Transport transport{0, 0.05, 0.2};
  const auto once = received(Walk(300), 4, transport, 7), again = received(Walk(300), 4, transport, 7),
             other = received(Walk(300), 4, transport, 8);
  EXPECT_EQ(indices(once), indices(again));
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].arrives_s, again[i].arrives_s);
  EXPECT_NE(indices(once), indices(other));
  const Walk walk(300);
  FrameStream stream(walk, {}, transport, {7}, false);
  FrameRecorder late;
  stream.deliver_until(4, late);
  EXPECT_EQ(indices(late.frames), indices(once));
}

TEST(FrameStream, DropsItsShareOfTheFrames) {
  EXPECT_EQ(received(Walk(2000, After::ends), 21, {0, 0, 0}).size(), 2000u);
  EXPECT_TRUE(received(Walk(2000), 21, {0, 0, 1}).empty());
  const auto frames = received(Walk(2000), 19.995, {0, 0, 0.3});
  EXPECT_NEAR(static_cast<double>(frames.size()) / 2000, 0.7, 4 * std::sqrt(0.3 * 0.7 / 2000));
  // Losses are independent: the frame after a lost one is lost as often as any other.
  std::vector<bool> came(2000);
  for (const Frame& frame : frames) came[static_cast<std::size_t>(frame.index)] = true;
  int lost = 0, twice = 0;
  for (std::size_t j = 1; j < came.size(); ++j)
    if (!came[j - 1]) ++lost, twice += came[j] ? 0 : 1;
  EXPECT_NEAR(static_cast<double>(twice) / lost, 0.3, 4 * std::sqrt(0.3 * 0.7 / lost));
}

// A lost frame changes nothing for the others.
TEST(FrameStream, LossAndJitterAreDrawnApart) {
  const Walk walk(300);
  const auto all = received(walk, 4, {0, 0.05, 0}, 3), some = received(walk, 2.995, {0, 0.05, 0.5}, 3);
  double slow = 0;
  for (const Frame& frame : some) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const Frame& f) { return f.index == frame.index; });
    ASSERT_NE(same, all.end());
    EXPECT_EQ(same->arrives_s, frame.arrives_s);
    slow += (frame.arrives_s - frame.captured_s) / static_cast<double>(some.size());
  }
  EXPECT_NEAR(slow, 0.025, 5 * 0.05 / std::sqrt(12.0 * static_cast<double>(some.size())));
}

// --- a scene that stops, and a scene at rest ---

// The renderer can tell only by further frames that a surface which moved has come to rest.
TEST(FrameStream, ACameraKeepsItsRateWhenTheSceneStops) {
  for (const double latency_s : {0.0, 0.0325}) {
    const auto frames = received(Walk(3), 0.201 + latency_s, {latency_s});
    ASSERT_EQ(frames.size(), 21u);
    for (int j = 0; j < 21; ++j) {
      const Frame& frame = frames[static_cast<std::size_t>(j)];
      EXPECT_EQ(frame.index, j);
      EXPECT_NEAR(frame.captured_s, j / 100.0, 1e-12);
      EXPECT_NEAR(frame.arrives_s, j / 100.0 + latency_s, 1e-12);
      EXPECT_EQ(cloud_of(frame).x, std::vector<double>{std::min<double>(j, 2)});
    }
  }
  EXPECT_EQ(indices(received(Walk(3, After::ends), 0.2, {})), (std::vector<int>{0, 1, 2}));
}

TEST(FrameStream, ASceneAtRestIsSentOnce) {
  EXPECT_EQ(indices(received(Walk(1), 1, {})), std::vector<int>{0});
  const auto protected_once = received(Walk(1), 1, {}, 1, everywhere(0.02));
  ASSERT_EQ(protected_once.size(), 1u);
  EXPECT_EQ(cloud_of(protected_once[0]).fixture_radius_m, std::vector<double>{0.02});
  EXPECT_EQ(received(Walk(1), 1, {}, 1, everywhere(0.02, {0, 0.5, 1, 0.5})).size(), 1u);
}

TEST(FrameStream, ASceneAtRestIsSentAgainWhenItsFixturesChange) {
  const auto frames = received(Walk(1), 0.3, {0.01}, 1, everywhere(0.02, {0.1, 0, 0.2, 1}));
  ASSERT_EQ(frames.size(), 30u);
  for (int j = 0; j < 30; ++j) {
    const Frame& frame = frames[static_cast<std::size_t>(j)];
    EXPECT_EQ(frame.index, j);
    EXPECT_NEAR(frame.captured_s, j / 100.0, 1e-12);
    EXPECT_NEAR(frame.arrives_s, j / 100.0 + 0.01, 1e-12);
    EXPECT_EQ(cloud_of(frame).x, std::vector<double>{0});
    // The schedule uses the time of capture, not of arrival.
    EXPECT_NEAR(cloud_of(frame).fixture_radius_m.at(0), 0.02 * std::clamp((j - 10) / 10.0, 0.0, 1.0), 1e-12);
  }
}

// The camera sends frames all the time, so others follow a lost one.
TEST(FrameStream, ASceneAtRestIsRepeatedIfFramesCanBeLost) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const auto frames = received(Walk(1), 1, {0, 0, 0.5}, seed);
    ASSERT_GT(frames.size(), 25u) << seed;
    ASSERT_LT(frames.size(), 75u) << seed;
    for (const Frame& frame : frames) {
      EXPECT_EQ(frame.captured_s, frame.index / 100.0);
      EXPECT_EQ(cloud_of(frame).x, std::vector<double>{0});
    }
  }
}

// --- hashes ---

std::vector<std::uint64_t> hashes(const Scenario& scenario, FixtureAssignment fixtures,
                                  double latency_s = 0) {
  FrameStream stream(scenario, {nullptr, std::move(fixtures)}, {latency_s}, {1}, true);
  FrameRecorder recorder;
  std::vector<std::uint64_t> list;
  for (int tick = 0; tick < 40; ++tick) {
    stream.deliver_until(0.001 * tick, recorder);
    list.push_back(stream.newest_hash());
  }
  return list;
}

TEST(FrameStream, TheNewestHashIsThatOfTheNewestFrame) {
  const auto plain = hashes(Walk(3), {}), late = hashes(Walk(3), {}, 0.005);
  EXPECT_NE(plain[0], 0u);
  EXPECT_EQ(plain[0], plain[9]);
  EXPECT_NE(plain[9], plain[10]);
  EXPECT_NE(plain[19], plain[20]);
  EXPECT_NE(plain[29], plain[30]) << "a repetition has another time of capture";
  EXPECT_EQ(late[4], 0u) << "before the first frame";
  for (std::size_t tick = 5; tick < late.size(); ++tick) EXPECT_EQ(late[tick], plain[tick - 5]) << tick;
}

// Rises for two frames.
MovingLift short_lift() {
  MovingLift::Settings settings;
  settings.grid = {4, 4, 0.0015, 0, 0}, settings.noise_sigma_m = 0;
  settings.lift.rise_s = 2 / 30.0, settings.lift.acceleration_s = 0;
  return {settings, {1}, scenes::kernels()};
}

// The points are made on request, by the number of the frame. A scene that is sent on shows its last frame.
TEST(FrameStream, ARepeatedFrameHasThePointsAndTheHashOfTheLastFrame) {
  const MovingLift lift = short_lift();
  const std::uint64_t points = points_hash(lift.cloud(lift.frame_count() - 1));
  for (const bool made : {false, true}) {
    FrameStream stream(lift, {}, {}, {1}, true, made);
    const Frame last = received(stream, 0.299).back();
    ASSERT_GT(last.index, lift.frame_count());
    EXPECT_EQ(stream.newest_hash(), mixed(points, std::bit_cast<std::uint64_t>(last.captured_s))) << made;
    const PointCloud* const stored = last.points->stored_cloud();
    ASSERT_EQ(stored != nullptr, made);
    EXPECT_TRUE(!made || points_hash(*stored) == points);
  }
}

TEST(FrameStream, TheHashChangesWithTheFixtures) {
  const Walk rest(1);
  const auto plain = hashes(rest, {}), small = hashes(rest, everywhere(0.02)),
             large = hashes(rest, everywhere(0.03));
  EXPECT_NE(plain[0], small[0]);
  EXPECT_NE(small[0], large[0]);
  EXPECT_EQ(small, hashes(rest, everywhere(0.02)));
  const auto changing = hashes(rest, everywhere(0.02, {0, 1, 1, 0}));
  EXPECT_EQ(changing[0], small[0]);
  EXPECT_NE(changing[9], changing[10]);
}

// --- a recording that ends ---

RecordedScene::Settings two_frames(const TestFolder& folder) {
  folder.write_depth("depth/0000.png", 500), folder.write_depth("depth/0001.png", 600);
  folder.write("camera.json", R"({"width": 3, "height": 2, "fx": 10, "fy": 10, "cx": 1, "cy": 0.5,
                                  "depth_scale_m": 0.001, "frame_rate_hz": 20})");
  RecordedScene::Settings settings;
  settings.path = folder.path().string();
  return settings;
}

TEST(FrameStream, ARecordingThatIsHeldRepeatsItsLastFrame) {
  const TestFolder folder("frame_stream_test");
  const RecordedScene scene(two_frames(folder), {}, scenes::kernels());
  EXPECT_EQ(received(scene, 0.5, {}).size(), 11u);

  // Fixtures go on to change, on the last image of the camera.
  const auto frames = received(scene, 0.5, {}, 1, everywhere(0.02, {0, 0, 0.5, 1}));
  ASSERT_EQ(frames.size(), 11u);
  for (std::size_t j = 0; j < frames.size(); ++j) {
    EXPECT_NEAR(frames[j].captured_s, 0.05 * static_cast<double>(j), 1e-12);
    EXPECT_EQ(cloud_of(frames[j]).z, scene.cloud(j == 0 ? 0 : 1).z);
    EXPECT_NEAR(cloud_of(frames[j]).fixture_radius_m.at(0), 0.002 * static_cast<double>(j), 1e-12);
    EXPECT_TRUE(cloud_of(frames[j]).image.has_value());
  }
}

// A registration moves the cloud, its camera and the truth as one.
TEST(FrameStream, ARecordingIsRegisteredToTheBaseFrame) {
  const TestFolder folder("frame_stream_test");
  RecordedScene::Settings settings = two_frames(folder);
  const RecordedScene as_recorded(settings, {}, scenes::kernels());
  settings.camera_position_m = {1, 2, 3}, settings.camera_rotation_deg = {0, 0, 90};
  const RecordedScene moved(settings, {}, scenes::kernels());
  const PointCloud before = as_recorded.cloud(0), after = moved.cloud(0);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Vec3 p = before.point(i), expected(1 - p.y(), 2 + p.x(), 3 + p.z());
    EXPECT_LT((after.point(i) - expected).norm(), 1e-12);
  }
  ASSERT_TRUE(after.image);
  EXPECT_LT((after.image->X_WC.translation() - Vec3(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((after.image->X_WC.linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
}

}  // namespace
}  // namespace remote_touch::frame_stream_test
