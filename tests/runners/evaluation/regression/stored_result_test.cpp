// The list of stored baselines, what it has to hold, and results that only another program can make again.
#include "runners/evaluation/regression/baselines.h"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/storage/result_file.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/provenance.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_result_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using State = BaselineCheck::State;

// --- the list ---

TEST(Manifest, IsReadAsItWasWritten) {
  const TestFolder folder("baseline_test");
  Baseline run{"lift", "run", "fig4.12"};
  run.overrides = {"seed=2", "title=\"two\nlines\""}, run.sha256 = std::string(64, 'a');
  run.revision = {"it's grün: \"\\\" and\ttabs", "force: 3 of 9 rows, up to 2 N"};
  run.history = {{"first", ""}, {"second", "normal: new"}},
  run.builds = {"GNU 12.2.0", "x86-64-v4", "8 threads"};
  run.tolerances = {{"force", {1e-17}}, {"proxy_position", {0.1}}, {"normal", {5e-324}}, {"*", {1e300}}};
  const Manifest written{true, {run, {"map", "sweep", "my map.json"}, {"", "run", ""}}};
  folder.write("manifest.json", text_of(written));
  const Manifest read = read_manifest(folder.path());
  EXPECT_TRUE(read.complete);
  ASSERT_EQ(read.baselines.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Baseline &a = written.baselines[i], &b = read.baselines[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.command, b.command);
    EXPECT_EQ(a.subject, b.subject);
    EXPECT_EQ(a.overrides, b.overrides);
    EXPECT_EQ(a.sha256, b.sha256);
    EXPECT_EQ(a.revision.reason, b.revision.reason);
    EXPECT_EQ(a.revision.moved, b.revision.moved);
    ASSERT_EQ(a.history.size(), b.history.size());
    for (std::size_t k = 0; k < a.history.size(); ++k) {
      EXPECT_EQ(a.history[k].reason, b.history[k].reason);
      EXPECT_EQ(a.history[k].moved, b.history[k].moved);
    }
    EXPECT_EQ(a.builds, b.builds);
    EXPECT_EQ(a.tolerances, b.tolerances);
  }
  ASSERT_NE(read.find("map"), nullptr);
  EXPECT_EQ(read.find("map")->subject, "my map.json");
  EXPECT_EQ(read.find("moon"), nullptr);

  const std::string bytes = bytes_of(folder / "manifest.json");
  folder.write("manifest.json", text_of(read));
  EXPECT_EQ(bytes_of(folder / "manifest.json"), bytes);
  folder.write("manifest.json", text_of(Manifest{}));
  EXPECT_TRUE(read_manifest(folder.path()).baselines.empty());
  EXPECT_FALSE(read_manifest(folder.path()).complete);
}

const char* const kEntry = R"({"name": "a", "command": "run", "subject": "x", "set": [], "sha256": "0",
  "reason": "r", "spread": {"force": 1}, "measured_over": ["GNU"]})";

std::string manifest_text(const std::function<void(ordered_json& whole, ordered_json& entry)>& change) {
  ordered_json whole = {{"complete", false}, {"baselines", {ordered_json::parse(kEntry)}}};
  change(whole, whole["baselines"][0]);
  return whole.dump();
}

TEST(Manifest, DamagedOnesAreRefusedByName) {
  const TestFolder folder("baseline_test");
  const auto refused = [&](const std::string& text, const std::string& part) {
    const std::string file = folder.write("manifest.json", text).string();
    const std::string message = refusal([&] { read_manifest(folder.path()); });
    EXPECT_EQ(message.find(file + ": "), 0u) << text << "\n" << message;
    EXPECT_HAS(message, ": expected ");
    EXPECT_HAS(message, part);
    EXPECT_FALSE(contains(message, "exception")) << message;
  };
  folder.write("manifest.json", manifest_text([](auto&, auto&) {}));
  EXPECT_EQ(read_manifest(folder.path()).baselines.size(), 1u);

  for (const char* text : {"", "{\"complete\": tru", "\x89HDF\r\n\x1a\n"}) refused(text, "parse error");
  refused("{\"complete\": NaN}", "parse error");
  for (const char* text : {"[]", "3", "null", "\"text\"", "[[]]"}) refused(text, "cannot use at()");
  refused("{}", "'complete'");
  refused(std::string(100, '[') + std::string(100, ']'), "nested too deep");
  for (const char* key : {"complete", "baselines"})
    refused(manifest_text([&](auto& whole, auto&) { whole.erase(key); }), std::string("'") + key + "'");
  for (const char* key :
       {"name", "command", "subject", "set", "sha256", "reason", "spread", "measured_over"}) {
    refused(manifest_text([&](auto&, auto& entry) { entry.erase(key); }), std::string("'") + key + "'");
    refused(manifest_text([&](auto&, auto& entry) { entry[key] = nullptr; }), "null");
    refused(manifest_text([&](auto&, auto& entry) { entry[key] = 3; }), "number");
    refused(manifest_text([&](auto&, auto& entry) { entry[key] = {3, 4}; }), "");
  }
  refused(manifest_text([](auto& whole, auto&) { whole["complete"] = "yes"; }), "string");
  refused(manifest_text([](auto& whole, auto&) { whole["baselines"] = {1}; }), "number");
  refused(manifest_text([](auto& whole, auto&) { whole["baselines"] = "all"; }), "string");
  refused(manifest_text([](auto&, auto& entry) { entry["spread"]["force"] = "wide"; }), "string");
  refused(manifest_text([](auto&, auto& entry) { entry["spread"]["force"] = -1; }), "spread");
  for (const char* command : {"", "RUN", "figure", "rm"})
    refused(manifest_text([&](auto&, auto& entry) { entry["command"] = command; }), "run, sweep");
}

// --- baselines that must exist ---

Manifest with_runs_of(const std::vector<std::string>& subjects) {
  Manifest manifest{true};
  for (const std::string& subject : subjects) manifest.baselines.push_back({"of " + subject, "run", subject});
  return manifest;
}

std::vector<std::string> missing(const fs::path& folder, const Manifest& manifest) {
  std::vector<std::string> names;
  for (const BaselineCheck& check : missing_baselines(folder, manifest)) {
    EXPECT_EQ(check.state, State::missing);
    EXPECT_EQ(check.text, "has no baseline");
    EXPECT_FALSE(check.comparison);
    names.push_back(check.name);
  }
  return names;
}

std::vector<std::string> all_experiments() {
  std::vector<std::string> names;
  for (const EmbeddedText& experiment : embedded_experiments()) names.emplace_back(experiment.name);
  return names;
}

using Names = std::vector<std::string>;

const Names kOfFiles = {"scenario live-session", "fixture rule image-mask", "trajectory live-session"};

// Experiments whose scenario is moving-lift or whose trajectory is press.
Names lifts_and_presses() {
  Names names = all_experiments();
  std::erase_if(names, [](const std::string& name) {
    const auto config = ordered_json::parse(Experiment::load(name).to_json());
    return config["scenario"]["name"] != "moving-lift" && config["trajectory"]["name"] != "press";
  });
  return names;
}

// The parts of the catalog that none of these experiments has, in the order of the catalog. What reads a file
// or a session has no stored experiment.
Names parts_without(const Names& names) {
  std::set<std::string> used;
  for (const std::string& name : names) {
    const auto config = ordered_json::parse(Experiment::load(name).to_json());
    for (const char* kind : {"scenario", "renderer", "trajectory"})
      used.insert(std::string(kind) + " " + config[kind]["name"].get<std::string>());
    for (const auto& rule : config["fixtures"])
      used.insert("fixture rule " + rule["name"].get<std::string>());
  }
  Names parts;
  const auto add = [&](const std::string& kind, const auto& entries) {
    for (const auto& entry : entries)
      if (const std::string part = kind + " " + entry.name;
          used.count(part) == 0 && std::ranges::count(kOfFiles, part) == 0)
        parts.push_back(part);
  };
  add("scenario", scenarios()), add("fixture rule", fixtures());
  add("renderer", renderers()), add("trajectory", trajectories());
  return parts;
}
Names without(Names names, const Names& gone) {
  std::erase_if(names, [&](const std::string& name) { return std::ranges::count(gone, name) > 0; });
  return names;
}
Names experiments(const Names& names) {
  Names parts;
  for (const std::string& name : names) parts.push_back("experiment " + name);
  return parts;
}
Names operator+(Names one, const Names& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

TEST(MissingBaselines, EveryPartOfTheListNeedsOne) {
  EXPECT_EQ(missing(".", with_runs_of(all_experiments())), Names{});
  EXPECT_EQ(missing(".", with_runs_of({})), experiments(all_experiments()) + parts_without({}));
  const Names gone = lifts_and_presses() + Names{"fixture-tasks"}, some = without(all_experiments(), gone);
  EXPECT_GE(gone.size(), 3u);
  EXPECT_GE(parts_without(some).size(), 3u);
  EXPECT_EQ(missing(".", with_runs_of(some)),
            experiments(without(all_experiments(), some)) + parts_without(some));
}

// A baseline of an own file or of a sweep covers the parts that it uses. It does not count as an experiment
// of the list.
TEST(MissingBaselines, AnOwnFileOrSweepIsNoExperimentOfTheList) {
  const TestFolder folder("baseline_test");
  folder.write("lift.json", embedded_or_file(embedded_experiments(), "fig4.12", ""));
  const Names lifts = lifts_and_presses(), others = without(all_experiments(), lifts);
  EXPECT_EQ(missing(folder.path(), with_runs_of(others + Names{"lift.json"})),
            experiments(lifts) + parts_without(others + Names{"fig4.12"}));

  Manifest manifest = with_runs_of(others);
  manifest.baselines.push_back({"map", "sweep", "fig4.13"});
  const Names parts = parts_without(others);
  EXPECT_EQ(missing(folder.path(), manifest), experiments(lifts) + parts);

  // A baseline that cannot be read covers no parts. Its own check reports why.
  manifest.baselines.push_back({"gone", "run", "moon.json"});
  manifest.baselines.push_back({"refused", "run", "fig4.12", {"scenario.moon=1"}});
  EXPECT_EQ(missing(folder.path(), manifest), experiments(without(lifts, {"fig4.12"})) + parts);
}

TEST(StoredResults, NeedTheProgramThatKnowsTheirEntries) {
  const TestFolder folder("stored_result_test");
  std::string config = Experiment::load("fig4.11").to_json();
  config.replace(config.find("\"proxy\""), 7, "\"mine\"");
  TextAttributes attributes = provenance(config, Recipe{"run", "fig4.11", {}}, "x86-64");
  attributes.emplace_back("program", "press-lab");
  write_trace(folder / "made.h5", awkward_trace(3), attributes, {});
  const Remaking again = StoredResult((folder / "made.h5").string()).remaking();
  EXPECT_TRUE(again.commands.empty());
  EXPECT_HAS(again.reason, "was made by press-lab");
}

}  // namespace
}  // namespace remote_touch::stored_result_test
