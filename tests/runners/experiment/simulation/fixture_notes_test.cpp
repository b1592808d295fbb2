// The note on fixture rules that select nothing.
#include "runners/experiment/simulation/fixture_notes.h"

#include <gtest/gtest.h>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/search/neighbour_search.h"
#include "tests/runners/experiment/simulation/reported_run.h"

namespace remote_touch::fixture_notes_test {
namespace {

using Texts = std::vector<std::string>;

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

Texts texts_of(const std::vector<Note>& notes) {
  Texts texts;
  for (const Note& note : notes) texts.push_back(note.kind + ": " + note.text);
  return texts;
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
}

TEST(FixtureNotes, AreNoneIfThereAreNoRulesOrFrames) {
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

}  // namespace
}  // namespace remote_touch::fixture_notes_test
