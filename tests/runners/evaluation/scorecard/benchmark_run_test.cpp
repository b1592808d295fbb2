// The scorecard's scenes and methods as they are in data/: each runs with each, over the same noise.
#include "runners/evaluation/scorecard/benchmark.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <functional>
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

std::vector<std::string> names(const auto& list) {
  std::vector<std::string> all;
  for (const auto& each : list) all.push_back(each.name);
  return all;
}

TEST(Benchmark, SectionsOfAMethodComeIntoTheExperiment) {
  const TestFolder folder("benchmark_sections");
  const Method own =
      chosen_methods({folder
                          .write("mine.json", R"({"title": "own", "renderer": {"name": "proxy"},
                                                    "fixtures": [{"name": "everywhere", "radius_m": 0.01}]})")
                          .string()})
          .front();
  EXPECT_EQ(own.name, "mine");
  EXPECT_EQ(own.title, "own");
  const BenchmarkScene scene = chosen_scenes({"slave-organ-50"}).front();
  const Json run = parse_json(scene.sweep(own, 2).experiment(0, 0).to_json(), "run");
  EXPECT_EQ(run["fixtures"][0]["radius_m"], 0.01);
}

BenchmarkScene scene_with(const std::string& rest) {
  return read_benchmark_scene("x", R"({"title": "t", "experiment": {}, )" + rest + "}");
}
BenchmarkScene succeeds_if(const std::string& success) {
  return scene_with(R"("measures": {}, "success": )" + success);
}

TEST(Benchmark, RefusesByName) {
  const TestFolder folder("benchmark_plan_test");
  const std::string mine =
      folder.write("mine.json", R"({"title": "my own", "renderer": {"name": "penalty"}})").string();
  const std::string bounds = R"("bounds": [{"measure": "max_force", "max": 3}])";
  const Method proxy = chosen_methods({"proxy"}).front();
  const BenchmarkScene flat = chosen_scenes({"flat-press"}).front(),
                       slot = chosen_scenes({"tool-slot"}).front(),
                       organ = chosen_scenes({"slave-organ-50"}).front();
  const auto of_experiment = [&](BenchmarkScene scene, const char* experiment) {
    scene.experiment = experiment;
    scene.sweep(proxy, 2);
  };
  const auto own = [&](const std::string& sections) {
    const std::string text = R"({"title": "own", "renderer": {"name": "proxy"}, )" + sections + "}";
    return chosen_methods({folder.write("own.json", text).string()}).front();
  };
  const auto chosen = [](std::vector<std::string> methods, std::vector<std::string> scenes) {
    chosen_benchmark(methods, scenes, 2, "card");
  };
  const std::pair<std::function<void()>, const char*> cases[] = {
      // Names, which come once.
      {[&] {
         chosen_methods({mine, mine});
       },
       "method mine: appears twice"},
      {[&] { chosen_methods({folder.write("a b.json", "{}").string()}); }, "expected letters"},
      {[&] { chosen_methods({folder.write("bad.json", "[").string()}); }, "expected JSON"},
      {[] { chosen_scenes({"none.json"}); }, "none.json: cannot be read"},
      {[] {
         chosen_scenes({"flat-press", "flat-press"});
       },
       "appears twice"},
      // Methods and scenes that do not fit.
      {[&] {
         chosen({"tool-voxels", "proxy"}, {});
       },
       "method proxy: expected only those for tools"},
      {[&] { chosen({"slave-region"}, {"flat-press"}); },
       "scene flat-press: expected only those of teleoperation"},
      {[&] {
         chosen({}, {"flat-press", "tool-slot"});
       },
       "scene tool-slot: expected only"},
      // The card states each method as it is written, so a scene must not replace its tool.
      {[&] { own(R"("slave": {})"); }, "slave: unknown: expected title, renderer, feedback"},
      {[&] {
         slot.sweep(
             read_method("mine", R"({"title": "t", "renderer": {"name": "tool", "tool_mesh": "ball"}})"), 1);
       },
       "method mine: renderer.tool_mesh = \"ball\": scene tool-slot has a tool of its own"},
      {[&] { organ.sweep(own(R"("feedback": {"force": "moon"})"), 2); }, "own.json: feedback.force"},
      {[&] {
         BenchmarkScene felt = organ;
         Json experiment = parse_json(organ.experiment, "scene");
         experiment["feedback"] = {{"force", "none"}};
         felt.experiment = experiment.dump();
         felt.sweep(own(R"("feedback": {"gain": 1})"), 2);
       },
       "method own: feedback: scene slave-organ-50 has its own"},
      {[&] { of_experiment(flat, R"({"renderer": {"name": "proxy"}})"); }, "methods define it"},
      {[&] { of_experiment(flat, R"({"seed": 1})"); }, "experiment.seed"},
      // The mistake in a file.
      {[] { read_method("y", R"({"title": "t"})"); }, "method y: renderer: missing"},
      {[] { read_benchmark_scene("x", "[]"); }, "scene x"},
      {[] { read_benchmark_scene("x", R"({"title": "t", "colour": 1})"); },
       "colour: unknown: expected title, experiment, tool, noise"},
      {[] { read_benchmark_scene("x", R"({"title": "t"})"); }, "experiment: missing"},
      {[] { scene_with(R"("measures": {"force_fraction": "bigger"})"); }, "expected larger, smaller"},
      {[] { succeeds_if(R"({"meaning": "m", "bounds": []})"); }, "bounds"},
      {[] { succeeds_if(R"({"meaning": "m", "bounds": [{"measure": "end_distance", "least": 1}]})"); },
       "least"},
      {[] { succeeds_if(R"({"rule": "kept"})"); }, "expected held"},
      {[] { succeeds_if(R"({"rule": "held", "tolerance_m": 0})"); }, "tolerance_m"},
      {[] { succeeds_if(R"({"rule": "held", "old_bounds": []})"); }, "old_bounds"},
      // A part of the success that has no effect.
      {[&] { succeeds_if(R"({"meaning": "m", )" + bounds + "}"); }, "no InputError"},
      {[&] { succeeds_if(R"({"meaning": "m", "tolerance_m": 0.002, )" + bounds + "}"); },
       "success.tolerance_m: is that of a rule"},
      {[&] { succeeds_if(R"({"rule": "held", "meaning": "m", )" + bounds + "}"); }, "no InputError"},
      {[] { succeeds_if(R"({"rule": "held", "meaning": "m"})"); }, "success.meaning: is that of bounds"},
      // A measure that has its own direction.
      {[] { scene_with(R"("success": {"rule": "held"}, "measures": {"force_noise": "larger"})"); },
       "measures.force_noise = \"larger\": the measure has its own direction (smaller is better): expected judged "
       "or reported"},
      {[] { scene_with(R"("success": {"rule": "held"}, "measures": {"max_force": "judged"})"); },
       "expected larger, smaller"}};
  for (const auto& [call, text] : cases) EXPECT_HAS(refusal(call), text);
}

TEST(Benchmark, AnErrorInAFileBeginsWithItsName) {
  const TestFolder folder("benchmark_file_test");
  const BenchmarkScene stored = chosen_scenes({"flat-press"}).front();
  const Method proxy = chosen_methods({"proxy"}).front();
  const std::string file = (folder / "mine.json").string();
  const auto own_scene = [&](const char* pointer, const Json& value) {
    Json json = {{"title", "t"},
                 {"experiment", Json::parse(stored.experiment)},
                 {"measures", Json::object()},
                 {"success", {{"rule", "held"}}}};
    json[Json::json_pointer(pointer)] = value;
    return chosen_scenes({folder.write("mine.json", json.dump()).string()}).front();
  };
  const auto own_method = [&](const std::string& renderer) {
    const std::string text = R"({"title": "t", "renderer": )" + renderer + "}";
    return chosen_methods({folder.write("mine.json", text).string()}).front();
  };
  const std::string found[] = {
      refusal([&] { chosen_scenes({folder.write("mine.json", R"({"title": "t"})").string()}); }),
      refusal([&] { own_scene("/experiment/scenario/spacing_m", 7).sweep(proxy, 2); }),
      refusal([&] { stored.sweep(own_method(R"({"name": "proxy", "xi": -1})"), 2); }),
      refusal([&] { own_method(R"({"name": "moon"})"), chosen_benchmark({file}, {}, 2, "card"); }),
      refusal([&] {
        own_scene("/tool", {{"tool_mesh", "moon.xyz"}})
            .sweep(read_method("t", R"({"title": "t", "renderer": {"name": "tool"}})"), 2);
      })};
  const char* const beginnings[] = {": scene mine: experiment", ": scenario.spacing_m = 7: expected ",
                                    ": renderer.xi = -1: expected ", ": ", ": renderer.tool_mesh = "};
  for (std::size_t i = 0; i < std::size(found); ++i)
    EXPECT_TRUE(found[i].starts_with(file + beginnings[i])) << found[i];
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
}

// One table defines for each measure whether larger or smaller is better. A scene only states what is judged.
TEST(Benchmark, AMeasureIsJudgedByItsOwnDirection) {
  const auto better = [](const std::string& measures) {
    return scene_with(R"("success": {"rule": "held"}, "measures": )" + measures).measures.front().better;
  };
  EXPECT_EQ(better(R"({"force_noise": "judged"})"), Better::smaller);
  EXPECT_EQ(better(R"({"contact_force_fraction": "judged"})"), Better::larger);
  EXPECT_EQ(better(R"({"force_noise": "smaller"})"), Better::smaller);  // as earlier files have it
  EXPECT_EQ(better(R"({"force_noise": "reported"})"), Better::neither);
  EXPECT_EQ(better(R"({"max_force": "smaller"})"), Better::smaller);  // where nothing should be touched
}

// The one word `held` in a scene means the conditions of a held surface.
TEST(Benchmark, TheRuleHeldIsTheSameForAllScenes) {
  const BenchmarkScene scene = succeeds_if(R"({"rule": "held", "tolerance_m": 0.002,
                       "old_bounds": [{"measure": "end_distance", "min": -0.001}]})");
  ASSERT_EQ(scene.success.size(), 4u);
  EXPECT_EQ(scene.success[0].measure, "max_contact_error");
  EXPECT_EQ(scene.success[0].max, 0.002);
  EXPECT_EQ(scene.success[1].measure, "contact_force_fraction");
  EXPECT_EQ(scene.success[2].measure, "contact_known_fraction");
  EXPECT_HAS(scene.meaning, "never more than 2 mm from it, above or below");
  EXPECT_HAS(scene.meaning, "from 0.1 s after");
  ASSERT_EQ(scene.old_success.size(), 1u);
  EXPECT_EQ(scene.old_success[0].min, -0.001);
  const BenchmarkScene more = succeeds_if(
      R"({"rule": "held", "meaning": "in time", "bounds": [{"measure": "max_force", "max": 3}]})");
  ASSERT_EQ(more.success.size(), 5u);
  EXPECT_EQ(more.success[0].max, kScorecardRadius_m);
  EXPECT_EQ(more.success[3].measure, "max_force");
  EXPECT_HAS(more.meaning, "these ticks; in time");
}

TEST(Benchmark, RunsNoSeedThatParametersWereFixedWith) {
  const Method proxy = chosen_methods({"proxy"}).front();
  for (const BenchmarkScene& scene : chosen_scenes({"flat-press", "camera"})) {
    const Sweep sweep = scene.sweep(proxy, 2);
    for (std::size_t cell = 0; cell < sweep.plan().cell_count(); ++cell)
      EXPECT_GT(sweep.experiment(cell, 1).settings().key.seed, 40u) << scene.name;
  }
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

// --- a scene whose recording has a truth ---

// Two scenes of the same recording. The measured wall is 1.4 mm in front of the true one, and the surface is
// held if the contact point is at most 1 mm from it.
TEST(ScorecardTruth, IsJudgedByTheMeshesOfTheRecordingAndStated) {
  const TestFolder folder("scorecard_truth_test");
  const std::string wall = recorded_wall::write(folder);
  const auto scene = [&](const std::string& name, const std::string& more) {
    return read_benchmark_scene(name, R"({"title": "a wall", "experiment": {"scenario": )" +
                                          recorded_wall::scenario(wall, more) + R"(, "trajectory": )" +
                                          recorded_wall::kPress + R"(, "duration_s": 0.4},
        "measures": {"rms_renderer_error": "reported", "rms_camera_error": "reported"},
        "success": {"rule": "held", "tolerance_m": 0.001}})");
  };
  const BenchmarkPlan plan =
      plan_of({chosen_methods({"god-object"}),
               {scene("by-the-mesh", ""), scene("by-the-camera", R"(, "truth": "measured")")},
               2,
               folder / "card"});
  make_scorecard_folder(plan.benchmark.folder);
  const Kernels& kernels = kernels_for(best_isa());
  do_sweeps(plan.sweeps(), kernels, nullptr, [](auto...) {});
  const ScorecardReport report = evaluate(plan, kernels, nullptr, [](auto...) {});
  const auto& scenes = report.card.scenes;
  EXPECT_EQ(scenes.at(0).success.at(0).noisy.events, 0) << "the camera's error counts";
  EXPECT_EQ(scenes.at(1).success.at(0).noisy.events, scenes.at(1).success.at(0).noisy.runs);
  EXPECT_GT(scenes.at(1).success.at(0).noisy.runs, 0);
  const Json card = parse_json(to_json(report), "scorecard.json");
  EXPECT_EQ(card["scenes"][0]["truth"], "meshes of truth/ (wall), uncertainty 3 mm");
  EXPECT_EQ(card["scenes"][1]["truth"], "the measured surface");
}

}  // namespace
}  // namespace remote_touch::benchmark_run_test
