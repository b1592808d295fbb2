// Every renderer on every kind of cloud. Either the run is refused in one line that states what to add, or
// there is a force. There is no third outcome, such as a tool that feels nothing.
#include "runners/experiment/catalog/frame_stream.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "tests/runners/experiment/simulation/cloud_kinds.h"

namespace remote_touch::frame_needs_test {
namespace {

using namespace cloud_kinds;

struct Method {
  std::string renderer, settings = {};  // "" or ", \"key\": ..."
  std::string needs = {};               // "", or a word of the refusal
};

const std::map<FrameNeed, std::string> kWords = {{FrameNeed::view, "view"},
                                                 {FrameNeed::organised, "organised"},
                                                 {FrameNeed::normals, "normals"},
                                                 {FrameNeed::regions, "forbidden regions"}};

// Settings with which a renderer works otherwise, or needs something else.
const Method kVariants[] = {
    {"implicit-surface", R"(, "surface": "surfels")"},  // its outside is where the proxy came from
    {"tool", R"(, "tool_mesh": "ball", "contact_rule": "voxels")", "normals"},  // (6.5) is along the normal
    {"tool", R"(, "tool_mesh": "ball", "contact_rule": "continuous")", "normals"},
    {"tool-penalty", R"(, "tool_mesh": "ball", "force_law": "voxmap")"},  // by the normals of the tool
};

// Every renderer with its defaults, tools as balls, and what its entry says that it needs.
std::vector<Method> methods() {
  std::vector<Method> all(std::begin(kVariants), std::end(kVariants));
  for (const RendererEntry& entry : built_in_catalog().renderers()) {
    const bool is_tool = entry.degrees_of_freedom == DegreesOfFreedom::six;
    all.push_back({entry.name, is_tool ? R"(, "tool_mesh": "ball")" : "",
                   entry.needs.empty() ? "" : kWords.at(entry.needs.front())});
  }
  return all;
}

bool meets(const Kind& kind, const std::string& need) {
  if (need == "organised") return kind.organised;
  if (need == "normals") return kind.normals;
  if (need == "view") return kind.view;
  return need.empty();
}

std::string renderer(const Method& method) {
  return R"({"name": ")" + method.renderer + "\"" + method.settings + "}";
}

// Force along `outwards` at the end of the press. If points only push, a deeper hand has passed them by then,
// and the greatest force of the run is returned.
double felt_N(const Trace& trace, const Kind& kind, const Method& method) {
  if (!contact_model_of(method.renderer).pressed_hip_passes_through)
    return trace.force_N[trace.length() - 1].dot(kind.outwards);
  double greatest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    greatest = std::max(greatest, trace.force_N[i].dot(kind.outwards));
  return greatest;
}

void expect_force_or_refusal(const Kind& kind, const Method& method, const std::string& rest = "") {
  SCOPED_TRACE(kind.scenario + " " + renderer(method) + rest);
  const std::string json = press_on(kind, renderer(method), rest);
  if (meets(kind, method.needs)) {
    EXPECT_GT(felt_N(run(json), kind, method), 0.5);
    return;
  }
  const std::string line = refusal([&] { run(json); });
  EXPECT_HAS(line, method.needs == "view" ? "renderer.view_direction = " : "renderer.name = \"");
  EXPECT_HAS(line, method.needs);
}

class FrameNeeds : public CloudKinds {};

TEST_F(FrameNeeds, EveryRendererFeelsAPlateOrIsRefused) {
  for (const Kind& kind : plates())
    for (const Method& method : methods()) expect_force_or_refusal(kind, method);
}

TEST_F(FrameNeeds, EveryRendererFeelsARecordedCloudOrIsRefused) {
  for (const Kind& kind : recordings())
    for (const Method& method : methods()) expect_force_or_refusal(kind, method);
}

TEST_F(FrameNeeds, ADepthPipelineGivesNormalsToAnImageOnly) {
  Kind image = pcd(true, false);
  image.normals = true;
  for (const Method& method : methods()) expect_force_or_refusal(image, method, R"(, "depth_pipeline": {})");
  EXPECT_HAS(
      refusal([&] { run(press_on(pcd(false, false), R"({"name": "tool"})", R"(, "depth_pipeline": {})")); }),
      "needs normals");
}

TEST_F(FrameNeeds, ATreeOfSpheresFeelsTheRegionsOfEveryCloud) {
  const auto expect_felt = [](const Kind& kind) {
    const Method tree{"sphere-tree", R"(, "tool_mesh": "ball")"};
    expect_force_or_refusal(kind, tree, R"(, "fixtures": [{"name": "everywhere", "radius_m": 0.01}])");
  };
  for (const Kind& kind : plates()) expect_felt(kind);
  for (const Kind& kind : recordings()) expect_felt(kind);
}

TEST_F(FrameNeeds, ARefusalSaysWhatToAdd) {
  const auto line = [](const Kind& kind, const char* name) {
    return refusal([&] { run(press_on(kind, R"({"name": ")" + std::string(name) + "\"}")); });
  };
  EXPECT_EQ(line(pcd(true, false), "tool"),
            "renderer.name = \"tool\": needs normals, and the points of the frames have none: add "
            "depth_pipeline (--set depth_pipeline={})");
  EXPECT_HAS(line(plates()[0], "tool"), "add scenario.normals = true");
  const Kind grid{R"({"name": "flat-grid"})", kDown, Vec3::UnitY()};
  EXPECT_HAS(line(grid, "tool"), "expected a scenario with normals, such as moving-plane");
  EXPECT_HAS(line(grid, "sphere-tree"), "add a fixture rule with radius_m above 0");
  EXPECT_HAS(line(pcd(false, false), "god-object"), "of a PCD file: HEIGHT above 1");
  EXPECT_HAS(
      line(pcd(false, false), "surfels"),
      "renderer.view_direction = [0, -1, 0]: the frames of this recording are not images, so the direction of the sensor must "
      "be given: expected the direction in which it looks, [0, 0, 1]");
}

// Rules that assign no radius make no regions.
TEST_F(FrameNeeds, RulesWithoutARadiusAreNoRegions) {
  for (const char* rules :
       {R"([{"name": "everywhere", "radius_m": 0}])", R"([{"name": "everywhere", "radius_m": -1}])"})
    EXPECT_HAS(refusal([&] {
                 run(press_on(plates()[0], R"({"name": "sphere-tree", "tool_mesh": "ball"})",
                              R"(, "fixtures": )" + std::string(rules)));
               }),
               "needs forbidden regions");
}

TEST_F(FrameNeeds, AGivenViewIsEnough) {
  const Kind cloud = pcd(false, false);
  for (const char* name : {"surfels", "averaged-proxy"}) {
    const Method told{name, R"(, "view_direction": [0, 0.1, 1])"};  // the view is set
    expect_force_or_refusal(cloud, told);
  }
}

TEST_F(FrameNeeds, FaultsAlongAWrongViewAreRefused) {
  const std::string faults = R"(, "faults": {"quantisation_m": 0.001)";
  const Kind cloud = pcd(false, false);
  EXPECT_HAS(refusal([&] { run(press_on(cloud, R"({"name": "proxy"})", faults + "}")); }),
             "faults.view_direction = [0, -1, 0]: the frames of this recording are not images");
  const Method proxy{"proxy"};
  expect_force_or_refusal(cloud, proxy, faults + R"(, "view_direction": [0, 0, 1]})");
  expect_force_or_refusal(cloud, proxy, R"(, "faults": {"dropout_probability": 0.1})");
  expect_force_or_refusal(pcd(true, false), proxy, faults + "}");
}

// --- from frame to frame ---

TEST_F(FrameNeeds, ALaterFrameOfAnotherKindIsRefused) {
  write_pcd("mixed/0.pcd", true, true), write_pcd("mixed/1.pcd", false, false);
  const std::string scenario = R"({"name": "recording", "path": ")" + (folder_ / "mixed").string() + "\"}";
  const Kind mixed{scenario, kForward, -Vec3::UnitZ()};
  EXPECT_HAS(refusal([&] { run(press_on(mixed, R"({"name": "proxy"})")); }),
             "mixed/1.pcd: has points in no order: expected an organised cloud");
  write_pcd("mixed/1.pcd", true, false);
  EXPECT_HAS(refusal([&] {
               run(press_on(mixed, R"({"name": "proxy"})", R"(, "fixtures": [{"name": "hue-range"}])"));
             }),
             "frame 1: fixtures.0: hue-range: the frame has no colours");
  PointCloud unorganised;
  unorganised.append(Vec3::Zero());
  Frame later;
  later.index = 1, later.points = make_search(unorganised);
  EXPECT_HAS(refusal([&] { RendererNeeds("god-object", {FrameNeed::organised}).check(later); }),
             "renderer.name = \"god-object\": needs organised points, and those of frame 1 have no rows");
}

TEST_F(FrameNeeds, APipelineThatLeavesNoNormalIsRefused) {
  EXPECT_HAS(refusal([&] {
               run(press_on(pcd(true, false), R"({"name": "tool", "tool_mesh": "ball"})",
                            R"(, "depth_pipeline": {"normal_radius_m": 0.001})"));
             }),
             "no point of frame 0 has one: expected more points within depth_pipeline.normal_radius_m");
}

TEST_F(FrameNeeds, AFrameWithoutPointsLacksNothing) {
  const RendererNeeds needs("tool", {FrameNeed::normals, FrameNeed::organised});
  Frame frame;
  frame.points = make_search({});
  needs.check(frame);
  PointCloud lost;
  lost.append(Vec3::Constant(std::nan("")), Vec3::Constant(std::nan("")));
  frame.points = make_search(lost);
  RendererNeeds("tool", {FrameNeed::normals}).check(frame);
}

// Every fixture rule on every kind of cloud. Either the run is refused in one line that states what is
// expected, or the rule has its effect. The same holds for guidance.

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
}  // namespace remote_touch::frame_needs_test
