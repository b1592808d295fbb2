// The scorecard's scenes and methods as they are in data/: each runs with each, over the same noise.
#include "runners/evaluation/scorecard/benchmark.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>
#include <string>

#include "analysis/storage/digest.h"
#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/recording.h"
#include "tests/support/recorded_data.h"
#include "tests/support/recorded_wall.h"
#include "tests/support/test_files.h"
#include "tests/support/test_name.h"

namespace remote_touch::benchmark_run_test {

// gtest prints a scene as its name.
void PrintTo(const BenchmarkScene& scene, std::ostream* out) {
  *out << scene.name;
}

namespace {

// Returns the run with the noise of 0.6 r_c, or with the scene's own noise, cut to four frames.
Experiment beginning(const Sweep& sweep) {
  const std::size_t cell = std::min<std::size_t>(3, sweep.plan().cell_count() - 1);
  Json json = parse_json(sweep.experiment(cell, 1).to_json(), "run");
  json["duration_s"] = 0.11 + json.value("frame_latency_s", 0.0);
  return Experiment::from_json(std::move(json));
}

std::vector<Method> methods_for(const BenchmarkScene& scene) {
  return chosen_benchmark({}, {scene.name}, 2, "card").methods;
}

class Scenes : public testing::TestWithParam<BenchmarkScene> {};

TEST_P(Scenes, RunWithEveryMethodOverTheSameNoise) {
  set_data_folder(data_root().string());
  const BenchmarkScene& scene = GetParam();
  std::vector<std::uint64_t> hashes;
  for (const Method& method : methods_for(scene)) {
    SimulationOptions options;
    options.hash_frames = true;
    Trace trace;
    try {
      trace = simulate(beginning(scene.sweep(method, 2)), options);
    } catch (const MissingInput& missing) {
      GTEST_SKIP() << scene.name << ": " << missing.what();
    }
    EXPECT_GE(trace.length(), 110u) << method.name;
    EXPECT_NE(trace.frame_hash.back(), 0u) << method.name;
    // A forbidden region is a part of the points, and so of their hash.
    if (method.sections.find("fixtures") != std::string::npos) continue;
    if (hashes.empty()) hashes = trace.frame_hash;
    EXPECT_EQ(trace.frame_hash, hashes) << method.name;
  }
}

TEST_P(Scenes, AskOnlyForMeasuresThatThereAre) {
  const Sweep sweep = GetParam().sweep(methods_for(GetParam()).front(), 2);
  const SweepResult plan = sweep.plan();
  for (const Bound& bound : GetParam().success) EXPECT_NO_THROW(plan.measure(bound.measure));
  for (const Bound& bound : GetParam().old_success) EXPECT_NO_THROW(plan.measure(bound.measure));
  EXPECT_NO_THROW(plan.measure("jump_fraction_10"));
  EXPECT_NO_THROW(plan.measure("packet_rate_10"));
  for (const auto& judged : GetParam().measures) EXPECT_NO_THROW(plan.measure(judged.measure));
  const Bound& finite = GetParam().success.back();
  EXPECT_EQ(finite.measure, "non_finite_fraction");
  EXPECT_TRUE(finite.holds(0));
  EXPECT_FALSE(finite.holds(1e-9));
  EXPECT_EQ(plan.cell_count(), GetParam().noise.empty() ? 1u : scorecard_noise_m().size());
  EXPECT_EQ(plan.replicates, GetParam().noise.empty() ? 10 : 2);  // five levels have noise
}

INSTANTIATE_TEST_SUITE_P(OfData, Scenes, testing::ValuesIn(chosen_scenes({})),
                         [](const auto& scene) { return test_name(scene.param.name); });

TEST(Benchmark, NamesAreThoseOfDataAndComeOnce) {
  const auto two = chosen_methods({"tracked-sheet", "proxy"});
  EXPECT_EQ(two[0].name, "tracked-sheet");
  EXPECT_EQ(two[1].name, "proxy");
  const TestFolder folder("benchmark_plan_test");
  const std::string mine =
      folder.write("mine.json", R"({"title": "my own", "renderer": {"name": "penalty"}})").string();
  const auto own = chosen_methods({mine, "proxy"});
  EXPECT_EQ(own.front().name, "mine");
  EXPECT_EQ(own.front().title, "my own");
  EXPECT_HAS(refusal([&] { chosen_methods({mine, mine}); }), "method mine: appears twice");
  EXPECT_HAS(refusal([&] { chosen_methods({folder.write("a b.json", "{}").string()}); }), "expected letters");
  EXPECT_HAS(refusal([&] { chosen_methods({folder.write("bad.json", "[").string()}); }), "expected JSON");
  EXPECT_HAS(refusal([] { chosen_scenes({"none.json"}); }), "none.json: cannot be read");
  EXPECT_HAS(refusal([] { chosen_methods({"nobody"}); }), "method nobody: unknown: expected finger-proxy, ");
  EXPECT_HAS(refusal([] { chosen_scenes({"nowhere"}); }), "scene nowhere: unknown: expected ");
  EXPECT_HAS(refusal([] { chosen_scenes({"flat-press", "flat-press"}); }), "appears twice");
}

std::vector<std::string> names(const auto& list) {
  std::vector<std::string> all;
  for (const auto& each : list) all.push_back(each.name);
  return all;
}

TEST(Benchmark, SectionsOfAMethodComeIntoTheExperiment) {
  const TestFolder folder("benchmark_sections");
  const auto method = [&](const std::string& sections) {
    const std::string text = R"({"title": "own", "renderer": {"name": "proxy"}, )" + sections + "}";
    return chosen_methods({folder.write("own.json", text).string()}).front();
  };
  const BenchmarkScene scene = chosen_scenes({"slave-organ-50"}).front();
  const Method region = method(R"("fixtures": [{"name": "everywhere", "radius_m": 0.01}])");
  const Json run = parse_json(scene.sweep(region, 2).experiment(0, 0).to_json(), "run");
  EXPECT_EQ(run["fixtures"][0]["radius_m"], 0.01);
  EXPECT_HAS(refusal([&] { scene.sweep(method(R"("feedback": {"force": "moon"})"), 2); }),
             "own.json: feedback.force");
  EXPECT_HAS(refusal([&] { method(R"("slave": {})"); }),
             "slave: unknown: expected title, renderer, feedback");
  BenchmarkScene own = scene;
  Json experiment = parse_json(scene.experiment, "scene");
  experiment["feedback"] = {{"force", "none"}};
  own.experiment = experiment.dump();
  EXPECT_HAS(refusal([&] { own.sweep(method(R"("feedback": {"gain": 1})"), 2); }),
             "method own: feedback: scene slave-organ-50 has its own");
}

TEST(Benchmark, ToolsAreComparedWithTools) {
  const auto chosen = [](std::vector<std::string> methods, std::vector<std::string> scenes) {
    return chosen_benchmark(methods, scenes, 2, "card");
  };
  const Benchmark all = chosen({}, {}), tools = chosen({"tool-voxels"}, {}), slot = chosen({}, {"tool-slot"});
  for (const BenchmarkScene& scene : all.scenes) EXPECT_EQ(compared(scene), Compared::hip) << scene.name;
  for (const Method& method : all.methods) EXPECT_EQ(compared(method), Compared::hip) << method.name;
  for (const BenchmarkScene& scene : tools.scenes) EXPECT_EQ(compared(scene), Compared::tools) << scene.name;
  const Benchmark remote = chosen({"slave-region"}, {}), organ = chosen({}, {"slave-organ-50"});
  for (const BenchmarkScene& scene : remote.scenes)
    EXPECT_EQ(compared(scene), Compared::teleoperation) << scene.name;
  EXPECT_EQ(all.scenes.size() + tools.scenes.size() + remote.scenes.size(), chosen_scenes({}).size());
  EXPECT_EQ(all.methods.size() + slot.methods.size() + organ.methods.size(), chosen_methods({}).size());
  EXPECT_GE(tools.scenes.size(), 5u);
  EXPECT_EQ(
      names(slot.methods),
      (std::vector<std::string>{"tool-continuous", "tool-god-object", "tool-inner-spheres", "tool-look-ahead",
                                "tool-penalty", "tool-tracked", "tool-voxels", "tool-voxmap"}));
  EXPECT_HAS(refusal([&] { chosen({"proxy"}, {"tool-slot"}); }),
             "scene tool-slot: expected only those for a HIP");
  EXPECT_HAS(refusal([&] {
               chosen({"tool-voxels", "proxy"}, {});
             }),
             "method proxy: expected only those for tools");
  EXPECT_HAS(refusal([&] { chosen({"slave-region"}, {"flat-press"}); }),
             "scene flat-press: expected only those of teleoperation");
  EXPECT_HAS(refusal([&] { chosen({}, {"flat-press", "tool-slot"}); }), "scene tool-slot: expected only");
}

TEST(Benchmark, NamesWhatIsWrongInAFile) {
  const auto scene = [](const std::string& text) {
    return refusal([&] { read_benchmark_scene("x", text); });
  };
  EXPECT_HAS(scene("[]"), "scene x");
  EXPECT_HAS(scene(R"({"title": "t", "colour": 1})"),
             "colour: unknown: expected title, experiment, tool, noise");
  EXPECT_HAS(scene(R"({"title": "t"})"), "experiment: missing");
  const std::string begin = R"({"title": "t", "experiment": {}, )";
  EXPECT_HAS(scene(begin + R"("measures": {"force_fraction": "bigger"}})"), "expected larger, smaller");
  EXPECT_HAS(scene(begin + R"("measures": {}, "success": {"meaning": "m", "bounds": []}})"), "bounds");
  EXPECT_HAS(
      scene(
          begin +
          R"("measures": {}, "success": {"meaning": "m", "bounds": [{"measure": "end_distance", "least": 1}]}})"),
      "least");
  const Method proxy = chosen_methods({"proxy"}).front();
  BenchmarkScene with_renderer = chosen_scenes({"flat-press"}).front();
  with_renderer.experiment = R"({"renderer": {"name": "proxy"}})";
  EXPECT_HAS(refusal([&] { with_renderer.sweep(proxy, 2); }), "methods define it");
  EXPECT_HAS(refusal([] { read_method("y", R"({"title": "t"})"); }), "method y: renderer: missing");
}

TEST(Benchmark, AnErrorInAFileBeginsWithItsName) {
  const TestFolder folder("benchmark_file_test");
  const std::string scene = (folder / "my-scene.json").string(),
                    method = (folder / "my-method.json").string();
  folder.write("my-scene.json", R"({"title": "t"})");
  EXPECT_TRUE(refusal([&] { chosen_scenes({scene}); }).starts_with(scene + ": scene my-scene: experiment"));
  folder.write("my-method.json", R"({"title": "t", "renderer": {"name": "moon"}})");
  EXPECT_TRUE(refusal([&] { chosen_benchmark({method}, {}, 2, "card"); }).starts_with(method + ": "));

  const Json stored = Json::parse(chosen_scenes({"flat-press"}).front().experiment);
  Json wrong = {
      {"title", "t"}, {"experiment", stored}, {"measures", Json::object()}, {"success", {{"rule", "held"}}}};
  wrong["experiment"]["scenario"]["spacing_m"] = 7;
  folder.write("my-scene.json", wrong.dump());
  folder.write("my-method.json", R"({"title": "t", "renderer": {"name": "proxy", "xi": -1}})");
  const BenchmarkScene own_scene = chosen_scenes({scene}).front(),
                       stored_scene = chosen_scenes({"flat-press"}).front();
  const Method own_method = chosen_methods({method}).front(), proxy = chosen_methods({"proxy"}).front();
  const std::string of_scene = refusal([&] { own_scene.sweep(proxy, 2); });
  EXPECT_TRUE(of_scene.starts_with(scene + ": scenario.spacing_m = 7: expected ")) << of_scene;
  const std::string of_method = refusal([&] { stored_scene.sweep(own_method, 2); });
  EXPECT_TRUE(of_method.starts_with(method + ": renderer.xi = -1: expected ")) << of_method;

  wrong["experiment"] = stored;
  wrong["tool"] = {{"tool_mesh", "moon.xyz"}};
  folder.write("my-scene.json", wrong.dump());
  folder.write("my-method.json", R"({"title": "t", "renderer": {"name": "tool"}})");
  const BenchmarkScene with_tool = chosen_scenes({scene}).front();
  const Method own_tool = chosen_methods({method}).front();
  const std::string of_tool = refusal([&] { with_tool.sweep(own_tool, 2); });
  EXPECT_TRUE(of_tool.starts_with(scene + ": renderer.tool_mesh = ")) << of_tool;
}

// The card states each method as it is written, so a scene must not replace its tool.
TEST(Benchmark, AMethodWithAnotherToolThanTheScenesIsRefused) {
  const BenchmarkScene slot = chosen_scenes({"tool-slot"}).front();
  const auto method = [](const std::string& tool) {
    return read_method("mine",
                       R"({"title": "t", "renderer": {"name": "tool", "tool_mesh": ")" + tool + "\"}}");
  };
  EXPECT_HAS(refusal([&] { slot.sweep(method("ball"), 1); }),
             "method mine: renderer.tool_mesh = \"ball\": scene tool-slot has a tool of its own");
  EXPECT_NO_THROW(slot.sweep(method(parse_json(slot.tool, "tool")["tool_mesh"]), 1));
}

// One table defines for each measure whether larger or smaller is better. A scene only states what is judged.
TEST(Benchmark, AMeasureIsJudgedByItsOwnDirection) {
  const auto scene = [](const std::string& measures) {
    return read_benchmark_scene(
        "x",
        R"({"title": "t", "experiment": {}, "success": {"rule": "held"}, "measures": )" + measures + "}");
  };
  const auto better = [&](const std::string& measures) { return scene(measures).measures.front().better; };
  EXPECT_EQ(better(R"({"force_noise": "judged"})"), Better::smaller);
  EXPECT_EQ(better(R"({"contact_force_fraction": "judged"})"), Better::larger);
  EXPECT_EQ(better(R"({"force_noise": "smaller"})"), Better::smaller);  // as earlier files have it
  EXPECT_EQ(better(R"({"force_noise": "reported"})"), Better::neither);
  EXPECT_EQ(better(R"({"max_force": "smaller"})"), Better::smaller);  // where nothing should be touched
  EXPECT_HAS(refusal([&] { scene(R"({"force_noise": "larger"})"); }),
             "measures.force_noise = \"larger\": the measure has its own direction (smaller is better): "
             "expected judged or reported");
  EXPECT_HAS(refusal([&] { scene(R"({"max_force": "judged"})"); }), "expected larger, smaller");
}

TEST(Benchmark, EveryStoredSceneJudgesByTheTable) {
  for (const BenchmarkScene& scene : chosen_scenes({}))
    for (const BenchmarkScene::Judged& judged : scene.measures)
      if (const Better own = direction_of(directions(), judged.measure);
          own != Better::neither && judged.better != Better::neither) {
        EXPECT_EQ(judged.better, own) << scene.name << ", " << judged.measure;
      }
}

// The one word `held` in a scene means the conditions of a held surface.
TEST(Benchmark, TheRuleHeldIsTheSameForAllScenes) {
  const std::string begin = R"({"title": "t", "experiment": {}, "measures": {}, "success": )";
  const BenchmarkScene scene = read_benchmark_scene("x", begin + R"({"rule": "held", "tolerance_m": 0.002,
                       "old_bounds": [{"measure": "end_distance", "min": -0.001}]}})");
  ASSERT_EQ(scene.success.size(), 4u);
  EXPECT_EQ(scene.success[0].measure, "max_contact_error");
  EXPECT_EQ(scene.success[0].max, 0.002);
  EXPECT_EQ(scene.success[1].measure, "contact_force_fraction");
  EXPECT_EQ(scene.success[2].measure, "contact_known_fraction");
  EXPECT_HAS(scene.meaning, "never more than 2 mm from it, above or below");
  EXPECT_HAS(scene.meaning, "from 0.1 s after");
  ASSERT_EQ(scene.old_success.size(), 1u);
  EXPECT_EQ(scene.old_success[0].min, -0.001);
  const BenchmarkScene more = read_benchmark_scene(
      "x",
      begin + R"({"rule": "held", "meaning": "in time", "bounds": [{"measure": "max_force", "max": 3}]}})");
  ASSERT_EQ(more.success.size(), 5u);
  EXPECT_EQ(more.success[0].max, kScorecardRadius_m);
  EXPECT_EQ(more.success[3].measure, "max_force");
  EXPECT_HAS(more.meaning, "these ticks; in time");
  EXPECT_HAS(refusal([&] { read_benchmark_scene("x", begin + R"({"rule": "kept"}})"); }), "expected held");
  EXPECT_HAS(refusal([&] { read_benchmark_scene("x", begin + R"({"rule": "held", "tolerance_m": 0}})"); }),
             "tolerance_m");
  EXPECT_HAS(refusal([&] { read_benchmark_scene("x", begin + R"({"rule": "held", "old_bounds": []}})"); }),
             "old_bounds");
}

TEST(Benchmark, APartOfTheSuccessThatHasNoEffectIsRefused) {
  const auto refused = [](const std::string& success) {
    return refusal([&] {
      read_benchmark_scene("x",
                           R"({"title": "t", "experiment": {}, "measures": {}, "success": )" + success + "}");
    });
  };
  const std::string bounds = R"("bounds": [{"measure": "max_force", "max": 3}])";
  EXPECT_EQ(refused(R"({"meaning": "m", )" + bounds + "}"), "no InputError");
  EXPECT_HAS(refused(R"({"meaning": "m", "tolerance_m": 0.002, )" + bounds + "}"),
             "success.tolerance_m: is that of a rule");
  EXPECT_EQ(refused(R"({"rule": "held", "meaning": "m", )" + bounds + "}"), "no InputError");
  EXPECT_HAS(refused(R"({"rule": "held", "meaning": "m"})"), "success.meaning: is that of bounds");
}

TEST(Benchmark, RunsNoSeedThatParametersWereFixedWith) {
  const Method proxy = chosen_methods({"proxy"}).front();
  for (const BenchmarkScene& scene : chosen_scenes({"flat-press", "camera"})) {
    const Sweep sweep = scene.sweep(proxy, 2);
    for (std::size_t cell = 0; cell < sweep.plan().cell_count(); ++cell)
      EXPECT_GT(sweep.experiment(cell, 1).settings().key.seed, 40u) << scene.name;
  }
  BenchmarkScene tuned = chosen_scenes({"flat-press"}).front();
  tuned.experiment = R"({"seed": 1})";
  EXPECT_HAS(refusal([&] { tuned.sweep(proxy, 2); }), "experiment.seed");
}

TEST(Benchmark, CostsAreThoseOfTheSamePoints) {
  const BenchmarkScene scene = chosen_scenes({"flat-slide"}).front();
  for (const Method& method : methods_for(scene)) {
    Json json = parse_json(beginning(scene.sweep(method, 2)).to_json(), "run");
    json["duration_s"] = 0.3;
    const Experiment run = Experiment::from_json(std::move(json));
    SimulationOptions made;
    made.generate_all_points = true;
    EXPECT_EQ(digest(simulate(run).columns()), digest(simulate(run, made).columns())) << method.name;
  }
}

TEST(Benchmark, TheAuditsOwnForceLawsAreTheScenesSweeps) {
  const BenchmarkPlan plan =
      plan_of({chosen_methods({"proxy", "penalty"}), chosen_scenes({kPassivityScenes[0]}), 2, "card"});
  std::set<std::string> names;
  for (const BenchmarkSweep& sweep : plan.sweeps())
    EXPECT_TRUE(names.insert(sweep.name).second) << sweep.name;
  EXPECT_EQ(names.size(), plan.laws.size());
}

TEST(Benchmark, TheAuditOfToolsHasTwoScenes) {
  const BenchmarkPlan plan = plan_of({chosen_methods({"tool-voxels", "tool-penalty"}),
                                      chosen_scenes({kPassivityScenes[1], kPassivityScenes[2]}), 2, "card"});
  EXPECT_EQ(plan.laws.size(), 2u);
  ASSERT_EQ(plan.audit.size(), 2u);
  for (const ScenePlan& one : plan.audit) EXPECT_EQ(one.sweeps.size(), 2u);
  EXPECT_EQ(plan.sweeps().size(), 4u);
}

TEST(ForceLaws, AreEachOnceAndWhatTheRendererHas) {
  const auto count = [](const char* name) { return force_laws_of(chosen_methods({name}).front()).size(); };
  EXPECT_EQ(count("proxy"), 9u);  // three signs of the velocity term, without damper and with either sign
  EXPECT_EQ(count("predecessor"), 3u);  // estimates no velocity
  EXPECT_EQ(count("penalty"), 2u);
  EXPECT_EQ(count("god-object"), 1u);
  std::set<std::string> names, renderers;
  for (const Method& method : chosen_benchmark({}, {}, 2, "card").methods)
    for (const Method& law : force_laws_of(method)) {
      EXPECT_TRUE(names.insert(law.name).second) << law.name;
      EXPECT_TRUE(renderers.insert(law.renderer).second) << law.renderer;
    }
}

// Whatever the method's own law is, it and each other one are there once.
TEST(ForceLaws, AreTheSameForMethodsThatDifferInTheirLaw) {
  const Method proxy = chosen_methods({"proxy"}).front();
  for (const char* const own :
       {R"({"velocity_force": "plus"})", R"({"velocity_force": "none", "damping_Ns_per_m": 3})",
        R"({"damping_Ns_per_m": 3, "damping_sign": "minus"})"}) {
    Json renderer = Json::parse(proxy.renderer);
    renderer.update(Json::parse(own));
    const Method changed{"changed", "a changed proxy", renderer.dump()};
    std::set<std::string> names;
    for (const Method& law : force_laws_of(changed)) EXPECT_TRUE(names.insert(law.name).second) << law.name;
    EXPECT_EQ(names.size(), 9u) << own;
  }
}

}  // namespace
}  // namespace remote_touch::benchmark_run_test

// A scene of the scorecard whose recording has a truth: the card judges by it and states it.
namespace remote_touch::scorecard_truth_test {
namespace {

// Two scenes of the same recording. The measured wall is 1.4 mm in front of the true one, and the surface is
// held if the contact point is at most 1 mm from it.
class ScorecardTruth : public testing::Test {
 protected:
  BenchmarkScene scene(const std::string& name, const std::string& more) const {
    return read_benchmark_scene(name, R"({"title": "a wall", "experiment": {"scenario": )" +
                                          recorded_wall::scenario(wall_, more) + R"(, "trajectory": )" +
                                          recorded_wall::kPress + R"(, "duration_s": 0.4},
        "measures": {"rms_renderer_error": "reported", "rms_camera_error": "reported"},
        "success": {"rule": "held", "tolerance_m": 0.001}})");
  }
  ScorecardReport report() const {
    const BenchmarkPlan plan =
        plan_of({chosen_methods({"god-object"}),
                 {scene("by-the-mesh", ""), scene("by-the-camera", R"(, "truth": "measured")")},
                 2,
                 folder_ / "card"});
    make_scorecard_folder(plan.benchmark.folder);
    const Kernels& kernels = kernels_for(best_isa());
    do_sweeps(plan.sweeps(), kernels, nullptr, [](auto...) {});
    return evaluate(plan, kernels, nullptr, [](auto...) {});
  }
  const TestFolder folder_{"scorecard_truth_test"};
  const std::string wall_ = recorded_wall::write(folder_);
};

TEST_F(ScorecardTruth, JudgesByTheMeshesOfTheRecording) {
  const ScorecardReport card = report();
  const auto& scenes = card.card.scenes;
  EXPECT_EQ(scenes.at(0).success.at(0).noisy.events, 0) << "the camera's error counts";
  EXPECT_EQ(scenes.at(1).success.at(0).noisy.events, scenes.at(1).success.at(0).noisy.runs);
  EXPECT_GT(scenes.at(1).success.at(0).noisy.runs, 0);
}

TEST_F(ScorecardTruth, IsStatedBesideEachRecordedScene) {
  const Json card = parse_json(to_json(report()), "scorecard.json");
  EXPECT_EQ(card["scenes"][0]["truth"], "meshes of truth/ (wall), uncertainty 3 mm");
  EXPECT_EQ(card["scenes"][1]["truth"], "the measured surface");
}

}  // namespace
}  // namespace remote_touch::scorecard_truth_test
