// The notes of a run: their kinds, and those on a hand that leaves its surface, on fixture rules that select
// nothing and on a slave.
#include "runners/experiment/simulation/run_notes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/neighbour_search.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/runners/experiment/simulation/reported_run.h"
#include "tests/support/test_files.h"

namespace remote_touch::run_notes_test {
namespace {

// --- kinds ---

// Their order is part of the format of sweeps. New kinds are appended; a stored bit keeps its name.
TEST(NoteKinds, KeepTheirBits) {
  const std::string stored =
      "other,phase not reached,after the motion,no contact,no frame,wide spacing,"
      "points dropped,frames unused,frames apart,unusual rate,recording incomplete,"
      "colours missing,viewpoint unused,behind the surface,off the surface,holes bridged,"
      "edges bridged,object not scanned,camera changes,starts in contact,"
      "lost at the first touch,object not pressed,hand jumped,nothing selected,outcome unknown,"
      "few frames";
  const std::vector<std::string> names = note_kind_names();
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : ",") + name;
  EXPECT_EQ((joined + ",").substr(0, stored.size() + 1), stored + ",");
  EXPECT_LE(names.size(), 64u) << "bits of a number";
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) EXPECT_EQ(name.find(','), std::string::npos) << "it separates names";
}

TEST(NoteKinds, HaveABitAndATextForCounts) {
  EXPECT_EQ(note_bits({}), 0u);
  EXPECT_EQ(note_bits({{"no contact", "a"}, {"wide spacing", "b"}, {"no contact", "c"}}), 1u << 3 | 1u << 5);
  EXPECT_EQ(note_bits({{"of another program", "a"}}), 1u);
  EXPECT_EQ(text_of_kind("no contact"), "no contact: no point was touched and no force was felt");
  EXPECT_EQ(text_of_kind("of another program"), "of another program");
}

using Texts = std::vector<std::string>;

Texts texts_of(const std::vector<Note>& notes) {
  Texts texts;
  for (const Note& note : notes) texts.push_back(note.kind + ": " + note.text);
  return texts;
}

// --- a hand that leaves what the camera sees, or flies behind it ---

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr CameraIntrinsics kCamera{100, 80, 100, 100, 49.5, 39.5};

// A plane in front of the camera, with a depth for each frame. The left half of the image has no measurement.
class MovingPlane final : public Scenario {
 public:
  explicit MovingPlane(std::vector<double> depths_m) : depths_m_(std::move(depths_m)) {}
  double frame_rate_hz() const override { return 10; }
  int frame_count() const override { return static_cast<int>(depths_m_.size()); }
  PointCloud cloud(int frame) const override {
    DepthImage image{kCamera.width, kCamera.height, {}};
    for (int i = 0; i < kCamera.width * kCamera.height; ++i)
      image.z_m.push_back(i % kCamera.width < 50 ? kNaN : depths_m_[static_cast<std::size_t>(frame)]);
    // The camera is at (1, 2, 3) and faces along x.
    RigidTransform X_WC = RigidTransform::Identity();
    X_WC.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    X_WC.translation() = Vec3(1, 2, 3);
    return cloud_from_depth(image, kCamera, X_WC);
  }
  double signed_distance(const Vec3&, double) const override { return kNaN; }

 private:
  const std::vector<double> depths_m_;
};

class Hand final : public Trajectory {
 public:
  explicit Hand(std::optional<SurfacePlan> plan) : plan_(plan) {}
  DeviceState at(double) const override { return {}; }
  double duration_s() const override { return 0; }
  std::optional<SurfacePlan> surface_plan(double) const override { return plan_; }

 private:
  const std::optional<SurfacePlan> plan_;
};

// A point of the camera's frame (x right, y down, z forward), see MovingPlane::cloud().
Vec3 in_world(double x, double y, double z) {
  return {1 + z, 2 + x, 3 + y};
}

constexpr SurfacePlan kTouches{true, -0.006, 0.016, 0.004}, kLifted{false, -0.006, 0.016, 0.004};

// Frames at 0, 0.1, ..., 0.5 s; a tick in the middle of each.
std::vector<Note> watched(const std::vector<double>& depths_m, const std::optional<SurfacePlan>& plan,
                          const Vec3& hand_C) {
  const MovingPlane scene(depths_m);
  const Hand hand(plan);
  SurfaceWatch watch(scene, hand);
  for (std::size_t i = 0; i < depths_m.size(); ++i)
    watch.add(in_world(hand_C.x(), hand_C.y(), hand_C.z()), 0.1 * static_cast<double>(i) + 0.05);
  return watch.notes();
}

TEST(SurfaceWatch, ReportsAHandThatFliesBehind) {
  const std::vector<double> depths{0.5, 0.49, 0.45, 0.428, 0.5};
  for (const auto& plan : {kTouches, kLifted}) {
    const std::vector<Note> notes = watched(depths, plan, {0.1, 0, 0.51});
    EXPECT_EQ(kinds_of(notes), Kinds{"behind the surface"});
    // The hand is 20, 60 and 82 mm behind in 3 of 5 ticks; up to 16 mm are planned.
    EXPECT_HAS(notes[0].text, "in 60 % of the ticks, first at 0.15 s, by up to 82 mm; at most 16 mm");
  }
}

// Points of the camera's frame. The ray of the hand passes the last measured column at up to 4 mm, which is
// 0.8 of a pixel: one pixel counts.
TEST(SurfaceWatch, ReportsAHandThatLeavesTheSurface) {
  const Vec3 on_plane(0.1, 0, 0.51), over_hole(-0.1, 0, 0.51), outside(0.4, 0, 0.51),
      behind_camera(0, 0, -0.2);
  const auto column = [](double u) { return Vec3((u - kCamera.cx) * 0.51 / kCamera.fx, 0, 0.51); };
  const Kinds off{"off the surface"};
  const struct {
    const char* what;
    std::vector<double> depths_m;
    std::optional<SurfacePlan> plan;
    Vec3 hand_C;
    Kinds kinds;
  } rows[] = {{"at the surface", {0.5, 0.496, 0.512}, kTouches, on_plane, {}},
              {"without a plan", {0.5, 0.2}, std::nullopt, on_plane, {}},
              {"the surface recedes", {0.5, 0.52}, kTouches, on_plane, off},
              {"the surface recedes from a lifted hand", {0.5, 0.52}, kLifted, on_plane, {}},
              {"over a hole", {0.5, 0.5}, kTouches, over_hole, off},
              {"lifted over a hole", {0.5, 0.5}, kLifted, over_hole, {}},
              {"outside the image", {0.5, 0.5}, kTouches, outside, off},
              {"lifted outside the image", {0.5, 0.5}, kLifted, outside, {}},
              {"behind the camera", {0.5, 0.5}, kTouches, behind_camera, off},
              {"lifted behind the camera", {0.5, 0.5}, kLifted, behind_camera, {}},
              {"a pixel beside the last column", {0.5}, kTouches, column(49), {}},
              {"two pixels beside it", {0.5}, kTouches, column(48), off}};
  for (const auto& row : rows)
    EXPECT_EQ(kinds_of(watched(row.depths_m, row.plan, row.hand_C)), row.kinds) << row.what;
  EXPECT_HAS(watched({0.5, 0.52}, kTouches, on_plane).at(0).text, "in 50 % of the ticks, first at 0.15 s");
}

// Steps of 30, 60 and 90 mm; 50 mm are planned. 0: no limit is stated.
TEST(SurfaceWatch, ReportsAHandThatJumps) {
  const MovingPlane scene({0.5});
  const auto notes_with = [&](double max_step_m) {
    const Hand hand(SurfacePlan{false, -1, 1, 0.004, max_step_m});
    SurfaceWatch watch(scene, hand);
    for (const double z : {0.3, 0.33, 0.39, 0.3}) watch.add(in_world(0.1, 0, z), z);
    return texts_of(watch.notes());
  };
  EXPECT_EQ(notes_with(0), Texts{});
  EXPECT_EQ(notes_with(0.05),
            Texts{"hand jumped: the hand jumped by 60 mm at 0.39 s, because its pixel then showed another "
                  "surface; it jumped 2 times, by up to 90 mm"});
}

// Frames that a camera recorded: depth in units of 0.1 mm, 320 x 240 pixels, at 30 Hz. depth_m: at the ray
// (x, y, 1) of a frame.
void record(const TestFolder& folder, int frames, const std::function<double(int, double, double)>& depth_m) {
  folder.write("camera.json", R"({"width": 320, "height": 240, "fx": 300, "fy": 300, "cx": 159.5, "cy": 119.5,
    "depth_scale_m": 0.0001, "frame_rate_hz": 30})");
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<std::uint16_t> samples;
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u)
        samples.push_back(
            static_cast<std::uint16_t>(0.5 + 1e4 * depth_m(frame, (u - 159.5) / 300, (v - 119.5) / 300)));
    folder.write_png("depth/" + std::to_string(frame) + ".png", 320, 240, PNG_FORMAT_LINEAR_Y,
                     samples.data());
  }
}

// A box before a wall is removed in frame 5. The pixel then sees the wall, which is 0.4 m farther away. The
// hand has nothing to lift off from, and jumps.
TEST(SurfaceWatch, ReportsAPressWhosePixelSeesAnotherPosition) {
  const TestFolder folder("box_taken_away");
  record(folder, 10, [](int frame, double x, double y) {
    return frame < 5 && std::max(std::abs(x), std::abs(y)) * 0.5 < 0.08 ? 0.5 : 0.9;
  });
  const RunReport report = run_of(R"({"name": "recording", "path": ")" + folder.path().string() + R"("})",
                                  R"({"name": "image-press"})", R"("duration_s": 0.31)")
                               .report;
  ASSERT_EQ(kinds_of(report.notes), Kinds{"hand jumped"});
  EXPECT_HAS(report.notes[0].text, "jumped by 400 mm at 0.167 s");
  EXPECT_HAS(report.hand, "image-press, row ");
  EXPECT_HAS(report.hand, " at depth 0.500 m");
  EXPECT_HAS(text_of(report), "\n  hand: image-press, row ");
  TextAttributes attributes;
  add_report(attributes, report);
  EXPECT_EQ(attribute(attributes, "hand"), report.hand);
}

// --- fixture rules that select nothing ---

std::shared_ptr<const NeighbourSearch> points_at(double x_m) {
  PointCloud cloud;
  cloud.append(Vec3(x_m, 0, 0));
  cloud.append(Vec3(x_m, 0.01, 0));
  return make_search(std::move(cloud));
}

// The rules select what is beyond x = 1 m, and what is beyond x = 3 m.
FixtureAssignment beyond_1_and_3() {
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  for (const double x_m : {1.0, 3.0}) {
    HalfSpace::Settings settings;
    settings.point_m = {x_m, 0, 0}, settings.normal = {1, 0, 0};
    rules.push_back(std::make_unique<HalfSpace>(settings));
  }
  return FixtureAssignment(std::move(rules));
}

TEST(FixtureNotes, ARuleThatSelectsNothingInFirstAndLastFrameIsNamed) {
  const auto all = [](double first_m, double last_m) {
    return texts_of(fixture_notes(beyond_1_and_3(), points_at(first_m), points_at(last_m)));
  };
  const std::string end = " selects no point of the first frame and none of the last";
  EXPECT_EQ(all(0, 0), (Texts{"nothing selected: fixtures.0" + end, "nothing selected: fixtures.1" + end}));
  EXPECT_EQ(all(2, 0), Texts{"nothing selected: fixtures.1" + end});
  EXPECT_EQ(all(0, 2), Texts{"nothing selected: fixtures.1" + end});
  EXPECT_EQ(all(0, 4), Texts{});
  const auto same = points_at(0);
  EXPECT_EQ(fixture_notes(beyond_1_and_3(), same, same).size(), 2u);
  EXPECT_TRUE(fixture_notes({}, points_at(0), points_at(0)).empty());
  EXPECT_TRUE(fixture_notes(beyond_1_and_3(), nullptr, nullptr).empty());
}

TEST(FixtureNotes, ARunHasThem) {
  const auto notes_of = [](const std::string& height_m) {
    const std::string press =
        R"({"name": "press", "press_at_s": 0.1, "depth_m": 0.01, "start_m": [0.0003, 0.03, 0.0001]})";
    const std::string rule =
        R"({"name": "half-space", "point_m": [0, )" + height_m + R"(, 0], "normal": [0, 1, 0]})";
    return texts_of(run_of(R"({"name": "flat-grid", "rows": 11, "columns": 11})", press,
                           R"("duration_s": 0.3, "fixtures": [)" + rule + "]")
                        .report.notes);
  };
  EXPECT_EQ(notes_of("0.01"),
            Texts{"nothing selected: fixtures.0 selects no point of the first frame and none of the last"});
  EXPECT_EQ(notes_of("-0.01"), Texts{});
}

// --- a slave that does not act as its settings say ---

std::vector<Note> notes_of(const std::string& experiment, const std::vector<std::string>& overrides) {
  RunReport report;
  SimulationOptions options;
  options.report = &report;
  simulate(Experiment::load(experiment, overrides), options);
  return report.notes;
}

Kinds slave_kinds(const std::string& experiment, const std::vector<std::string>& overrides) {
  Kinds kinds = kinds_of(notes_of(experiment, overrides));
  std::erase_if(kinds, [](const std::string& kind) { return !kind.starts_with("slave"); });
  return kinds;
}

// Returns the notes "setting without effect" of a run.
std::vector<Note> setting_notes(const std::string& experiment, const std::vector<std::string>& overrides) {
  std::vector<Note> notes = notes_of(experiment, overrides);
  std::erase_if(notes, [](const Note& note) { return note.kind != "setting without effect"; });
  return notes;
}

// A command that is sent in the last tick cannot be received any more. Position-force with the whole force
// and a delay is unstable against a stiff scene.
TEST(SlaveNotes, AreThoseOfWhatWentWrong) {
  const std::string felt = "feedback.force=slave-force", weak = "feedback.gain=0.05", free = "fixtures=[]";
  const Kinds no_command{"slave without command"};
  const struct {
    const char* experiment;
    std::vector<std::string> set;
    Kinds kinds;
  } rows[] = {
      {"steer-robot", {"duration_s=1"}, {}},
      {"fig4.11", {}, {}},
      {"steer-robot", {"duration_s=1", "command_link.loss_probability=1"}, no_command},
      {"steer-robot", {"duration_s=1", "command_link.delay_s=2"}, no_command},
      {"steer-robot", {"duration_s=0.002", "command_link.delay_s=0"}, {}},
      {"steer-robot", {"duration_s=2.5", felt, weak, free}, {}},
      {"steer-robot", {"duration_s=2.5", felt, weak, free, "force_link.loss_probability=1"}, no_command},
      {"steer-robot", {"duration_s=2.5", felt, weak, free, "force_link.delay_s=10"}, no_command},
      {"steer-robot", {"duration_s=2.5", felt, weak, free, "force_link.least=100"}, no_command},
      {"steer-robot", {"duration_s=3", felt}, {"slave loop gains energy"}},
      {"steer-robot", {"duration_s=3", "feedback.force=none"}, {}},
      {"fig5.5", {"slave={}"}, {"slave without surface"}}};
  for (const auto& row : rows) {
    std::string what = row.experiment;
    for (const std::string& setting : row.set) what += " " + setting;
    EXPECT_EQ(slave_kinds(row.experiment, row.set), row.kinds) << what;
  }
}

// The error of the registration puts the slave behind the surface in some of these replicates.
TEST(SlaveNotes, SayThatTheSlaveStartsInContact) {
  int in_contact = 0;
  for (int replicate = 0; replicate < 8; ++replicate) {
    const Trace trace = simulate(
        Experiment::load("steer-robot", {"fixtures=[]", "duration_s=0.1", "registration.offset_m=0.03",
                                         "command_link.delay_s=0", "replicate=" + std::to_string(replicate),
                                         "trajectory.waypoints=[[0, 0.012, 0, 0], [0, 0.05, 0, 0.1]]"}),
        {});
    const std::vector<Note> notes = slave_notes(trace);
    const bool starts_inside = trace.slave_clearance_m.front() < 0;
    ASSERT_EQ(notes.size(), starts_inside ? 1u : 0u) << replicate;
    EXPECT_TRUE(!starts_inside || notes[0].kind == "slave starts in contact");
    EXPECT_EQ(trace.slave_peak_force_N[1] > 0, starts_inside) << replicate;
    in_contact += starts_inside ? 1 : 0;
  }
  EXPECT_GT(in_contact, 0);
  EXPECT_LT(in_contact, 8);
}

// Traces in which something is not known: the force of a renderer does not pass through the slave, so the
// slave is not part of its loop.
TEST(SlaveNotes, SayWhatIsNotKnown) {
  const double unknown = std::nan("");
  Trace trace = simulate(Experiment::load("steer-robot", {"duration_s=0.05", "command_link.delay_s=0"}), {});
  EXPECT_EQ(slave_notes(trace).size(), 0u);
  Trace behind = trace;
  behind.slave_clearance_m.back() = -0.001;
  EXPECT_EQ(slave_notes(behind).size(), 0u);
  behind.slave_peak_force_N.back() = unknown;
  ASSERT_EQ(kinds_of(slave_notes(behind)), Kinds{"slave without surface"});
  EXPECT_HAS(slave_notes(behind)[0].text, "normal");
  for (std::size_t i = 0; i < trace.length(); ++i) {
    trace.received_command_m[i].setConstant(unknown);
    trace.slave_clearance_m[i] = trace.slave_peak_force_N[i] = unknown;
  }
  ASSERT_EQ(slave_notes(trace).size(), 1u);
  EXPECT_HAS(slave_notes(trace)[0].text, "the slave never started");
  Trace gains = simulate(Experiment::load("steer-robot", {"duration_s=3", "feedback.force=slave-force"}), {});
  EXPECT_EQ(slave_notes(gains).size(), 1u);
  gains.force_packets.assign(gains.length(), 0);
  EXPECT_EQ(slave_notes(gains).size(), 0u);
}

// The slave follows the HIP through the region. The notes of a real or recorded hand do not mention its path.
TEST(SlaveNotes, SayThatFixturesHoldNothingBack) {
  for (const std::string force : {"none", "slave-force", "passive-slave-force"}) {
    const std::vector<std::string> set = {"feedback.force=" + force, "duration_s=0.1"};
    const std::vector<Note> notes = setting_notes("steer-robot", set);
    ASSERT_EQ(notes.size(), 1u) << force;
    EXPECT_HAS(notes[0].text, "fixtures hold nothing back with feedback.force = " + force);
    EXPECT_EQ(setting_notes("steer-robot", {set[0], "fixtures=[]"}).size(), 0u);
    EXPECT_EQ(slave_setting_notes(Experiment::load("steer-robot", set), Experiment::Hand::real).size(), 1u);
  }
  EXPECT_EQ(setting_notes("steer-robot", {"duration_s=0.1"}).size(), 0u);
  EXPECT_EQ(setting_notes("fixture-tasks", {"duration_s=0.1"}).size(), 0u);
}

TEST(SlaveNotes, SayThatAForceCannotMoveAHandWithoutAnOperator) {
  const std::string ball = R"({"scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"}, "slave": {},
      "trajectory": {"name": "waypoints"}, "duration_s": 0.02, "feedback": {"force": ")";
  const auto notes_of_force = [&](const std::string& force, const std::string& more, Experiment::Hand hand) {
    return slave_setting_notes(Experiment::from_json(ball + force + "\"}" + more + "}", "test"), hand);
  };
  for (const std::string force : {"slave-force", "passive-slave-force"}) {
    const std::vector<Note> notes = notes_of_force(force, "", Experiment::Hand::simulated);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].kind, "setting without effect");
    EXPECT_HAS(notes[0].text, "feedback.force = " + force + " moves nothing");
    EXPECT_EQ(notes_of_force(force, R"(, "operator": {})", Experiment::Hand::simulated).size(), 0u);
    EXPECT_EQ(notes_of_force(force, "", Experiment::Hand::real).size(), 0u);
  }
  for (const char* force : {"rendered", "none"})
    EXPECT_EQ(notes_of_force(force, "", Experiment::Hand::simulated).size(), 0u);
}

TEST(SlaveNotes, TheSummaryHasTheFirstContactAndTheLargestForce) {
  Trace trace;
  const auto add = [&](double peak_N, double clearance_m) {
    SlaveState slave;
    slave.peak_force_N = peak_N, slave.clearance_m = clearance_m;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, {}, {}, HandState{}, slave);
  };
  EXPECT_EQ(slave_summary(trace), "");
  add(0, std::nan(""));
  EXPECT_EQ(slave_summary(trace), "") << "the surface is not known";
  add(0, 0.0123);
  EXPECT_EQ(slave_summary(trace), "the slave did not touch; it came within 12.3 mm of the surface");
  add(4.5, -0.001);
  add(12.34, -0.002);
  EXPECT_EQ(slave_summary(trace),
            "the slave touched first at 0.002 s; largest force of the scene on it: 12.3 N");
  Trace unknown;
  std::swap(trace, unknown);
  add(std::nan(""), -0.001);
  EXPECT_EQ(slave_summary(trace), "it is not known whether the slave touched: its force is unknown");
}

}  // namespace
}  // namespace remote_touch::run_notes_test
