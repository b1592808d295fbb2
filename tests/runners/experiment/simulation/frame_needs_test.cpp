// Every renderer and every fixture rule on every kind of cloud: with or without rows and columns, normals,
// colours, and a camera. Either the run is refused in one line that states what to add, or there is a force.
// There is no third outcome, such as a tool that feels nothing.
#include "runners/experiment/catalog/frame_stream.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/test_files.h"

namespace remote_touch::frame_needs_test {
namespace {

// A flat plate at y = 0, seen from above, whose cloud has what the settings demand.
class Plate final : public Scenario {
 public:
  struct Settings {
    bool organised = false, normals = false, colours = false;
  };
  Plate(const Settings& settings, const NoiseKey&, const Kernels&) : settings_(settings) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int) const override {
    constexpr int kSide = 31;
    PointCloud cloud;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec3 p(0.002 * (i % kSide - kSide / 2), 0, 0.002 * (i / kSide - kSide / 2));
      settings_.normals ? cloud.append(p, Vec3::UnitY()) : cloud.append(p);
      if (settings_.colours) cloud.colour.push_back(0xFF0000);
    }
    if (settings_.organised) cloud.grid_columns = kSide;
    return cloud;
  }
  double signed_distance(const Vec3& p_W, double) const override { return p_W.y(); }

 private:
  const Settings settings_;
};

Parameters parameters(Plate::Settings& s) {
  return {{"organised", &s.organised, 0, 0, "rows and columns"},
          {"normals", &s.normals, 0, 0, "normals"},
          {"colours", &s.colours, 0, 0, "red points"}};
}
std::string validate(const Plate::Settings&) {
  return {};
}

// The properties of a kind of cloud, and the settings that make it.
struct Kind {
  std::string scenario;
  std::string press;  // 1 cm deep
  Vec3 outwards;
  bool organised = false, normals = false, colours = false, image = false;
  bool view = true;  // the setting `view` is right by default
};

const char* const kDown =
    "[[0, 0.05, 0, 0, 0, 0, 0], [0, -0.01, 0, 0, 0, 0, 0.1], [0, -0.01, 0, 0, 0, 0, 0.05]]";
const char* const kForward =
    "[[0, 0, 0.45, 0, 0, 0, 0], [0, 0, 0.51, 0, 0, 0, 0.1], [0, 0, 0.51, 0, 0, 0, 0.05]]";

std::string press_on(const Kind& kind, const std::string& renderer, const std::string& rest = "") {
  return R"({"scenario": )" + kind.scenario + R"(, "renderer": )" + renderer +
         R"(, "trajectory": {"name": "poses", "poses": )" + kind.press + R"(}, "duration_s": 0.15)" + rest +
         "}";
}

Trace run(const std::string& json) {
  return simulate(Experiment::from_json(json, "test"));
}

class FrameNeeds : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Catalog catalog = built_in_catalog();
    catalog.add(scenario_entry<Plate>("plate", "a flat plate at rest"));
    use_catalog(std::move(catalog));
  }
  static void TearDownTestSuite() { use_catalog(built_in_catalog()); }

  // Returns all kinds of clouds without a camera.
  static std::vector<Kind> plates() {
    std::vector<Kind> all;
    const auto word = [](bool is_on) { return std::string(is_on ? "true" : "false"); };
    for (int i = 0; i < 8; ++i) {
      Kind kind{"", kDown, Vec3::UnitY(), (i & 1) != 0, (i & 2) != 0, (i & 4) != 0};
      kind.scenario = R"({"name": "plate", "organised": )" + word(kind.organised) + R"(, "normals": )" +
                      word(kind.normals) + R"(, "colours": )" + word(kind.colours) + "}";
      all.push_back(kind);
    }
    return all;
  }

  // The plane z = 0.5 m, of 40 x 40 points.
  std::string write_pcd(const std::string& name, bool organised, bool colours) const {
    constexpr int kSide = 40;
    const std::string width = std::to_string(organised ? kSide : kSide * kSide),
                      height = std::to_string(organised ? kSide : 1), more = colours ? " " : "";
    std::string text =
        pcd_header("x y z" + more + (colours ? "rgb" : ""), "4 4 4" + more + (colours ? "4" : ""),
                   "F F F" + more + (colours ? "U" : ""), "1 1 1" + more + (colours ? "1" : ""), width,
                   height, std::to_string(kSide * kSide), "ascii");
    for (int i = 0; i < kSide * kSide; ++i)
      text += std::to_string(0.002 * (i % kSide - 19.5)) + " " + std::to_string(0.002 * (i / kSide - 19.5)) +
              " 0.5" + (colours ? " 16711680\n" : "\n");
    return folder_.write(name, text).string();
  }
  Kind pcd(bool organised, bool colours) const {
    const std::string name = std::string(organised ? "rows" : "list") + (colours ? "_red.pcd" : ".pcd"),
                      file = write_pcd(name, organised, colours);
    const std::string scenario = R"({"name": "recording", "path": ")" + file + "\"}";
    return {scenario, kForward, -Vec3::UnitZ(), organised, false, colours, organised, organised};
  }
  // Returns all kinds of clouds.
  std::vector<Kind> clouds() const {
    std::vector<Kind> all = plates();
    for (const bool organised : {false, true})
      for (const bool colours : {false, true}) all.push_back(pcd(organised, colours));
    return all;
  }

  const TestFolder folder_{"frame_needs"};
};

// --- renderers ---

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

TEST_F(FrameNeeds, EveryRendererFeelsACloudOrIsRefused) {
  for (const Kind& kind : clouds())
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
  const Method tree{"sphere-tree", R"(, "tool_mesh": "ball")"};
  for (const Kind& kind : clouds())
    expect_force_or_refusal(kind, tree, R"(, "fixtures": [{"name": "everywhere", "radius_m": 0.01}])");
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
  // Rules that assign no radius make no regions.
  for (const char* radius_m : {"0", "-1"})
    EXPECT_HAS(refusal([&] {
                 run(press_on(
                     plates()[0], R"({"name": "sphere-tree", "tool_mesh": "ball"})",
                     R"(, "fixtures": [{"name": "everywhere", "radius_m": )" + std::string(radius_m) + "}]"));
               }),
               "needs forbidden regions");
  EXPECT_HAS(refusal([&] {
               run(press_on(pcd(true, false), R"({"name": "tool", "tool_mesh": "ball"})",
                            R"(, "depth_pipeline": {"normal_radius_m": 0.001})"));
             }),
             "no point of frame 0 has one: expected more points within depth_pipeline.normal_radius_m");
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

// --- fixture rules: the run is refused in one line that states what is expected, or the rule has its effect
// ---

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

TEST_F(FrameNeeds, EveryFixtureRuleWorksOrIsRefused) {
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
  for (const Rule& rule : rules)
    for (const Kind& kind : clouds()) expect_region_or_refusal(kind, rule);
}

// --- guidance ---

// The plane of a target faces the sensor. If there is no image, the sensor has to be at the origin, as in a
// recording whose camera was not moved.
TEST_F(FrameNeeds, GuidanceAcrossAPlaneNeedsToKnowWhereTheSensorIs) {
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
