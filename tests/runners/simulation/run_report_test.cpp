// The notes of a run: each is written for a run that did not do what its experiment describes, and for no
// other.
#include "runners/simulation/run_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/search/neighbour_search.h"
#include "runners/simulation/simulation.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::run_report_test {
namespace {

// A press into a plane at rest, as JSON with two places to fill in: the scene and the hand.
RunReport report_of_run(const std::string& scenario, const std::string& trajectory,
                        const std::string& rest = R"("duration_s": 0.3)") {
  const std::string text = R"({"scenario": )" + scenario +
                           R"(, "renderer": {"name": "proxy"}, "trajectory": )" + trajectory + ", " + rest +
                           "}";
  RunReport report;
  SimulationOptions options;
  options.report = &report;
  simulate(Experiment::from_json(text, "test"), options);
  return report;
}

std::vector<std::string> kinds_of(const RunReport& report) {
  std::vector<std::string> kinds;
  for (const Note& note : report.notes) kinds.push_back(note.kind);
  return kinds;
}
using Kinds = std::vector<std::string>;

constexpr const char* kPlane = R"({"name": "flat-grid", "rows": 40, "columns": 40, "spacing_m": 0.0015})";
constexpr const char* kPress =
    R"({"name": "press", "start_m": [0, 0.02, 0], "press_at_s": 0.1, "depth_m": 0.01})";

TEST(RunReport, AnOrdinaryPressHasNoNotes) {
  const RunReport report = report_of_run(kPlane, kPress);
  EXPECT_TRUE(report.notes.empty());
  EXPECT_TRUE(report.inputs.empty());  // nothing was read
  EXPECT_EQ(text_of(report), "");
  EXPECT_NO_THROW(refuse_notes(report));
}

TEST(RunReport, ReportsAPressThatWasNotReached) {
  const RunReport report = report_of_run(kPlane, kPress, R"("duration_s": 0.1)");
  EXPECT_EQ(kinds_of(report), (Kinds{"phase not reached", "no contact"}));
  EXPECT_EQ(report.notes[0].text, "the run ends at 0.1 s, before the press begins at 0.1 s");
  EXPECT_HAS(text_of(report), "  note: the run ends at 0.1 s");
  EXPECT_HAS(refusal([&] { refuse_notes(report); }), "--strict: the run ends at 0.1 s");
}

TEST(RunReport, ReportsAMotionOfTheSceneThatWasNotReached) {
  const std::string waits = R"({"name": "moving-plane", "start_height_m": 0, "wait_s": 0.4})";
  EXPECT_EQ(kinds_of(report_of_run(waits, kPress)), Kinds{"phase not reached"});
  EXPECT_EQ(kinds_of(report_of_run(waits, kPress, R"("duration_s": 0.5)")), Kinds{});
}

TEST(RunReport, ReportsAPressAfterTheMotion) {
  const std::string rises =
      R"({"name": "moving-plane", "start_height_m": -0.01, "wait_s": 0, "speed_m_per_s": 0.2, "rise_height_m": 0.01})";
  const RunReport report = report_of_run(rises, kPress);
  EXPECT_EQ(kinds_of(report), Kinds{"after the motion"});
  EXPECT_HAS(report.notes[0].text,
             "the press begins at 0.1 s, after the rise of the plane has ended at 0.05 s");
}

TEST(RunReport, ReportsATrajectoryThatDoesNotEnd) {
  const std::string path = R"({"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, -0.01, 0, 0.2]]})";
  EXPECT_EQ(kinds_of(report_of_run(kPlane, path)), Kinds{});
  EXPECT_EQ(kinds_of(report_of_run(kPlane, path, R"("duration_s": 0.14)")), Kinds{"phase not reached"});
}

TEST(RunReport, ReportsThatNothingWasTouched) {
  const std::string above = R"({"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, 0.01, 0, 0.3]]})";
  EXPECT_EQ(kinds_of(report_of_run(kPlane, above)), Kinds{"no contact"});
}

// The proxy falls through a square of points farther apart than sqrt(2) r_c = 7.07 mm.
TEST(RunReport, ReportsPointsThatAreTooFarApart) {
  const auto plane = [](const char* spacing) {
    return std::string(R"({"name": "flat-grid", "rows": 41, "columns": 41, "spacing_m": )") + spacing + "}";
  };
  EXPECT_EQ(kinds_of(report_of_run(plane("0.0069"), kPress)), Kinds{});
  const RunReport report = report_of_run(plane("0.0072"), kPress);
  EXPECT_EQ(kinds_of(report), Kinds{"wide spacing"});
  EXPECT_HAS(report.notes[0].text, "are 7.2 mm apart");
  EXPECT_HAS(report.notes[0].text, "farther apart than 7.07 mm");
}

// A scene of given points, at rest.
class GivenPoints final : public Scenario {
 public:
  explicit GivenPoints(PointCloud cloud) : cloud_(std::move(cloud)) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  std::shared_ptr<const NeighbourSearch> points(int) const override { return make_search(cloud_); }
  PointCloud cloud(int) const override { return cloud_; }
  double signed_distance(const Vec3&, double) const override { return 0; }

 private:
  const PointCloud cloud_;
};

// The median distance to the nearest neighbour of the points within a ball around the origin, from its
// definition.
double median_spacing_m(const PointCloud& cloud, double radius_m) {
  std::vector<double> nearest_m;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.point(i).norm() > radius_m) continue;
    double least_m = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < cloud.size(); ++j)
      if (j != i && cloud.point(j).norm() <= radius_m)
        least_m = std::min(least_m, (cloud.point(i) - cloud.point(j)).norm());
    nearest_m.push_back(least_m);
  }
  std::sort(nearest_m.begin(), nearest_m.end());
  return nearest_m.empty() ? std::numeric_limits<double>::infinity() : nearest_m[nearest_m.size() / 2];
}

TEST(RunReport, TheSpacingIsTheMedianDistanceToTheNearestNeighbour) {
  constexpr double kContactRadius_m = 0.005;
  Trace trace;
  RenderOutput out;
  out.contact_count = 1, out.frame_index = 0;
  trace.append(0, {}, out, {});
  int wide = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    // A cube of 4 cm has 2 to 60 points, whose spacing is about that of the limit.
    const GivenPoints scene(scenes::random_cloud(2 + static_cast<int>(seed % 59), 0.02, seed));
    const bool is_wide =
        median_spacing_m(scene.cloud(0), 3 * kContactRadius_m) > std::sqrt(2.0) * kContactRadius_m;
    const auto notes = spacing_notes(scene, trace, kContactRadius_m, scenes::kernels());
    EXPECT_EQ(!notes.empty(), is_wide) << seed;
    wide += is_wide ? 1 : 0;
  }
  EXPECT_GT(wide, 50);
  EXPECT_LT(wide, 250) << "both happen";
}

TEST(RunReport, BecomesAttributesOfTheResult) {
  TextAttributes attributes{{"config", "{}"}};
  add_report(attributes, {});
  EXPECT_EQ(attributes.size(), 1u);  // absent where there is nothing to report
  add_report(attributes, {{"office: 3 frames"}, {{"no contact", "no contact at all"}, {"no frame", "none"}}});
  EXPECT_EQ(attribute(attributes, "frames_read"), "office: 3 frames");
  EXPECT_EQ(attribute(attributes, "notes"), "no contact at all\nnone");
}

}  // namespace
}  // namespace remote_touch::run_report_test
