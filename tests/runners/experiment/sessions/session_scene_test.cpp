// A recorded session as a scenario, as a trajectory, and as an experiment; the points of its frames.
#include <gtest/gtest.h>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/points/vector.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/sessions/session_scene.h"
#include "tests/runners/experiment/sessions/small_session.h"
#include "tests/support/note_kinds.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::session_scene_test {
namespace {

using Json = nlohmann::json;

// Ticks 3, 4, 7, 9 and 12 at 500 Hz. The second of three frames was overtaken.
class SessionSceneTest : public testing::Test {
 protected:
  SessionSceneTest() {
    session_.config = R"({"haptic_rate_hz": 500})";
    session_.registered = RigidTransform(Eigen::Translation3d(1, 2, 3));
    session_.add_frame(7, 0.001), session_.add_frame(8, 0.004, 600, 5), session_.add_frame(10, 0.01, 700);
    session_.add_tick(3), session_.add_tick(4, 0), session_.add_tick(7), session_.add_tick(9, 2);
    session_.add_tick(12);
  }

  SessionScene scene() const { return {{session_.write(file_)}, {}, scenes::kernels()}; }
  SessionHand hand() const {
    const SessionScene any = scene();
    return {{file_.string()}, any};
  }

  const TestFolder folder_{"session_scene"};
  const std::filesystem::path file_ = folder_ / "session.h5";
  SmallSession session_;
};

// --- the scenario ---

TEST_F(SessionSceneTest, AFrameArrivesWhenTheRendererTookIt) {
  const SessionScene scene = this->scene();
  EXPECT_EQ(scene.delivery(0).leaves_sensor_s, 4 / 500.0);
  EXPECT_EQ(scene.delivery(1).leaves_sensor_s, std::numeric_limits<double>::infinity())
      << "the renderer never got it";
  EXPECT_EQ(scene.delivery(2).leaves_sensor_s, 9 / 500.0);
}

TEST_F(SessionSceneTest, FramesAreThoseOfTheFile) {
  const SessionScene scene = this->scene();
  EXPECT_EQ(scene.frame_count(), 3);
  EXPECT_EQ(scene.frame_rate_hz(), 30);
  EXPECT_TRUE(scene.ends());
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(scene.captured_s(i), session_.captured_s[at]);
    EXPECT_EQ(scene.delivery(i).fixtures_off, session_.fixtures_off[at]);
    const PointCloud live = cloud_of(session_.frames[at], session_.view, session_.registered);
    const PointCloud cloud = scene.cloud(i);
    EXPECT_EQ(cloud.x, live.x);
    EXPECT_EQ(cloud.y, live.y);
    EXPECT_EQ(cloud.z, live.z);
    EXPECT_EQ(scene.points(i)->size(), cloud.size());
  }
  EXPECT_TRUE(std::isnan(scene.signed_distance(Vec3::Zero(), 0))) << "there is no truth";
}

// Frames of 3 x 2 pixels: 500 units of 0.5 mm and more. The renderer received the first and the last; the
// frame that was overtaken belongs to no run.
TEST_F(SessionSceneTest, ReportsTheFramesThatWereRead) {
  const std::string unused = file_.string() + ": 1 of 2 frames were not used: ";
  const SessionScene first = scene(), last({file_.string()}, {}, scenes::kernels());
  first.cloud(0), first.points(0), last.points(2);
  EXPECT_EQ(first.input(), file_.string() +
                               ": 3 frame(s) of a live session, 3 x 2 pixels; 1 read: "
                               "100 % of 6 points measured, depth 0.25 to 0.253 m, without colours");
  ASSERT_EQ(kinds_of(first.input_notes()), Kinds{"frames unused"});
  EXPECT_EQ(first.input_notes()[0].text, unused + "the run ended before them");
  ASSERT_EQ(kinds_of(last.input_notes()), Kinds{"frames unused"});
  EXPECT_EQ(last.input_notes()[0].text, unused + "newer frames replaced them, or they were lost");
  first.points(2);
  EXPECT_TRUE(first.input_notes().empty());
  EXPECT_HAS(first.input(), "2 read: 100 % of 12 points measured, depth 0.25 to 0.35");
}

TEST_F(SessionSceneTest, IsRefusedIfThereAreNoFramesOrTicks) {
  session_.ticks.clear();
  EXPECT_EQ(refusal([this] { hand(); }), file_.string() + ": has no ticks: expected a session with some");
  session_.frames.clear();
  EXPECT_EQ(refusal([this] { scene(); }), file_.string() + ": has no frames: expected a session with some");
  EXPECT_HAS(refusal([this] { SessionScene({(folder_ / "none.h5").string()}, {}, scenes::kernels()); }),
             "none.h5: no such recording");
  EXPECT_HAS(validate(SessionSettings{}), "path = \"\": expected a file of remote-touch live --record");
  EXPECT_EQ(input_files(SessionSettings{"session.h5"}), InputPart{"session.h5"});
}

// --- the hand ---

// The hand is that of the tick, or of the one before; of the first one before the session, and of the last
// one after it. Ticks that are not there were missed.
TEST_F(SessionSceneTest, TheHandIsThatOfTheTickOrTheOneBefore) {
  const SessionHand hand = this->hand();
  const std::pair<double, double> rows[] = {
      {-1e9, 3},     {0, 3},        {2, 3},       {3, 3}, {4, 4},  {5, 4},   {6, 4},   {7 - 0.4, 7}, {7, 7},
      {7 - 1e-9, 7}, {7 + 1e-9, 7}, {7 + 0.4, 7}, {8, 7}, {11, 9}, {12, 12}, {13, 12}, {1e9, 12}};
  for (const auto& [number, position_m] : rows)
    EXPECT_EQ(hand.at(number / 500).position_W.x(), position_m) << number;
  for (int number = 0; number <= 13; ++number) {
    const bool is_there = number == 3 || number == 4 || number == 7 || number == 9 || number == 12;
    EXPECT_EQ(hand.is_missed(number / 500.0), !is_there) << number;
  }
  EXPECT_EQ(hand.duration_s(), 13 / 500.0) << "its last tick included";
}

TEST_F(SessionSceneTest, ASessionOfOneTickHasAHand) {
  session_.ticks.resize(1);
  const SessionHand hand = this->hand();
  for (const double number : {0.0, 3.0, 5.0}) EXPECT_EQ(hand.at(number / 500).position_W.x(), 3) << number;
  EXPECT_EQ(hand.duration_s(), 4 / 500.0);
}

// --- the experiment ---

// Settings that made the frames and moved the hand are dropped, because the recording contains their effects.
// Fixtures and renderer are applied again.
TEST_F(SessionSceneTest, TheExperimentIsTheRecordedOneWithTheseFramesAndThisHand) {
  session_.config = R"({"haptic_rate_hz": 500, "seed": 7, "duration_s": 9, "frame_latency_s": 0.1,
    "frame_jitter_s": 0.01, "frame_drop_probability": 0.5, "scenario": {"name": "ramp", "width": 64},
    "trajectory": {"name": "press"}, "renderer": {"name": "proxy", "r1_m": 0.004}, "fixtures": [{"name": "everywhere"}],
    "faults": {}, "operator": {}, "device": {}, "live": {}, "safety": {}})";
  const Json file = {{"name", "live-session"}, {"path", session_.write(file_)}};
  const Json expected = {{"haptic_rate_hz", 500},
                         {"seed", 7},
                         {"duration_s", 0},
                         {"frame_latency_s", 0},
                         {"frame_jitter_s", 0},
                         {"frame_drop_probability", 0},
                         {"scenario", file},
                         {"trajectory", file},
                         {"renderer", {{"name", "proxy"}, {"r1_m", 0.004}}},
                         {"fixtures", Json::array({{{"name", "everywhere"}}})}};
  EXPECT_EQ(Json::parse(session_experiment(file_.string())), expected);
}

TEST_F(SessionSceneTest, AnExperimentOfNoSessionIsRefused) {
  EXPECT_HAS(refusal([this] { session_experiment((folder_ / "none.h5").string()); }),
             "none.h5: no such recording");
  session_.config = "[]";
  EXPECT_EQ(
      refusal([this] { session_experiment(session_.write(file_)); }),
      file_.string() +
          ": damaged (its attributes view and config cannot be read): expected a result of this program");
  // The title would be printed by a function that calls itself for every level.
  session_.config =
      R"({"haptic_rate_hz": 1000, "title": )" + std::string(100'000, '[') + std::string(100'000, ']') + "}";
  EXPECT_HAS(refusal([this] { session_experiment(session_.write(file_)); }), "nested too deep");
}

// --- clouds of points: every frame has its own number of them ---

TEST(SessionCloud, GivesBackCloudsWithAndWithoutNormalsAndColour) {
  for (const bool more : {false, true}) {
    const TestFolder folder("session_file");
    SensorView view;
    view.cloud = {more, 3, 100};
    view.has_colour = more;
    std::vector<SensorFrame> frames(3);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t points = i == 1 ? 0 : 3 * (i + 1);
      frames[i].number = static_cast<int>(i);
      for (std::size_t k = 0; k < points * view.cloud->numbers_per_point(); ++k)
        frames[i].points.push_back(static_cast<float>(k) / 3);
      if (more) frames[i].colour.assign(points, 0xff8000 + static_cast<std::uint32_t>(i));
    }
    frames[2].points[4] = std::numeric_limits<float>::quiet_NaN();
    SessionWriter writer(folder / "x.h5", view, RigidTransform::Identity(),
                         {{"config", R"({"haptic_rate_hz": 1000})"}});
    for (const SensorFrame& frame : frames) writer.append(frame, 0.1 * frame.number, 0);
    writer.finish();
    const SessionReader read(folder / "x.h5");
    ASSERT_TRUE(read.view().cloud);
    EXPECT_EQ(read.view().cloud->has_normals, more);
    EXPECT_EQ(read.view().cloud->grid_columns, 3);
    ASSERT_EQ(read.frame_count(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const SensorFrame frame = read.frame(i);
      EXPECT_TRUE(frame.depth.empty());
      EXPECT_EQ(frame.colour, frames[i].colour);
      ASSERT_EQ(frame.points.size(), frames[i].points.size());
      // Bit for bit, since one of the numbers is a NaN, which does not equal itself.
      for (std::size_t k = 0; k < frame.points.size(); ++k)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(frame.points[k]),
                  std::bit_cast<std::uint32_t>(frames[i].points[k]));
      EXPECT_TRUE(is_complete(frame, read.view()));
    }
  }
}

// A frame must have all that its view promises before it is used.
TEST(SessionCloud, AFrameWithHalfAPointIsNotComplete) {
  SensorView view;
  view.cloud = {true, 0, 1};
  SensorFrame frame;
  frame.points.assign(12, 1);
  EXPECT_TRUE(is_complete(frame, view));
  frame.points.pop_back();
  EXPECT_FALSE(is_complete(frame, view));
  frame.points.assign(12, 1);
  view.has_colour = true;
  EXPECT_FALSE(is_complete(frame, view));
  frame.colour.assign(2, 0);
  EXPECT_TRUE(is_complete(frame, view));
}

// --- the points of a sensor's frame ---

// The pixels are not square, and the centre is not in the middle.
const SensorView kView{{4, 3, 200, 250, 1.25, 0.75}, 0.0005, 30, false, RigidTransform::Identity()};

SensorFrame frame_of(std::uint16_t first_depth) {
  SensorFrame frame;
  for (std::uint16_t i = 0; i < 12; ++i)
    frame.depth.push_back(static_cast<std::uint16_t>(first_depth + 100 * i));
  return frame;
}

RigidTransform somewhere() {
  RigidTransform X_WC(Eigen::Translation3d(0.3, -0.7, 1.1));
  return X_WC.rotate(rotation({0.4, -1.1, 2.3}));
}

// x = (u - cx) z / fx, y = (v - cy) z / fy, with z along the optical axis. The pose is the one that was
// given, not the one that the source knows.
TEST(SensorCloud, IsTheClosedFormOfItsPixels) {
  SensorFrame frame = frame_of(1000);
  SensorView view = kView;
  view.X_WC = RigidTransform(Eigen::Translation3d(9, 9, 9));
  for (const RigidTransform& X_WC : {RigidTransform::Identity(), somewhere()}) {
    const PointCloud cloud = cloud_of(frame, view, X_WC);
    ASSERT_EQ(cloud.size(), 12u);
    for (int v = 0; v < 3; ++v)
      for (int u = 0; u < 4; ++u) {
        const double z = 0.5 + 0.05 * (4 * v + u);
        const Vec3 p_C((u - 1.25) / 200 * z, (v - 0.75) / 250 * z, z);
        const Vec3 expected_W = X_WC.linear() * p_C + X_WC.translation();
        EXPECT_LT((cloud.point(static_cast<std::size_t>(4 * v + u)) - expected_W).norm(), 1e-15)
            << u << " " << v;
      }
    ASSERT_TRUE(cloud.image);
    EXPECT_EQ(cloud.image->camera.fy, 250);
    EXPECT_EQ(cloud.image->X_WC.matrix(), X_WC.matrix());
    EXPECT_EQ(cloud.columns(), 4);
    EXPECT_TRUE(cloud.colour.empty());
  }
  for (std::uint32_t i = 0; i < 12; ++i) frame.colour.push_back(0xff8000u + i);
  EXPECT_EQ(cloud_of(frame, kView, somewhere()).colour, frame.colour);
}

TEST(SensorCloud, ZeroIsAHoleAndOneIsTheNearestThereIs) {
  SensorFrame frame = frame_of(1000);
  frame.depth[0] = frame.depth[7] = 0;
  frame.depth[5] = 1, frame.depth[6] = 65535;
  const PointCloud cloud = cloud_of(frame, kView, RigidTransform::Identity());
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(cloud.is_measured(i), i != 0 && i != 7) << i;
  for (const std::size_t hole : {0u, 7u})
    EXPECT_TRUE(std::isnan(cloud.x[hole]) && std::isnan(cloud.y[hole]) && std::isnan(cloud.z[hole]));
  EXPECT_EQ(cloud.z[5], 0.0005);
  EXPECT_EQ(cloud.z[6], 65535 * 0.0005);
}

// --- the statistics of a sensor's frames ---

TEST(SensedPoints, CountTheMeasuredPixelsOfImages) {
  SensorView view{{4, 1, 100, 100, 2, 0.5}, 0.0005, 30, true, RigidTransform::Identity()};
  SensedPoints points;
  EXPECT_EQ(points.text(), "0 % of 0 points measured, without colours");
  points.add({0, 0, {0, 0, 0, 0}, {}}, view);
  EXPECT_EQ(points.text(), "0 % of 4 points measured, with colours");
  points.add({1, 0.1, {1000, 0, 2400, 65535}, {}}, view);
  EXPECT_EQ(points.frames(), 2);
  EXPECT_EQ(points.text(), "37.5 % of 8 points measured, depth 0.5 to 32.8 m, with colours");
  EXPECT_EQ(layout_text(view), "4 x 1 pixels");
}

TEST(SensedPoints, CountTheFinitePointsOfClouds) {
  SensorView view;
  view.cloud = CloudLayout{true, 0, 3};
  SensorFrame frame;
  frame.points = {0, 0, -0.25f, 0, 0, 1, NAN, NAN,      NAN, 0, 0, 1,
                  1, 1, 0.75f,  0, 0, 1, 1,   INFINITY, 9,   0, 0, 1};
  SensedPoints points;
  points.add(frame, view);
  EXPECT_EQ(points.text(), "50 % of 4 points measured, z -0.25 to 0.75 m, without colours");
  EXPECT_EQ(layout_text(view), "clouds of points");
}

}  // namespace
}  // namespace remote_touch::session_scene_test
