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

// The list of stored baselines, and what it has to hold.

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

  for (const char* text : {"", " ", "text", "{", "{\"complete\": tru", "\x89HDF\r\n\x1a\n"})
    refused(text, "parse error");
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
  const std::string whole = manifest_text([](auto&, auto&) {});
  for (std::size_t size = 0; size < whole.size(); size += 7) refused(whole.substr(0, size), "parse error");
}

TEST(Manifest, RefusesPathsThatCannotBeUsed) {
  const TestFolder folder("baseline_test");
  EXPECT_HAS(refusal([&] { read_manifest(folder.path()); }),
             (folder / "manifest.json").string() +
                 ": cannot be read (No such file or directory): expected a folder of baselines");
  fs::create_directory(folder / "manifest.json");
  EXPECT_HAS(refusal([&] { read_manifest(folder.path()); }), "manifest.json: ");
}

TEST(Manifest, FilesLieBesideIt) {
  EXPECT_EQ(file_of("some/folder", {"lift", "run", "fig4.12"}), fs::path("some/folder/lift.h5"));
  EXPECT_EQ(subject_of("some/folder", {"lift", "run", "fig4.12"}), "fig4.12");
  EXPECT_EQ(subject_of("some/folder", {"lift", "run", "my.json"}), "some/folder/my.json");
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

TEST(MissingBaselines, AreNotReportedIfTheListNeedNotBeComplete) {
  Manifest manifest = with_runs_of({"fig4.11"});
  manifest.complete = false;
  EXPECT_EQ(missing(".", manifest), Names{});
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

class StoredResults : public testing::Test {
 protected:
  // A trace of the recipe, as if it had come out of this configuration.
  StoredResult stored(const Recipe& recipe, const std::string& config) const {
    return stored(provenance(config, recipe, "x86-64"));
  }
  StoredResult stored(const TextAttributes& attributes) const {
    const std::string file = (folder_ / "made.h5").string();
    write_trace(file, awkward_trace(3), attributes, {});
    return StoredResult(file);
  }
  const TestFolder folder_{"stored_result_test"};
};

const Recipe kRun = {"run", "fig4.11", {"seed=3"}};

TEST_F(StoredResults, AreMadeAgainByTheirCommand) {
  const Remaking again = stored(kRun, Experiment::load("fig4.11", {"seed=3"}).to_json()).remaking();
  EXPECT_EQ(again.commands, std::vector<std::string>{"remote-touch run fig4.11 --set seed=3 -o again.h5"});
  EXPECT_EQ(again.reason, "");
}

TEST_F(StoredResults, AreMadeAgainByTheirConfigurationIfTheCommandMakesAnother) {
  const StoredResult result = stored(kRun, Experiment::load("fig4.11", {"seed=4"}).to_json());
  const Remaking again = result.remaking();
  EXPECT_EQ(again.commands,
            (std::vector<std::string>{"remote-touch repro " + result.file() + " --config again.json",
                                      "remote-touch run again.json -o again.h5"}));
  EXPECT_HAS(again.reason, "its command no longer makes this configuration");
}

TEST_F(StoredResults, NeedTheProgramThatKnowsTheirEntries) {
  std::string config = Experiment::load("fig4.11").to_json();
  config.replace(config.find("\"proxy\""), 7, "\"mine\"");
  TextAttributes attributes = provenance(config, kRun, "x86-64");
  attributes.emplace_back("program", "press-lab");
  const Remaking again = stored(attributes).remaking();
  EXPECT_TRUE(again.commands.empty());
  EXPECT_HAS(again.reason, "was made by press-lab");
}

TEST_F(StoredResults, KnowTheirKindAndConfiguration) {
  const std::string config = Experiment::load("fig4.11", {"seed=3"}).to_json();
  const StoredResult result = stored(kRun, config);
  EXPECT_EQ(result.kind(), "trace");
  EXPECT_EQ(result.of("git_commit"), attribute(provenance("", "", ""), "git_commit"));
  EXPECT_EQ(result.experiment().to_json(), config);
}

TEST_F(StoredResults, RefuseOtherFiles) {
  const auto text = folder_.write("text.h5", "text").string();
  EXPECT_HAS(refusal([&] { StoredResult result(text); }), "text.h5");
}

}  // namespace
}  // namespace remote_touch::stored_result_test
