// Replayed contacts: files of positions and forces, and generated motions. An ideal spring that follows the
// hand exerts exactly the expected force.
#include "runners/experiment/hand/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/trace/force_measures.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::contact_replay_test {
namespace {

const std::string kColumns = "time_s x_mm y_mm z_mm fx_N fy_N fz_N";

class ContactFile : public testing::Test {
 protected:
  ForceTrace read(const std::string& name, const std::string& text, const std::string& columns = kColumns) {
    return read_force_trace(folder_.write(name, text), columns);
  }
  ContactReplay::Settings settings(const std::string& name, const std::string& text) const {
    ContactReplay::Settings s;
    s.file = folder_.write(name, text).string();
    return s;
  }

 private:
  const TestFolder folder_{"contact_replay"};
};

void expect_row(const ForceTraceRow& row, double time_s, const Vec3& contact_m, const Vec3& force_N) {
  EXPECT_DOUBLE_EQ(row.time_s, time_s);
  EXPECT_LT((row.contact_m - contact_m).norm(), 1e-15) << row.contact_m.transpose();
  EXPECT_LT((row.force_N - force_N).norm(), 1e-15) << row.force_N.transpose();
}

TEST_F(ContactFile, ReadsColumnsOfBlanksInMillimetres) {
  const ForceTrace trace = read("a.traj",
                                "# probe of a plane\n"
                                "0 10 -20 30 0 0 0\n"
                                "\n"
                                "  0.5\t11 -20.5 3e1 0.25 -1 +2 \r\n"
                                "% the end\n"
                                "0.75 12 -21 30 0 0 1");
  ASSERT_EQ(trace.rows.size(), 3u);
  expect_row(trace.rows[0], 0, {0.01, -0.02, 0.03}, {0, 0, 0});
  expect_row(trace.rows[1], 0.5, {0.011, -0.0205, 0.03}, {0.25, -1, 2});
  expect_row(trace.rows[2], 0.75, {0.012, -0.021, 0.03}, {0, 0, 1});
  EXPECT_TRUE(trace.unused.empty());
}

TEST_F(ContactFile, ReadsCsvByTheNamesOfItsColumns) {
  const ForceTrace trace = read("a.CSV",
                                "\xEF\xBB\xBF"
                                "fz, Time_ms ,px,PY_mm,pz_m,qw,fx_N,fy\r\n"
                                "3,0,0.1,200,0.3,x,1,2\r\n"
                                "6,250,0.4,500,0.6,,4,5\r\n");
  ASSERT_EQ(trace.rows.size(), 2u);
  expect_row(trace.rows[0], 0, {0.1, 0.2, 0.3}, {1, 2, 3});
  expect_row(trace.rows[1], 0.25, {0.4, 0.5, 0.6}, {4, 5, 6});
  EXPECT_EQ(trace.unused, std::vector<std::string>{"qw"});
}

TEST_F(ContactFile, NamesTheColumnsThatAreNotUsed) {
  const ForceTrace trace =
      read("a.traj", "7 0 1 2 3 4 5 6 8 9\n7 1 1 2 3 4 5 6 8 9\n", "count t x y z fx fy fz");
  ASSERT_EQ(trace.rows.size(), 2u);
  expect_row(trace.rows[1], 1, {1, 2, 3}, {4, 5, 6});
  EXPECT_EQ(trace.unused, (std::vector<std::string>{"count", "column 9", "column 10"}));
}

TEST_F(ContactFile, RefusesColumnsAndRowsInOneLine) {
  const std::string csv = "time,x,y,z,fx,fy,fz\n", begin = csv + "0,0,0,0,0,0,0\n";
  const struct {
    const char* name;
    std::string text, columns;
    const char* expected;
  } rows[] = {
      {"a.csv", "# comment\ntime,x,y,z,fx,fy\n", kColumns, "a.csv:2: no column fz: expected time, x, y, z"},
      {"a.csv", "time,x,y,z,fx,fy,fz,px_mm\n", kColumns, "a.csv:1: column px_mm: expected one column of x"},
      {"a.traj", "0 0 0 0 0 0 0\n", "time x y z", "trajectory.columns: no column fx"},
      {"a.csv", begin + "1,0,0,0,0,0\n", kColumns, "a.csv:3: 6 values: expected 7"},
      {"a.traj", "0 1 2 3 4 5\n", kColumns, "a.traj:1: 6 values: expected 7 or more"},
      {"a.csv", begin + "\n1,0,0,0,1N,0,0\n", kColumns, "a.csv:4: '1N' in column fx: expected a number"},
      {"a.csv", begin + "1,0,0,nan,0,0,0\n", kColumns, "a.csv:3: 'nan' in column z: expected a number"},
      {"a.csv", begin + "0,0,0,0,0,0,0\n", kColumns, "a.csv:3: time 0.000000 s: expected above"},
      {"a.csv", begin + "1,0,250,0,0,0,0\n", kColumns, "a.csv:3: a position more than 100 m"},
      {"a.csv", begin, kColumns, "a.csv: has 1 row(s): expected 2 or more"},
      {"a.txt", "0 0 0 0 0 0 0\n", kColumns, "a.txt: expected a file that ends in .csv or .traj"}};
  for (const auto& row : rows)
    EXPECT_HAS(refusal([&] { read(row.name, row.text, row.columns); }), row.expected);
  EXPECT_HAS(refusal([] { read_force_trace("/no/such/file.traj", kColumns); }),
             "/no/such/file.traj: cannot be read");
}

// --- generated contacts ---

const double kNan = std::numeric_limits<double>::quiet_NaN();

// A scene of one point with a given truth.
class KnownSurface : public Scenario {
 public:
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int) const override { return scenes::cloud_of({Vec3::Zero()}); }
};

// A leaning plane that rises along its normal. The normal is not known where x is in the band.
class Plane final : public KnownSurface {
 public:
  explicit Plane(const Vec3& normal = Vec3::UnitY(), double speed_m_per_s = 0, double band_m = 0)
      : normal_(normal.normalized()), speed_m_per_s_(speed_m_per_s), band_m_(band_m) {}
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return normal_.dot(p_W) - speed_m_per_s_ * time_s;
  }
  Vec3 true_normal(const Vec3& p_W, double) const override {
    return std::abs(p_W.x()) < band_m_ ? Vec3(Vec3::Constant(kNan)) : normal_;
  }

 private:
  const Vec3 normal_;
  const double speed_m_per_s_, band_m_;
};

class Ball final : public KnownSurface {
 public:
  static constexpr double kRadius_m = 0.04;
  double signed_distance(const Vec3& p_W, double) const override { return p_W.norm() - kRadius_m; }
  Vec3 true_normal(const Vec3& p_W, double) const override { return p_W.normalized(); }
};

class Unknown final : public KnownSurface {
 public:
  double signed_distance(const Vec3&, double) const override { return kNan; }
};

// The force of a spring that begins at the onset distance from the surface.
Vec3 spring_N(const Scenario& scene, const Vec3& hip_W, double time_s, double stiffness_N_per_m,
              double onset_distance_m) {
  const double depth_m = onset_distance_m - scene.signed_distance(hip_W, time_s);
  return stiffness_N_per_m * std::max(0.0, depth_m) * scene.true_normal(hip_W, time_s);
}

// The trace of an ideal spring that renders the surface, with `scale` times the stiffness of the replay.
Trace rendered(const ContactReplay::Settings& settings, const Scenario& scene, double rate_Hz,
               double scale = 1) {
  const ContactReplay hand(settings, scene);
  Trace trace;
  for (int i = 0; i <= hand.duration_s() * rate_Hz; ++i) {
    const double time_s = i / rate_Hz;
    const DeviceState device = hand.at(time_s);
    RenderOutput out;
    out.force_N = spring_N(scene, device.position_W, time_s, scale * settings.stiffness_N_per_m,
                           settings.onset_distance_m);
    trace.append(time_s, device, out, {.expected_force_N = hand.expected_force_N(time_s)});
  }
  return trace;
}

TEST(GeneratedContact, AnIdealSpringHasNoErrorOnPlaneAndBall) {
  ContactReplay::Settings s;
  for (const double onset_distance_m : {0.0, 0.005}) {
    s.onset_distance_m = onset_distance_m;
    s.from_m = {-0.03, 0.05, 0.01}, s.to_m = {0.03, 0.05, 0.02};
    for (const Scenario* scene : std::initializer_list<const Scenario*>{
             new Plane, new Plane({0.3, 1, -0.2}), new Plane({0.1, 1, 0}, 0.1), new Ball}) {
      const Trace trace = rendered(s, *scene, 1000);
      EXPECT_LT(rms_force_error_N(trace), 1e-10);
      EXPECT_LT(relative_force_error(trace), 1e-10);
      EXPECT_LT(force_direction_error_rad(trace), 1e-7);
      EXPECT_EQ(false_contact_fraction(trace), 0);
      EXPECT_EQ(lost_contact_fraction(trace), 0);
      delete scene;
    }
  }
}

// 0.4 s approach, 0.2 s load, 1 s slide, 0.2 s unload, 0.4 s retreat; depth 2 N / (500 N/m) = 4 mm.
TEST(GeneratedContact, HasItsPartsInOrder) {
  ContactReplay::Settings s;
  s.stiffness_N_per_m = 500, s.onset_distance_m = 0.003;
  s.from_m = {-0.02, 7, 0.01}, s.to_m = {0.03, 7, 0.01};
  s.min_force_N = s.max_force_N = 2;
  const ContactReplay hand(s, FlatGrid({}, NoiseKey{}, scenes::kernels()));
  EXPECT_DOUBLE_EQ(hand.duration_s(), 2.2);
  const auto expect_at = [&](double time_s, double x, double y, double newtons) {
    EXPECT_LT((hand.at(time_s).position_W - Vec3(x, y, 0.01)).norm(), 1e-12) << time_s;
    EXPECT_LT((*hand.expected_force_N(time_s) - Vec3(0, newtons, 0)).norm(), 1e-9) << time_s;
  };
  expect_at(-1, -0.02, 0.023, 0);
  expect_at(0, -0.02, 0.023, 0);
  expect_at(0.2, -0.02, 0.013, 0);
  expect_at(0.4, -0.02, 0.003, 0);
  expect_at(0.5, -0.02, 0.001, 1);
  expect_at(0.6, -0.02, -0.001, 2);
  expect_at(1.1, 0.005, -0.001, 2);
  expect_at(1.6, 0.03, -0.001, 2);
  expect_at(1.7, 0.03, 0.001, 1);
  expect_at(2.0, 0.03, 0.013, 0);
  expect_at(2.2, 0.03, 0.023, 0);
  expect_at(99, 0.03, 0.023, 0);
  ASSERT_EQ(hand.phases().size(), 1u);
  EXPECT_NEAR(hand.phases()[0].begins_s, 0.4, 0.0011);
  EXPECT_NEAR(hand.phases()[0].ends_s, 1.8, 0.0011);
}

TEST(GeneratedContact, ItsForceIsACosineThatBeginsAtItsMinimum) {
  ContactReplay::Settings s;
  s.min_force_N = 1, s.max_force_N = 4, s.force_period_s = 0.4;
  const ContactReplay hand(s, Plane());
  for (const double after_s : {0.0, 0.1, 0.2, 0.3, 0.4, 1.3})
    EXPECT_NEAR(hand.expected_force_N(0.6 + after_s)->y(), 2.5 - 1.5 * std::cos(2 * M_PI * after_s / 0.4),
                1e-9)
        << after_s;
}

TEST(GeneratedContact, KeepsItsNormalWhereNoneIsKnown) {
  ContactReplay::Settings s;
  const Plane edge({0.2, 1, 0}, 0, 0.004), plane({0.2, 1, 0});
  const ContactReplay over_edge(s, edge), over_plane(s, plane);
  for (double time_s = 0; time_s < over_edge.duration_s(); time_s += 0.01)
    EXPECT_LT((over_edge.at(time_s).position_W - over_plane.at(time_s).position_W).norm(), 0.001) << time_s;
  const double middle_s = 0.6 + 0.05 / 0.05;
  EXPECT_LT((over_edge.expected_force_N(middle_s)->normalized() - Vec3(0.2, 1, 0).normalized()).norm(),
            1e-12);
}

TEST(GeneratedContact, RefusesWhatItCannotFollow) {
  EXPECT_HAS(refusal([] { ContactReplay(ContactReplay::Settings{}, Unknown()); }),
             "trajectory.name = contact-replay: no true surface is known at -0.05");
  using Settings = ContactReplay::Settings;
  const std::pair<void (*)(Settings&), const char*> rows[] = {
      {[](Settings& s) { s.to_m = s.from_m; }, "to_m: expected another position"},
      {[](Settings& s) { s.min_force_N = 5; }, "min_force_N = 5.000000: expected at most max_force_N"},
      {[](Settings& s) { s.min_force_N = s.max_force_N = 0; }, "max_force_N = 0: expected above 0"},
      {[](Settings& s) { s.speed_m_per_s = 1e-5; }, "speed_m_per_s = 0.000010: the motion lasts"},
      {[](Settings& s) { s.file = "traces"; }, "file = traces: expected a file that ends in .csv or .traj"}};
  for (const auto& [change, expected] : rows) {
    Settings s;
    change(s);
    EXPECT_HAS(validate(s), expected);
  }
  Settings s;
  s.speed_m_per_s = 1e-5, s.file = "a.traj";  // the speed is that of a generated motion
  EXPECT_EQ(validate(s), "");
}

const char* const kTraj =
    "1.0 10 20 30  0 0 0\n"
    "1.1 10 10 30  0 1 0\n"
    "1.3 20 10 30  0 3 4\n"
    "1.4 20 20 30  0 0 0\n";
const char* const kCsv =
    "time_s,x_mm,y_mm,z_mm,fx,fy,fz,mx\n"
    "1.0,10,20,30,0,0,0,1\n"
    "1.1,10,10,30,0,1,0,1\n"
    "1.3,20,10,30,0,3,4,1\n"
    "1.4,20,20,30,0,0,0,1\n";

void expect_position(const ContactReplay& hand, double time_s, const Vec3& want) {
  EXPECT_LT((hand.at(time_s).position_W - want).norm(), 1e-12)
      << time_s << ": " << hand.at(time_s).position_W.transpose();
}
void expect_force(const ContactReplay& hand, double time_s, const Vec3& want) {
  EXPECT_LT((*hand.expected_force_N(time_s) - want).norm(), 1e-12)
      << time_s << ": " << hand.expected_force_N(time_s)->transpose();
}

TEST_F(ContactFile, TheHipIsTheContactMinusForceOverStiffness) {
  for (const bool csv : {false, true}) {
    ContactReplay::Settings s = csv ? settings("a.csv", kCsv) : settings("a.traj", kTraj);
    s.stiffness_N_per_m = 500, s.onset_distance_m = 0;
    const ContactReplay hand(s, Unknown());
    EXPECT_NEAR(hand.duration_s(), 0.4, 1e-12);
    expect_position(hand, 0, {0.01, 0.02, 0.03});
    expect_position(hand, 0.05, {0.01, 0.014, 0.03});
    expect_position(hand, 0.1, {0.01, 0.008, 0.03});
    expect_position(hand, 0.2, {0.015, 0.006, 0.026});
    expect_position(hand, 0.3, {0.02, 0.004, 0.022});
    expect_position(hand, 9, {0.02, 0.02, 0.03});
    expect_force(hand, 0, {0, 0, 0});
    expect_force(hand, 0.05, {0, 0.5, 0});
    expect_force(hand, 0.2, {0, 2, 2});
    expect_force(hand, 0.35, {0, 1.5, 2});
    ASSERT_EQ(hand.phases().size(), 1u);
    EXPECT_NEAR(hand.phases()[0].begins_s, 0.1, 1e-12);
    EXPECT_NEAR(hand.phases()[0].ends_s, 0.3, 1e-12);
    ASSERT_EQ(hand.notes().size(), csv ? 1u : 0u);
    if (!csv) continue;
    EXPECT_EQ(hand.notes()[0].kind, "columns unused");
    EXPECT_HAS(hand.notes()[0].text, "a.csv: columns that are not used: mx");
  }
}

// The same contact in millimetres is 1000 times as large without units in the names of its columns.
TEST_F(ContactFile, InMillimetresWithoutUnitsIsReported) {
  const std::string rows = "0,10,0,0,0,0,0\n0.5,12,3,0,0,1,0\n1,11,2,0,0,0,0\n";
  EXPECT_TRUE(
      ContactReplay(settings("a.csv", "time,x_mm,y_mm,z_mm,fx,fy,fz\n" + rows), Unknown()).notes().empty());
  const std::vector<Note> notes =
      ContactReplay(settings("a.csv", "time,x,y,z,fx,fy,fz\n" + rows), Unknown()).notes();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].kind, "unusual poses");
  EXPECT_HAS(notes[0].text, "a.csv: the contact moves through 3.61 m at up to 7.21 m/s: without units");
}

// Without a known surface the direction of the onset distance is that of the force; in free motion it is that
// of the contact before, and at the begin that of the first one.
TEST_F(ContactFile, TheOnsetDistanceIsAlongTheForceIfTheSurfaceIsUnknown) {
  ContactReplay::Settings s = settings("a.traj", kTraj);
  s.stiffness_N_per_m = 1000, s.onset_distance_m = 0.01;
  const ContactReplay hand(s, Unknown());
  expect_position(hand, 0, {0.01, 0.02 + 0.01, 0.03});
  expect_position(hand, 0.1, {0.01, 0.01 + 0.01 - 0.001, 0.03});
  expect_position(hand, 0.3, {0.02, 0.01 + 0.006 - 0.003, 0.03 + 0.008 - 0.004});
  expect_position(hand, 0.4, {0.02, 0.02 + 0.006, 0.03 + 0.008});
}

// The force may be that on the object, and count as a contact from a certain force on. Rows may be left out
// at the beginning.
TEST_F(ContactFile, IsMovedToTheWorld) {
  ContactReplay::Settings s = settings("a.traj", kTraj), of_object = s, late = s;
  s.onset_distance_m = 0, s.stiffness_N_per_m = 1000;
  s.scale = 2, s.rotation_deg = {0, 0, 90}, s.offset_m = {1, 2, 3};
  const ContactReplay hand(s, Unknown());
  // (x, y, z) becomes (-y, x, z).
  expect_force(hand, 0.3, {-3, 0, 4});
  expect_position(hand, 0, {1 - 0.04, 2 + 0.02, 3 + 0.06});
  expect_position(hand, 0.3, {1 - 0.02 + 0.003, 2 + 0.04, 3 + 0.06 - 0.004});
  of_object.force_on_object = true, of_object.contact_force_N = 1.5;
  expect_force(ContactReplay(of_object, Unknown()), 0.1, {0, 0, 0});
  expect_force(ContactReplay(of_object, Unknown()), 0.3, {0, -3, -4});
  late.onset_distance_m = 0, late.stiffness_N_per_m = 1000, late.start_s = 0.15;
  EXPECT_NEAR(ContactReplay(late, Unknown()).duration_s(), 0.1, 1e-12);
  expect_position(ContactReplay(late, Unknown()), 0, {0.02, 0.007, 0.026});
}

TEST_F(ContactFile, RefusesWhatIsNoContact) {
  ContactReplay::Settings none =
      settings("in.traj", "0 0 0 0 0 0 0\n1 0 0 0 0 0 0\n");  // as the in-trajectories of the paper
  ContactReplay::Settings far = settings("a.traj", kTraj), late = far;
  far.offset_m = {1000, 0, 0}, late.start_s = 0.35;
  const std::pair<ContactReplay::Settings, const char*> rows[] = {
      {none, "in.traj: has no force above"},
      {settings("ms.traj", "0 0 0 0 0 0 0\n10001 0 0 0 0 1 0\n"),
       "ms.traj: lasts 10001.000000 s: expected at most 10000.000000 s; times in milliseconds need"},
      {far, "more than 1000 m from the origin"},
      {late, "trajectory.start_s = 0.350000: fewer than two rows"}};
  for (const auto& row : rows) EXPECT_HAS(refusal([&] { ContactReplay(row.first, Unknown()); }), row.second);
}

TEST_F(ContactFile, IsAnInputOfTheRun) {
  EXPECT_TRUE(input_files(ContactReplay::Settings{}).empty());
  const ContactReplay::Settings s = settings("a.traj", kTraj);
  ASSERT_EQ(input_files(s).size(), 1u);
  EXPECT_EQ(input_files(s)[0].path, s.file);
}

}  // namespace
}  // namespace remote_touch::contact_replay_test
