// Every fixture rule on every kind of cloud. Either the run is refused in one line that states what is
// expected, or the rule has its effect. The same holds for guidance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "tests/runners/experiment/simulation/cloud_kinds.h"

namespace remote_touch::fixture_needs_test {
namespace {

using namespace cloud_kinds;

class FixtureNeeds : public CloudKinds {};

struct Rule {
  const char* json;   // the closing brace is missing
  const char* needs;  // "", "colours" or "image"
};

// A rule that works keeps the proxy 2 cm away.
void expect_region_or_refusal(const Kind& kind, const Rule& rule) {
  SCOPED_TRACE(kind.scenario + " " + rule.json);
  const std::string need = rule.needs;
  const auto json = [&](const char* more) {
    return press_on(kind, R"({"name": "proxy"})",
                    R"(, "fixtures": [)" + std::string(rule.json) + more + "}]");
  };
  if (need.empty() || (need == "colours" && kind.colours) || (need == "image" && kind.image)) {
    const Trace trace = run(json(""));
    EXPECT_GT(trace.proxy_position_m[trace.length() - 1].dot(kind.outwards) - kind.outwards.z() * 0.5, 0.015);
    return;
  }
  // The rule is refused even if it would begin after the end of the run.
  for (const char* more : {"", R"(, "schedule": [[9, 0], [10, 1]])"}) {
    const std::string line = refusal([&] { run(json(more)); });
    EXPECT_HAS(line, "fixtures.0: ");
    EXPECT_HAS(line, need == "colours" ? "the frame has no colours" : "the frame is not an image");
  }
}

TEST_F(FixtureNeeds, EveryFixtureRuleWorksOrIsRefused) {
  const std::vector<std::uint8_t> white(40 * 40, 255);
  const std::string file = folder_.write_png("mask.png", 40, 40, PNG_FORMAT_GRAY, white.data()).string(),
                    mask = R"({"name": "image-mask", "path": ")" + file + "\"";
  const Rule rules[] = {{R"({"name": "everywhere")", ""},
                        {R"({"name": "half-space", "point_m": [-1, 0, 0])", ""},
                        {R"({"name": "near-point", "inner_radius_m": 1)", ""},
                        {R"({"name": "near-point", "row": 20, "column": 20)", "image"},
                        {R"({"name": "hue-range")", "colours"},
                        {mask.c_str(), "image"}};
  for (const FixtureEntry& entry : built_in_catalog().fixtures())
    EXPECT_TRUE(std::any_of(std::begin(rules), std::end(rules), [&](const Rule& rule) {
      return contains(rule.json, "\"" + entry.name + "\"");
    })) << entry.name;
  for (const Rule& rule : rules) {
    for (const Kind& kind : plates()) expect_region_or_refusal(kind, rule);
    for (const Kind& kind : recordings()) expect_region_or_refusal(kind, rule);
  }
}

// --- guidance ---

// The plane of a target faces the sensor. If there is no image, the sensor has to be at the origin, as in a
// recording whose camera was not moved.
TEST_F(FixtureNeeds, GuidanceAcrossAPlaneNeedsToKnowWhereTheSensorIs) {
  const std::string across = R"(, "fixtures": [{"name": "everywhere", "role": "guidance"}],
      "guidance": {"orientation": "plane", "approach_axis": [0, 0, 1], "standoff_m": 0.05})";
  const auto goal_m = [&](const Kind& kind) {
    const Trace trace = run(press_on(kind, R"({"name": "proxy"})", across));
    return trace.guidance_goal_m[trace.length() - 1];
  };
  EXPECT_NEAR(goal_m(pcd(true, false)).z(), 0.45, 1e-6);
  EXPECT_NEAR(goal_m(pcd(false, false)).z(), 0.45, 1e-6);
  Kind moved = pcd(false, false);
  moved.scenario.insert(moved.scenario.size() - 1, R"(, "camera_position_m": [0, 0, 0.1])");
  for (const Kind& kind : {moved, plates()[1]})
    EXPECT_HAS(refusal([&] { goal_m(kind); }),
               "guidance.orientation = \"plane\": needs to know where the sensor is");
}

}  // namespace
}  // namespace remote_touch::fixture_needs_test
