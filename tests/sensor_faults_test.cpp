// Each fault of a sensor against its definition, on the bare scenario's own points.
#include "scenarios/sensor_faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/camera.h"
#include "runners/experiment.h"
#include "runners/frame_stream.h"
#include "runners/json_parameters.h"
#include "runners/live/session_file.h"
#include "runners/simulation.h"
#include "scenarios/camera_scene.h"
#include "scenarios/moving_shape.h"
#include "tests/scenes.h"
#include "tests/test_files.h"

namespace remote_touch {
namespace {

const NoiseKey kKey{5, 2, 3};

// 60 x 50 points that rise by 0.3 m/s for 40 frames.
MovingShape::Settings rising_plane() {
  MovingShape::Settings s;
  s.grid = {60, 50, 0.002, 0, 0};
  s.motion.start_velocity_m_per_s = 0.3, s.motion.rise_frames = 40;
  s.truth = MovingShape::Truth::moving;
  return s;
}

std::unique_ptr<Scenario> bare(const MovingShape::Settings& settings = rising_plane()) {
  return std::make_unique<MovingShape>(settings, kKey, scenes::kernels());
}
std::unique_ptr<Scenario> camera() {
  return std::make_unique<CameraScene>(CameraScene::Settings{}, kKey, scenes::kernels());
}
FaultySensor faulty(const SensorFaults& faults, std::unique_ptr<Scenario> scenario = bare(),
                    const NoiseKey& key = kKey) {
  return FaultySensor(std::move(scenario), faults, key, scenes::kernels());
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
bool same_bits(const PointCloud& a, const PointCloud& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

std::size_t measured(const PointCloud& cloud) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) count += cloud.is_measured(i) ? 1 : 0;
  return count;
}

// A share of so many draws, within five standard deviations.
void expect_share(double count, double of, double share) {
  EXPECT_NEAR(count / of, share, 5 * std::sqrt(share * (1 - share) / of));
}

// --- none ---

TEST(SensorFaults, NoneAreTheBareScenarioBitForBit) {
  MovingShape::Settings noisy = rising_plane();
  noisy.noise_sigma_m = 0.001;
  SensorFaults off;
  off.view = {0.3, -0.7, 0.1};
  const FaultySensor same = faulty(off, bare(noisy)), seen = faulty(off, camera());
  const auto plane = bare(noisy), scene = camera();
  EXPECT_EQ(same.frame_count(), plane->frame_count());
  EXPECT_EQ(seen.frame_count(), scene->frame_count());
  for (const int frame : {0, 1, 17, 40}) {
    EXPECT_TRUE(same_bits(same.cloud(frame), plane->cloud(frame)));
    EXPECT_TRUE(same_bits(seen.cloud(frame), scene->cloud(frame)));
    EXPECT_EQ(same.captured_s(frame), plane->captured_s(frame));
    EXPECT_FALSE(same.arrives_s(frame));
    EXPECT_EQ(typeid(*same.points(frame)), typeid(*plane->points(frame)));
  }
}

TEST(SensorFaults, ASectionOfNothingChangesNoRun) {
  const Experiment plain = Experiment::load("fig4.12", {"duration_s=0.6"});
  const Experiment with = Experiment::load("fig4.12", {"duration_s=0.6", "faults={}"});
  SimulationOptions options;
  options.hash_frames = true;
  const Trace a = simulate(plain, options), b = simulate(with, options);
  EXPECT_EQ(a.frame_hash, b.frame_hash);
  EXPECT_EQ(a.proxy_m, b.proxy_m);
  EXPECT_EQ(a.force_N, b.force_N);
}

// --- places ---

TEST(SensorFaults, QuantisedPlacesAreTheNearestMultiplesAlongTheView) {
  SensorFaults s;
  s.quantisation_m = 0.003, s.view = {1, -2, 2};
  const Vec3 view = s.view / 3;
  MovingShape::Settings rough = rising_plane();
  rough.noise_sigma_m = 0.004;
  const auto clean = bare(rough);
  const FaultySensor sensor = faulty(s, bare(rough));
  for (const int frame : {0, 9}) {
    const PointCloud before = clean->cloud(frame), after = sensor.cloud(frame);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const double steps = after.point(i).dot(view) / 0.003;
      ASSERT_NEAR(steps, std::round(steps), 1e-10);
      const Vec3 way = after.point(i) - before.point(i);
      ASSERT_LE(way.norm(), 0.0015 + 1e-15);
      ASSERT_LT((way - way.dot(view) * view).norm(), 1e-15);
    }
  }
}

TEST(SensorFaults, FlyingPointsAreAShareThatLeavesAlongTheView) {
  SensorFaults s;
  s.flying_share = 0.2, s.flying_m = 0.03, s.view = {0, 0, 5};
  const auto clean = bare();
  const FaultySensor sensor = faulty(s);
  double flown = 0, all = 0, sum = 0, squares = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const PointCloud before = clean->cloud(frame), after = sensor.cloud(frame);
    for (std::size_t i = 0; i < after.size(); ++i) {
      ++all;
      const double way = after.z[i] - before.z[i];
      ASSERT_TRUE(after.x[i] == before.x[i] && after.y[i] == before.y[i]);
      ASSERT_LE(std::abs(way), 0.03 + 1e-15);
      if (way != 0) ++flown, sum += way, squares += way * way;
    }
  }
  expect_share(flown, all, 0.2);
  // Evenly spread: no mean, and a standard deviation of the half width by sqrt(3).
  const double sd = 0.03 / std::sqrt(3.0);
  EXPECT_NEAR(sum / flown, 0, 5 * sd / std::sqrt(flown));
  EXPECT_NEAR(std::sqrt(squares / flown), sd, 5 * sd / std::sqrt(flown));
}

TEST(SensorFaults, OutliersLieWithinTheirReach) {
  SensorFaults s;
  s.outlier_share = 0.1, s.outlier_reach_m = 0.2, s.flying_share = 1, s.flying_m = 0.001;
  const auto clean = bare();
  const FaultySensor sensor = faulty(s);
  double far = 0, all = 0, furthest = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const PointCloud before = clean->cloud(frame), after = sensor.cloud(frame);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const double way = std::abs(after.y[i] - before.y[i]);
      ASSERT_LE(way, 0.2 + 1e-15);
      ++all, far += way > 0.001 + 1e-15 ? 1 : 0, furthest = std::max(furthest, way);
    }
  }
  expect_share(far / (1 - 0.001 / 0.2), all, 0.1);
  EXPECT_GT(furthest, 0.199);
}

// In an image points stay on their rays, so that the search by pixels finds them.
TEST(SensorFaults, InAnImagePointsMoveAlongTheirRays) {
  SensorFaults s;
  s.flying_share = 0.3, s.flying_m = 0.05, s.quantisation_m = 0.01;
  const FaultySensor sensor = faulty(s, camera());
  const PointCloud before = camera()->cloud(0), after = sensor.cloud(0);
  ASSERT_TRUE(after.image);
  const Vec3 eye = after.image->X_WC.translation();
  const RigidTransform X_CW = after.image->X_WC.inverse();
  double moved = 0, all = 0;
  for (std::size_t i = 0; i < after.size(); i += 7) {
    ASSERT_EQ(before.is_measured(i), after.is_measured(i));
    if (!after.is_measured(i)) continue;
    const double steps = (after.point(i) - eye).norm() / 0.01;
    ASSERT_NEAR(steps, std::round(steps), 1e-10);
    const Vec3 p_C = X_CW * after.point(i), q_C = X_CW * before.point(i);
    ASSERT_LT((p_C / p_C.z() - q_C / q_C.z()).norm(), 1e-14);
    ++all, moved += (after.point(i) - before.point(i)).norm() > 0.005 + 1e-12 ? 1 : 0;
  }
  EXPECT_GT(moved / all, 0.25);
  const auto points = sensor.points(0);
  GatheredPoints found, expected;
  for (GatheredPoints* out : {&found, &expected}) out->reserve(after.size(), false, false);
  for (std::size_t i = 100000; i < after.size(); i += 9973) {
    if (!after.is_measured(i)) continue;
    found.clear(), expected.clear();
    points->gather({after.point(i), 0.02}, scenes::kernels(), found);
    BruteForceSearch(after).gather({after.point(i), 0.02}, scenes::kernels(), expected);
    EXPECT_EQ(found.size(), expected.size());
  }
}

TEST(SensorFaults, WhatWouldLieBehindTheCameraIsLost) {
  SensorFaults s;
  s.outlier_share = 1, s.outlier_reach_m = 5;
  const PointCloud before = camera()->cloud(0), after = faulty(s, camera()).cloud(0);
  const RigidTransform X_CW = after.image->X_WC.inverse();
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after.is_measured(i)) {
      ASSERT_GT((X_CW * after.point(i)).z(), 0);
    }
  // About half: 5 m either way, of something 0.6 m away.
  EXPECT_NEAR(static_cast<double>(measured(after)) / static_cast<double>(measured(before)), 0.56, 0.05);
}

// --- lost points ---

TEST(SensorFaults, DropoutLosesItsShareOneByOne) {
  SensorFaults s;
  s.dropout_share = 0.3;
  const FaultySensor sensor = faulty(s);
  double lost = 0, all = 0, twice = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const PointCloud before = bare()->cloud(frame), after = sensor.cloud(frame);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      ++all;
      if (after.is_measured(i)) {
        ASSERT_EQ(after.point(i), before.point(i));
        continue;
      }
      ASSERT_TRUE(std::isnan(after.x[i]) && std::isnan(after.y[i]) && std::isnan(after.z[i]));
      ++lost, twice += i > 0 && !after.is_measured(i - 1) ? 1 : 0;
    }
  }
  expect_share(lost, all, 0.3);
  expect_share(twice, lost, 0.3);  // one tells nothing about the next
}

// What is gone is what lies within the radius of some middle that is gone, and nothing else.
void expect_round_holes(const PointCloud& before, const PointCloud& after, const Vec3& view,
                        double radius_m) {
  const auto apart = [&](std::size_t i, std::size_t j) {
    const Vec3 way = before.point(i) - before.point(j);
    return (way - way.dot(view) * view).norm();
  };
  std::vector<bool> explained(before.size());
  for (std::size_t middle = 0; middle < before.size(); ++middle) {
    std::vector<std::size_t> inside;
    bool whole = true;
    for (std::size_t i = 0; whole && i < before.size(); ++i) {
      if (apart(i, middle) > radius_m) continue;
      whole = !after.is_measured(i);
      inside.push_back(i);
    }
    for (const std::size_t i : inside) explained[i] = explained[i] || whole;
  }
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_EQ(explained[i], !after.is_measured(i)) << i;
}

TEST(SensorFaults, HolesAreRoundAndTakeAboutTheirShare) {
  for (const Vec3& view : {Vec3(0, -1, 0), Vec3(0.6, -0.8, 0)}) {
    SensorFaults s;
    s.hole_share = 0.25, s.hole_radius_m = 0.007, s.view = view;
    const FaultySensor sensor = faulty(s);
    std::vector<PointCloud> frames;
    for (const int frame : {0, 1, 2}) {
      const PointCloud before = bare()->cloud(frame);
      frames.push_back(sensor.cloud(frame));
      const double lost = 3000 - static_cast<double>(measured(frames.back()));
      EXPECT_GE(lost, 750);
      EXPECT_LE(lost, 750 + 3.2 * 0.007 * 0.007 / (0.002 * 0.002) * 1.7);  // the last hole, seen aslant
      expect_round_holes(before, frames.back(), view, 0.007);
    }
    EXPECT_FALSE(same_bits(frames[0].x, frames[1].x)) << "elsewhere in each frame";
  }
}

TEST(SensorFaults, HolesInAnImageAreRoundInTheImage) {
  SensorFaults s;
  s.hole_share = 0.05, s.hole_radius_m = 0.02;
  const PointCloud before = camera()->cloud(0), after = faulty(s, camera()).cloud(0);
  const CameraIntrinsics& eye = after.image->camera;
  const double all = static_cast<double>(measured(before));
  const double lost = all - static_cast<double>(measured(after));
  EXPECT_GE(lost, 0.05 * all);
  // The largest hole is that of the nearest point, about 0.45 m away.
  EXPECT_LE(lost, 0.05 * all + 3.2 * std::pow(0.02 / 0.45 * eye.fx, 2));
  // Row by row what is lost has both kinds of neighbours: few borders for so many points.
  double borders = 0;
  for (std::size_t i = 1; i < after.size(); ++i)
    borders +=
        before.is_measured(i) && before.is_measured(i - 1) && after.is_measured(i) != after.is_measured(i - 1)
            ? 1
            : 0;
  EXPECT_LT(borders, 0.15 * lost);
}

TEST(SensorFaults, AllPointsCanBeLost) {
  SensorFaults holes, drops;
  holes.hole_share = 1, drops.dropout_share = 1;
  EXPECT_EQ(measured(faulty(holes).cloud(3)), 0u);
  EXPECT_EQ(measured(faulty(drops).cloud(3)), 0u);
  EXPECT_EQ(faulty(drops).points(3)->size(), 3000u);
}

TEST(SensorFaults, LostPointsLoseTheirNormals) {
  const Experiment experiment = Experiment::from_json(
      R"({"scenario": {"name": "moving-plane"}, "faults": {"dropout_share": 0.5},
          "renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"}})",
      "plane");
  const PointCloud cloud = experiment.build_scenario(scenes::kernels())->cloud(0);
  ASSERT_TRUE(cloud.has_normals());
  for (std::size_t i = 0; i < cloud.size(); ++i) ASSERT_EQ(cloud.normal(i).allFinite(), cloud.is_measured(i));
}

// --- frames ---

TEST(SensorFaults, RepeatedFramesShowTheOneBeforeThem) {
  SensorFaults s;
  s.repeat_share = 0.4, s.dropout_share = 0.1, s.flying_share = 0.1;
  MovingShape::Settings noisy = rising_plane();
  noisy.motion.rise_frames = 400, noisy.noise_sigma_m = 0.001, noisy.grid = {8, 8, 0.002, 0, 0};
  const FaultySensor sensor = faulty(s, bare(noisy));
  double repeated = 0, chained = 0;
  bool before = false;
  for (int frame = 1; frame < 400; ++frame) {
    const bool again = same_bits(sensor.cloud(frame), sensor.cloud(frame - 1));
    repeated += again, chained += again && before;
    before = again;
    EXPECT_EQ(sensor.captured_s(frame), frame / 30.0) << "its own time stamp";
  }
  expect_share(repeated, 399, 0.4);
  expect_share(chained, repeated, 0.4);
  s.dropout_share = s.flying_share = 0, s.repeat_share = 1;
  EXPECT_TRUE(same_bits(faulty(s, bare(noisy)).cloud(300), bare(noisy)->cloud(0)));
}

class Recorder final : public Renderer {
 public:
  void on_frame(const Frame& frame) override { frames.push_back(frame); }
  RenderOutput step(const DeviceState&, double) override { return {}; }
  std::vector<Frame> frames;
};

std::vector<Frame> received(const Scenario& scenario, double until_s, const Delivery& delivery = {}) {
  FrameStream stream(scenario, {}, delivery, kKey, false);
  Recorder recorder;
  for (int tick = 0; 0.001 * tick <= until_s; ++tick) stream.deliver_until(0.001 * tick, recorder);
  return recorder.frames;
}

TEST(SensorFaults, LateFramesComeLaterAndAreOvertaken) {
  SensorFaults s;
  s.late_share = 0.3, s.late_s = 0.05;
  MovingShape::Settings plane = rising_plane();
  plane.motion.rise_frames = 299, plane.grid = {4, 4, 0.002, 0, 0};
  const FaultySensor sensor = faulty(s, bare(plane));
  const auto frames = received(sensor, 11);
  ASSERT_EQ(frames.size(), 300u);
  double late = 0;
  int overtaken = 0;
  std::set<int> came;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double delay = frames[i].arrives_s - frames[i].captured_s;
    ASSERT_TRUE(std::abs(delay) < 1e-12 || std::abs(delay - 0.05) < 1e-12) << delay;
    EXPECT_EQ(delay > 0.01, sensor.arrives_s(frames[i].index).has_value());
    late += delay > 0.01 ? 1 : 0;
    came.insert(frames[i].index);
    if (i == 0) continue;
    EXPECT_GE(frames[i].arrives_s, frames[i - 1].arrives_s);
    overtaken += frames[i].index < frames[i - 1].index ? 1 : 0;
  }
  expect_share(late, 300, 0.3);
  EXPECT_GT(overtaken, 20);
  EXPECT_EQ(came.size(), 300u);
  // Beyond the last frame of the scenario, where others could be lost, none is taken for the last.
  const auto goes_on = received(sensor, 11, {0, 0, 1e-300});
  EXPECT_GT(goes_on.back().index, 320);
  for (const Frame& frame : goes_on)
    if (frame.index >= 300) {
      EXPECT_NEAR(frame.arrives_s, frame.captured_s, 1e-12);
    }
}

TEST(SensorFaults, ASensorGoesOnWhereItsFramesDiffer) {
  SensorFaults s;
  s.late_share = 1, s.quantisation_m = 0.001;
  EXPECT_EQ(faulty(s).frame_count(), 41);
  for (double SensorFaults::*share :
       {&SensorFaults::repeat_share, &SensorFaults::shear_s, &SensorFaults::flying_share,
        &SensorFaults::outlier_share, &SensorFaults::hole_share, &SensorFaults::dropout_share}) {
    SensorFaults one;
    one.*share = 0.1;
    const FaultySensor sensor = faulty(one);
    EXPECT_EQ(sensor.frame_count(), std::numeric_limits<int>::max());
    EXPECT_NEAR(sensor.captured_s(60), 2, 1e-12);
    EXPECT_EQ(sensor.newest_frame(2.001), 60);
    EXPECT_EQ(sensor.cloud(60).size(), 3000u);
    EXPECT_EQ(sensor.surface_height(0, 0, 2), bare()->surface_height(0, 0, 2));
  }
}

// --- rows that are read one after the other ---

TEST(SensorFaults, ShearShowsARisingPlaneAsItWas) {
  SensorFaults s;
  s.shear_s = 0.02;
  const FaultySensor sensor = faulty(s);
  const PointCloud before = bare()->cloud(20), after = sensor.cloud(20);
  const double low = rising_plane().grid.z(0), high = rising_plane().grid.z(49);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const double share = (before.z[i] - low) / (high - low);
    ASSERT_NEAR(after.y[i], before.y[i] - 0.3 * (1 - share) * 0.02, 1e-12);
    ASSERT_NEAR(after.x[i], before.x[i], 1e-12);
    ASSERT_NEAR(after.z[i], before.z[i], 1e-12);
  }
}

TEST(SensorFaults, ShearMovesAlongTheNormalOfATiltedPlane) {
  MovingShape::Settings tilted = rising_plane();
  tilted.motion.tilt_deg = 30;
  SensorFaults s;
  s.shear_s = 0.02;
  const PointCloud before = bare(tilted)->cloud(20), after = faulty(s, bare(tilted)).cloud(20);
  const Vec3 normal(-0.5, std::sqrt(0.75), 0);
  // The first row was read 20 ms before; at its ends the plane of then reached elsewhere.
  for (std::size_t i = 2; i < 58; ++i) {
    const Vec3 way = after.point(i) - before.point(i);
    // The plane rises by 0.3 m/s, along its normal by the cosine of that.
    EXPECT_LT((way + 0.3 * 0.02 * std::sqrt(0.75) * normal).norm(), 1e-9);
  }
}

TEST(SensorFaults, WithoutAKnownOrMovingTruthThereIsNoShear) {
  SensorFaults s;
  s.shear_s = 0.02;
  MovingShape::Settings rests = rising_plane();
  rests.motion = {};
  EXPECT_TRUE(same_bits(faulty(s, bare(rests)).cloud(3), bare(rests)->cloud(0)));
  const TestFolder folder("sensor_faults_test");
  folder.write_depth("depth/0000.png", 500), folder.write_depth("depth/0001.png", 600);
  folder.write("camera.json", R"({"width": 3, "height": 2, "fx": 10, "fy": 10, "cx": 1, "cy": 0.5,
                                  "depth_scale_m": 0.001, "frame_rate_hz": 20})");
  const auto built = [&](const std::string& faults) {
    const std::string text = R"({"scenario": {"name": "recording", "path": ")" + folder.path().string() +
                             R"("}, "faults": )" + faults +
                             R"(, "renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"}})";
    return Experiment::from_json(text, "recorded").build_scenario(scenes::kernels());
  };
  const auto plain = built("{}"), sheared = built(R"({"shear_s": 0.02})");
  EXPECT_TRUE(same_bits(sheared->cloud(1), plain->cloud(1)));
  EXPECT_TRUE(std::isnan(plain->signed_distance(Vec3::Zero(), 0)));
  EXPECT_EQ(measured(built(R"({"dropout_share": 1})")->cloud(1)), 0u) << "recordings can wear faults";
}

// A plane that comes along the rays: what its pixels saw then lies on the same rays.
TEST(SensorFaults, ShearOfAnImageStaysOnTheRays) {
  class Wall final : public Scenario {
   public:
    double frame_rate_hz() const override { return 30; }
    int frame_count() const override { return 100; }
    std::shared_ptr<const NeighbourSearch> points(int frame) const override {
      return make_search(cloud(frame));
    }
    PointCloud cloud(int frame) const override {
      PointCloud cloud;
      cloud.image = ImageLayout{{9, 5, 10, 10, 4, 2}, RigidTransform::Identity(), 0};
      for (int i = 0; i < 45; ++i)
        cloud.append(unproject(cloud.image->camera, i % 9, i / 9, depth(captured_s(frame))));
      return cloud;
    }
    double signed_distance(const Vec3& p_W, double time_s) const override { return depth(time_s) - p_W.z(); }
    static double depth(double time_s) { return 2 - 0.4 * time_s; }
  };
  SensorFaults s;
  s.shear_s = 0.1;
  const PointCloud cloud = faulty(s, std::make_unique<Wall>()).cloud(30);
  for (int i = 0; i < 45; ++i) {
    const double then_s = 1 - (1 - (i / 9) / 4.0) * 0.1;
    const Vec3 expected = unproject(cloud.image->camera, i % 9, i / 9, Wall::depth(then_s));
    EXPECT_LT((cloud.point(static_cast<std::size_t>(i)) - expected).norm(), 1e-9);
  }
}

// --- together ---

SensorFaults everything() {
  SensorFaults s;
  s.repeat_share = 0.2, s.shear_s = 0.01, s.flying_share = 0.1, s.outlier_share = 0.05;
  s.quantisation_m = 0.002, s.hole_share = 0.2, s.dropout_share = 0.1, s.late_share = 0.2;
  return s;
}

TEST(SensorFaults, FramesArePure) {
  const FaultySensor one = faulty(everything()), other = faulty(everything());
  one.cloud(30);
  for (const int frame : {7, 0, 41, 100}) {
    EXPECT_TRUE(same_bits(one.cloud(frame), other.cloud(frame)));
    EXPECT_EQ(one.arrives_s(frame), other.arrives_s(frame));
  }
  EXPECT_FALSE(same_bits(one.cloud(7), faulty(everything(), bare(), {6, 2, 3}).cloud(7)));
}

TEST(SensorFaults, SeveralAtOnceKeepTheirDefinitions) {
  const FaultySensor sensor = faulty(everything());
  double left = 0, all = 0, far = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const PointCloud cloud = sensor.cloud(frame);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ++all;
      if (!cloud.is_measured(i)) continue;
      ++left;
      const double steps = cloud.y[i] / 0.002;
      ASSERT_NEAR(steps, std::round(steps), 1e-10);
      const int column = static_cast<int>(i) % 60, row = static_cast<int>(i) / 60;
      ASSERT_NEAR(cloud.x[i], rising_plane().grid.x(column), 1e-12);
      ASSERT_NEAR(cloud.z[i], rising_plane().grid.z(row), 1e-12);
      far += std::abs(cloud.y[i] - bare()->surface_height(0, 0, frame / 30.0)) > 0.022 ? 1 : 0;
    }
  }
  // Holes take their share and up to one more hole; dropouts theirs of what is left.
  EXPECT_LT(left / all, 0.8 * 0.9 + 0.01);
  EXPECT_GT(left / all, (0.8 - 0.011) * 0.9 - 0.01);
  EXPECT_GT(far / left, 0.015);
}

TEST(SensorFaults, ARunWithEverythingEnds) {
  const std::vector<std::string> set = {
      "faults.repeat_share=0.2",  "faults.shear_s=0.01",         "faults.flying_share=0.1",
      "faults.hole_share=0.2",    "faults.late_share=0.2",       "faults.outlier_share=0.05",
      "faults.dropout_share=0.3", "faults.quantisation_m=0.001", "scenario.truth=moving"};
  const Trace once = simulate(Experiment::load("fig4.12", set), {});
  const Trace again = simulate(Experiment::load("fig4.12", set), {});
  EXPECT_EQ(once.proxy_m, again.proxy_m);
  for (std::size_t i = 0; i < once.length(); ++i) ASSERT_TRUE(once.proxy(i).allFinite());
  EXPECT_NE(once.proxy_m, simulate(Experiment::load("fig4.12", {"scenario.truth=moving"}), {}).proxy_m);
}

// Its path is planned in what the camera would have seen.
TEST(SensorFaults, TheHandIsThatOfTheBareScenario) {
  for (const char* name : {"fig4.12", "fig4.16"}) {
    const Experiment plain = Experiment::load(name),
                     blind = Experiment::load(name, {"faults.dropout_share=1", "faults.repeat_share=1"});
    const auto scene = plain.build_scenario(scenes::kernels());
    const auto dark = blind.build_scenario(scenes::kernels());
    const auto hand = plain.build_trajectory(*scene), same = blind.build_trajectory(*dark);
    EXPECT_EQ(hand->duration_s(), same->duration_s());
    for (int tick = 0; tick < 900; tick += 50)
      EXPECT_EQ(hand->at(0.001 * tick).position_W, same->at(0.001 * tick).position_W) << name;
  }
}

// --- the section of an experiment ---

TEST(SensorFaults, TheSectionSurvivesARoundTripCompletely) {
  const Experiment experiment =
      Experiment::load("fig4.12", {"faults.dropout_share=0.5", "faults.view=[0,-1,1]"});
  const std::string text = experiment.to_json();
  EXPECT_EQ(Experiment::from_json(text, "again").to_json(), text);
  const Json json = Json::parse(text)["faults"];
  SensorFaults defaults;
  const Parameters list = parameters(defaults);
  EXPECT_EQ(json.size(), list.size());
  for (const Parameter& p : list) EXPECT_TRUE(json.contains(p.name)) << p.name;
  EXPECT_EQ(json["dropout_share"], 0.5);
  EXPECT_FALSE(Json::parse(Experiment::load("fig4.12").to_json()).contains("faults"));
}

// The recorded frames have them already. What is asked for then comes on top, and the session still ends.
TEST(SensorFaults, ALiveSessionRunsAgainWithoutThem) {
  const TestFolder folder("sensor_faults_test");
  const std::string file = (folder / "session.h5").string();
  const SensorView view{{64, 2, 60, 60, 31.5, 0.5}, 0.001, 30, false, RigidTransform::Identity()};
  SessionWriter session(file, view, RigidTransform::Identity(),
                        {{"config", Experiment::load("fig4.16", {"faults.dropout_share=0.5"}).to_json()}});
  SensorFrame frame;
  frame.depth.assign(128, 500);
  session.append(frame, 0, 0);
  LiveTick tick;
  tick.taken = 0;
  session.append(tick);
  session.finish();

  const Experiment again = Experiment::load(file);
  EXPECT_FALSE(Json::parse(again.to_json()).contains("faults"));
  EXPECT_EQ(measured(again.build_scenario(scenes::kernels())->cloud(0)), 128u);
  const auto worse = Experiment::load(file, {"faults.dropout_share=1"}).build_scenario(scenes::kernels());
  EXPECT_EQ(measured(worse->cloud(0)), 0u);
  EXPECT_EQ(worse->frame_count(), 1);
  EXPECT_TRUE(worse->ends());
  EXPECT_EQ(worse->arrives_s(0), 0);
}

TEST(SensorFaults, RefusesWhatIsNone) {
  const auto why = [](const std::string& assignment) {
    return refusal([&] { Experiment::load("fig4.12", {assignment}); });
  };
  EXPECT_EQ(why("faults.dropout_share=1.5"), "faults.dropout_share = 1.5: allowed 0 to 1");
  EXPECT_EQ(why("faults.quantisation_m=-0.001"), "faults.quantisation_m = -0.001: allowed 0 to 1");
  EXPECT_EQ(why("faults.hole_radius_m=0"), "faults.hole_radius_m = 0: allowed 0.0001 to 10");
  EXPECT_HAS(why("faults.view=[0,0,0]"), "faults.view: allowed 0.001 or longer");
  EXPECT_HAS(why("faults.dropout=0.5"),
             "faults.dropout: unknown; the nearest allowed is faults.dropout_share");
  EXPECT_HAS(why("faults=3"), "faults: allowed {parameters}");
  SensorFaults blind;
  blind.view.setZero();
  EXPECT_THROW(faulty(blind), std::invalid_argument);
}

}  // namespace
}  // namespace remote_touch
