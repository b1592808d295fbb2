// Recorded sessions: a recording is read back bit for bit, a file that is no recording is refused in one
// line. The settings of the live loop that a recording has.
#include "runners/experiment/sessions/session_file.h"

#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "core/points/vector.h"
#include "tests/runners/experiment/sessions/small_session.h"
#include "tests/support/test_files.h"

namespace remote_touch::session_file_test {
namespace {

namespace fs = std::filesystem;

// --- settings of the live loop ---

// The camera is turned first, and then moved. A quarter turn about z maps x to y. The position of the device
// does not move it.
TEST(LiveSettings, ACameraIsTurnedAndMoved) {
  LiveSettings s;
  s.device_position_m = Vec3(1, 2, 3), s.device_rotation_deg = Vec3(0, 0, 90), s.device_scale = 2;
  EXPECT_EQ(camera_registration(s).matrix(), Eigen::Matrix4d::Identity());
  s.camera_position_m = Vec3(1, 2, 3), s.camera_rotation_deg = Vec3(0, 0, 90);
  EXPECT_LT((camera_registration(s) * Vec3(0.5, 0, 0) - Vec3(1, 2.5, 3)).norm(), 1e-15);
  EXPECT_LT((camera_registration(s) * Vec3(0, 0.5, 0.25) - Vec3(0.5, 2, 3.25)).norm(), 1e-15);
}

// Any force must fall to zero within 10 ms: 5 N at 500 N/s.
TEST(SafetyLimits, ASlewRateThatCannotReleaseIsRefused) {
  const struct {
    void (*change)(SafetyLimits&);
    const char* expected;  // a part of the refusal
  } rows[] = {
      {[](SafetyLimits& s) { s.force_slew_N_per_s = 500; }, ""},
      {[](SafetyLimits& s) { s.force_slew_N_per_s = std::nextafter(500, 0); }, "force_slew_N_per_s = 500"},
      {[](SafetyLimits& s) { s.force_slew_N_per_s = 499; },
       "force_slew_N_per_s = 499.000000: expected max_force_N / 0.01 s = 500.000000 or more, so that the "
       "maximum can fall to 0 in that time"},
      {[](SafetyLimits& s) { s.max_force_N = 10; }, ""},
      {[](SafetyLimits& s) { s.max_force_N = 10.1; }, "force_slew_N_per_s = 1000"},
      {[](SafetyLimits& s) { s.torque_slew_Nm_per_s = 20; }, ""},
      {[](SafetyLimits& s) { s.torque_slew_Nm_per_s = 19; },
       "torque_slew_Nm_per_s = 19.000000: expected max_torque_Nm / 0.01 s = 20.000000"},
      {[](SafetyLimits& s) { s.max_force_N = 0, s.max_torque_Nm = 0.41; }, "torque_slew_Nm_per_s = 40"}};
  for (const auto& row : rows) {
    SafetyLimits s;
    row.change(s);
    const std::string problem = validate(s);
    EXPECT_EQ(problem.empty(), std::string(row.expected).empty()) << problem;
    EXPECT_HAS(problem, row.expected);
  }
}

// --- what was written ---

template <class Numbers>
bool same_bits(const Numbers& a, const Numbers& b) {
  return std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof *a.data()) == 0;
}

void expect_same(const SessionReader& read, const SmallSession& written) {
  ASSERT_EQ(read.tick_count(), written.ticks.size());
  for (std::size_t i = 0; i < read.tick_count(); ++i) {
    const SessionTick& tick = written.ticks[i];
    EXPECT_EQ(read.tick_number(i), static_cast<std::uint64_t>(tick.number));
    EXPECT_EQ(read.taken(i), tick.taken);
    EXPECT_TRUE(same_bits(read.device(i).position_W, tick.device.position_W)) << i;
    EXPECT_TRUE(same_bits(read.device(i).orientation_W.coeffs(), tick.device.orientation_W.coeffs())) << i;
    EXPECT_EQ(read.device(i).buttons, tick.device.buttons) << i;
  }
  ASSERT_EQ(read.frame_count(), written.frames.size());
  for (std::size_t i = 0; i < read.frame_count(); ++i) {
    EXPECT_EQ(read.captured_s(i), written.captured_s[i]);
    EXPECT_EQ(read.fixtures_off(i), written.fixtures_off[i]);
    const SensorFrame frame = read.frame(i);
    EXPECT_EQ(frame.number, written.frames[i].number);
    EXPECT_EQ(frame.captured_s, written.captured_s[i]);
    EXPECT_EQ(frame.depth, written.frames[i].depth);
    EXPECT_EQ(frame.colour, written.frames[i].colour);
  }
}

// Numbers that a careless writer would change: ends of ranges, no decimal fraction, the sign of zero.
TEST(SessionFile, GivesBackTheTicksToTheBit) {
  const TestFolder folder("session_file");
  SmallSession session;
  for (int i = 0; i < 3; ++i) session.add_frame(i, 0.1 * i);
  session.add_tick(0), session.add_tick(2, 0), session.add_tick(3, 2), session.add_tick(2147483647);
  session.ticks[1].device = {{-0.0, 1.0 / 3, 5e-324}, {0.1, -0.2, 0.3, -0.4}, 0x7fffffffu};
  session.ticks[2].device = {
      {1e300, -1e-300, std::numeric_limits<double>::quiet_NaN()}, {-0.0, 1, 0, 0}, 0x80000001u};
  session.ticks[3].device.buttons = 0xffffffffu;
  expect_same(SessionReader(session.write(folder / "session.h5")), session);
}

TEST(SessionFile, GivesBackChangesOfParameters) {
  const TestFolder folder("session_file");
  SmallSession session;
  session.add_tick(3), session.add_tick(4);
  SessionWriter writer(folder / "x.h5", session.view, session.registered, {{"config", session.config}},
                       {"renderer.r3_m", "scenario.noise_per_m"});
  session.fill(writer);
  writer.append(SessionChange{3, 1, 0.02}), writer.append(SessionChange{3, 0, 1.0 / 3});
  writer.append(SessionChange{2147483647, 0, -0.0});
  writer.finish();
  const SessionReader read(folder / "x.h5");
  ASSERT_EQ(read.changes().size(), 3u);
  EXPECT_EQ(read.changes()[0].tick, 3u);
  EXPECT_EQ(read.live_parameter(read.changes()[0]), "scenario.noise_per_m");
  EXPECT_EQ(read.live_parameter(read.changes()[1]), "renderer.r3_m");
  EXPECT_EQ(read.changes()[1].value, 1.0 / 3);
  EXPECT_EQ(read.changes()[2].tick, 2147483647u);
}

// Ticks are written to the disk a thousand at a time, and the last ones at the end.
TEST(SessionFile, GivesBackThousandsOfTicks) {
  const TestFolder folder("session_file");
  for (const int count : {0, 999, 1000, 1001, 2000, 4500}) {
    SmallSession session;
    if (count > 0) session.add_frame(0, 0);
    for (int i = 0; i < count; ++i) session.add_tick(i + i / 7, i == 10 ? 0 : -1);
    expect_same(SessionReader(session.write(folder / "session.h5")), session);
  }
}

TEST(SessionFile, GivesBackFramesWithAndWithoutColour) {
  const TestFolder folder("session_file");
  for (const bool has_colour : {false, true}) {
    SmallSession session;
    session.view.has_colour = has_colour;
    session.add_frame(-3, -0.01), session.add_frame(4, 1.0 / 30, 65530, ~std::uint64_t{0});
    session.add_frame(2147483647, 1e4, 0, 5);
    if (has_colour) session.frames[1].colour = {0, 0x123456, 0xffffff, 0x80000000u, 0xffffffffu, 1};
    const SessionReader read(session.write(folder / "session.h5"));
    EXPECT_EQ(read.view().has_colour, has_colour);
    EXPECT_EQ(read.frame(0).colour.empty(), !has_colour);
    expect_same(read, session);
  }
}

// The renderer's points depend on the pose of the camera, its registration included.
TEST(SessionFile, GivesBackTheViewToTheBit) {
  const TestFolder folder("session_file");
  SmallSession session;
  session.view.camera = {3, 2, 525.0 / 7, 1.0 / 3, -0.1, 1e-300};
  session.view.metres_per_unit = 0.0001, session.view.frame_rate_hz = 29.97;
  session.view.X_WC = RigidTransform(Eigen::Translation3d(1, 2, 3));
  for (const bool is_registered : {false, true}) {
    session.registered = session.view.X_WC;
    if (is_registered) session.registered.rotate(rotation({0.1, -0.7, 1.0 / 3}));
    session.config = R"({"haptic_rate_hz": 333.3, "scenario": {"name": "ramp"}})";
    const SessionReader read(session.write(folder / "session.h5"));
    const CameraIntrinsics &got = read.view().camera, &put = session.view.camera;
    EXPECT_EQ(got.width, put.width);
    EXPECT_EQ(got.height, put.height);
    EXPECT_EQ(got.fx, put.fx);
    EXPECT_EQ(got.fy, put.fy);
    EXPECT_EQ(got.cx, put.cx);
    EXPECT_EQ(got.cy, put.cy);
    EXPECT_EQ(read.view().metres_per_unit, 0.0001);
    EXPECT_EQ(read.view().frame_rate_hz, 29.97);
    EXPECT_TRUE(same_bits(read.view().X_WC.matrix(), session.registered.matrix()));
    EXPECT_EQ(read.haptic_rate_hz(), 333.3);
    EXPECT_EQ(read.config(), session.config);
  }
}

// --- what is refused ---

std::string why_not(const fs::path& file) {
  return refusal([&] {
    const SessionReader read(file);
    for (std::size_t i = 0; i < read.frame_count(); ++i) read.frame(i);
  });
}

TEST(SessionFile, AFileOfAnotherKindIsRefused) {
  const TestFolder folder("session_file");
  const fs::path trace = folder / "trace.h5";
  Hdf5Appender other(trace);
  other.attributes("/", {{"schema", schema_name("trace")}});
  other.finish();
  EXPECT_EQ(why_not(trace), trace.string() + ": is of schema remote-touch-trace/3: expected " +
                                "remote-touch-session/3, which remote-touch live --record makes");
  EXPECT_HAS(why_not(folder / "none.h5"), "none.h5: no such file");
  EXPECT_HAS(why_not(folder.write("text.h5", "a text")), "text.h5: not a readable HDF5 file");
}

// The datasets of a session as any program may have written them, whole and sealed.
struct RawSession {
  std::string view =
      R"({"width": 3, "height": 2, "fx": 100, "fy": 100, "cx": 1, "cy": 0.5, "metres_per_unit": 0.001,
          "frame_rate_hz": 30, "has_colour": true, "X_WC": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]})";
  std::string config = R"({"haptic_rate_hz": 1000})";
  std::vector<std::uint64_t> number{3, 4, 9}, fixtures_off{0, 0};
  std::vector<double> position = std::vector<double>(9), orientation = std::vector<double>(12),
                      buttons{0, 1, 0};
  std::vector<double> captured{0, 0.1};
  std::vector<std::int32_t> taken{0, -1, 1}, frame_number{5, 6};
  std::vector<std::int32_t> depth = std::vector<std::int32_t>(12, 500);
  std::vector<double> colour = std::vector<double>(12, 0xffffff);
  std::string live_parameters = R"(["renderer.r1_m", "renderer.r3_m"])";
  std::vector<std::uint64_t> changed_at{4, 4};
  std::vector<std::int32_t> changed{1, 0};
  std::vector<double> value{0.02, 0.004};
  unsigned long long width = 3, height = 2;  // size of the images as stored
  std::string left_out;                      // a dataset that is not written

  void view_with(const std::string& old, const std::string& now) {
    view.replace(view.find(old), old.size(), now);
  }
  fs::path write(const fs::path& file) const;
};

fs::path RawSession::write(const fs::path& file) const {
  using Number = Hdf5Appender::Number;
  Hdf5Appender out(file);
  out.attributes("/", {{"schema", schema_name("session")},
                       {"view", view},
                       {"config", config},
                       {"live_parameters", live_parameters}});
  out.group("/ticks"), out.group("/frames"), out.group("/changes");
  const auto put = [&](const char* path, Number kind, const auto& values,
                       std::vector<unsigned long long> row = {}) {
    if (path == left_out) return;
    std::size_t width_of_row = 1;
    for (const auto extent : row) width_of_row *= extent;
    out.dataset({path, "1", "", kind, row});
    out.append(path, values.data(), values.size() / width_of_row);
  };
  put("/ticks/number", Number::u64, number), put("/ticks/position", Number::f64, position, {3});
  put("/ticks/orientation", Number::f64, orientation, {4}), put("/ticks/buttons", Number::f64, buttons);
  put("/ticks/taken", Number::i32, taken), put("/frames/number", Number::i32, frame_number);
  put("/frames/captured", Number::f64, captured), put("/frames/fixtures_off", Number::u64, fixtures_off);
  put("/frames/depth", Number::i32, depth, {height, width});
  put("/frames/colour", Number::f64, colour, {height, width});
  put("/changes/tick", Number::u64, changed_at), put("/changes/parameter", Number::i32, changed);
  put("/changes/value", Number::f64, value);
  out.finish();
  return file;
}

struct Damage {
  void (*make)(RawSession&);
  const char* says;
};

constexpr const char *kLengths = "its columns differ in length", *kTicks = "its ticks are out of order",
                     *kFrames = "its frames are out of order",
                     *kChanges = "its changes of parameters are not possible",
                     *kSize = "/frames/depth is of another size",
                     *kPixels = "/frames/depth has values that no pixel has",
                     *kAttributes = "its attributes view and config cannot be read";

const Damage kDamages[] = {
    {[](RawSession& s) { s.position.resize(6); }, kLengths},
    {[](RawSession& s) { s.orientation.resize(16); }, kLengths},
    {[](RawSession& s) { s.buttons.pop_back(); }, kLengths},
    {[](RawSession& s) { s.taken.pop_back(); }, kLengths},
    {[](RawSession& s) { s.frame_number.push_back(7); }, kLengths},
    {[](RawSession& s) { s.fixtures_off.clear(); }, kLengths},
    {[](RawSession& s) { s.left_out = "/ticks/position"; }, "/ticks/position is missing"},
    {[](RawSession& s) { s.left_out = "/frames/number"; }, "/frames/number is missing"},
    {[](RawSession& s) { s.changed.pop_back(); }, kLengths},
    {[](RawSession& s) { s.value.push_back(1); }, kLengths},
    {[](RawSession& s) { s.left_out = "/changes/value"; }, "/changes/value is missing"},
    {[](RawSession& s) { s.changed_at[0] = 5; }, kChanges},
    {[](RawSession& s) { s.changed_at[1] = std::uint64_t{1} << 31; }, kChanges},
    {[](RawSession& s) { s.changed[0] = 2; }, kChanges},
    {[](RawSession& s) { s.changed[1] = -1; }, kChanges},
    {[](RawSession& s) { s.live_parameters = "[]"; }, kChanges},
    {[](RawSession& s) { s.live_parameters = "[3, 4]"; }, "its attribute live_parameters cannot be read"},
    {[](RawSession& s) { s.value[1] = std::numeric_limits<double>::infinity(); }, kChanges},
    {[](RawSession& s) { s.number[1] = 3; }, kTicks},
    {[](RawSession& s) { s.number[2] = std::uint64_t{1} << 31; }, kTicks},
    {[](RawSession& s) { s.taken[2] = 2; }, kTicks},
    {[](RawSession& s) { s.taken[1] = 0; }, kTicks},
    {[](RawSession& s) { s.frame_number[0] = 6; }, kFrames},
    {[](RawSession& s) { s.captured[0] = 0.1; }, kFrames},
    {[](RawSession& s) { s.captured[1] = std::numeric_limits<double>::quiet_NaN(); }, kFrames},
    {[](RawSession& s) { s.buttons[2] = -1; }, "/ticks/buttons has values that are not button states"},
    {[](RawSession& s) { s.buttons[2] = 1e10; }, "/ticks/buttons has values that are not button states"},
    {[](RawSession& s) { s.width = 2, s.depth.resize(8), s.colour.resize(8); }, kSize},
    {[](RawSession& s) { s.height = 3, s.depth.resize(18), s.colour.resize(18); }, kSize},
    {[](RawSession& s) { s.depth[7] = 65536; }, kPixels},
    {[](RawSession& s) { s.depth[7] = -1; }, kPixels},
    {[](RawSession& s) { s.colour[7] = 1e10; }, "/frames/colour has values that no pixel has"},
    {[](RawSession& s) { s.left_out = "/frames/depth"; }, "/frames/depth is missing"},
    {[](RawSession& s) { s.left_out = "/frames/colour"; }, "/frames/colour is missing"},
    {[](RawSession& s) { s.view = ""; }, kAttributes},
    {[](RawSession& s) { s.view = "[1]"; }, kAttributes},
    {[](RawSession& s) { s.view_with("true", "1"); }, kAttributes},
    {[](RawSession& s) { s.view_with(", 0]", "]"); }, kAttributes},
    {[](RawSession& s) { s.config = ""; }, kAttributes},
    {[](RawSession& s) { s.config = "{}"; }, kAttributes},
    {[](RawSession& s) { s.config = R"({"haptic_rate_hz": 0})"; }, "haptic_rate_hz = 0"},
    // Their product is as many pixels as the images have.
    {[](RawSession& s) { s.view_with("3, \"height\": 2", "-3, \"height\": -2"); }, "width = -3"},
    {[](RawSession& s) { s.view_with("\"width\": 3", "\"width\": 1e99"); }, "width = 1e+99"},
    {[](RawSession& s) { s.view_with("\"fx\": 100", "\"fx\": 0"); }, "fx = 0"},
    {[](RawSession& s) { s.view_with("\"fy\": 100", "\"fy\": -100"); }, "fy = -100"},
    {[](RawSession& s) { s.view_with("\"metres_per_unit\": 0.001", "\"metres_per_unit\": 0"); },
     "metres_per_unit = 0"},
    {[](RawSession& s) { s.view_with("\"frame_rate_hz\": 30", "\"frame_rate_hz\": -30"); },
     "frame_rate_hz = -30"},
    {[](RawSession& s) { s.view_with("[1, 0", "[2, 0"); }, "X_WC is not a pose"},
    {[](RawSession& s) { s.view_with("[1, 0", "[-1, 0"); }, "X_WC is not a pose"},
};

TEST(SessionFile, RefusesWhatNoLoopRecords) {
  const TestFolder folder("session_file");
  ASSERT_EQ(why_not(RawSession{}.write(folder / "good.h5")), "no InputError");
  for (const Damage& damage : kDamages) {
    RawSession session;
    damage.make(session);
    const fs::path file = session.write(folder / "damaged.h5");
    EXPECT_EQ(why_not(file),
              file.string() + ": damaged (" + damage.says + "): expected a result of this program");
  }
}

// The file is of version 0.2, from before parameters could change.
TEST(SessionFile, OneWithoutAListOfChangesIsRead) {
  const TestFolder folder("session_file");
  RawSession session;
  session.left_out = "/changes/tick";
  EXPECT_TRUE(SessionReader(session.write(folder / "old.h5")).changes().empty());
}

TEST(SessionFile, FewerImagesThanFramesAreRefused) {
  const TestFolder folder("session_file");
  RawSession session;
  session.depth.resize(6);
  EXPECT_HAS(why_not(session.write(folder / "damaged.h5")), "damaged.h5: damaged (");
}

}  // namespace
}  // namespace remote_touch::session_file_test
