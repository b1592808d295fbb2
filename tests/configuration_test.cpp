#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "runners/experiment.h"
#include "runners/json_parameters.h"
#include "tests/test_files.h"

namespace remote_touch {
namespace {

// What a program writes for NaN is null, but a value made in memory can be NaN.
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct RunBlueprint {
  Parameters settings() { return parameters(values); }
  RunSettings values;
};

// Calls visit(label, make) for everything that has parameters; make() gives a new owner of default settings.
template <class Visit>
void for_each_owner(Visit visit) {
  for (const auto& entry : scenarios()) visit(std::string("scenario ") + entry.name, entry.make);
  for (const auto& entry : renderers()) visit(std::string("renderer ") + entry.name, entry.make);
  for (const auto& entry : trajectories()) visit(std::string("trajectory ") + entry.name, entry.make);
  visit(std::string("run"), [] { return std::make_unique<RunBlueprint>(); });
}

template <class Owner>
Json written(Owner& owner) {
  Json json = Json::object();
  write_parameters(owner.settings(), json);
  return json;
}

// The message with which a parameter refuses a value; empty when it takes it.
std::string refused(const Parameter& parameter, const Json& value) {
  try {
    read_parameters({{parameter.name, value}}, {parameter}, "part", false);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

void expect_taken(const Parameter& parameter, const Json& value) {
  EXPECT_EQ(refused(parameter, value), "");
}

void expect_refused(const Parameter& parameter, const Json& value) {
  const std::string message = refused(parameter, value);
  EXPECT_EQ(message, "part." + parameter.name + " = " + value.dump() + ": allowed " + allowed(parameter));
}

bool is_number(const Parameter& p) {
  return std::holds_alternative<double*>(p.value) || std::holds_alternative<int*>(p.value) ||
         std::holds_alternative<std::uint64_t*>(p.value) || std::holds_alternative<Vec3*>(p.value);
}

// --- lists of parameters ---

TEST(Parameters, NamesAreUniqueAndHelpIsOneLine) {
  for_each_owner([](const std::string& label, const auto& make) {
    SCOPED_TRACE(label);
    const auto owner = make();
    std::set<std::string> names;
    for (const Parameter& p : owner->settings()) {
      EXPECT_TRUE(names.insert(p.name).second) << p.name << " is there twice";
      EXPECT_TRUE(std::islower(static_cast<unsigned char>(p.name.front()))) << p.name;
      EXPECT_EQ(p.name.find_first_of(". =\"\n"), std::string::npos) << p.name << " cannot be said with --set";
      EXPECT_FALSE(p.help.empty()) << p.name;
      EXPECT_EQ(p.help.find('\n'), std::string::npos) << p.name;
      EXPECT_NE(p.name, "name") << "is taken by the name of the part";
    }
  });
}

// Pure numbers, counts and places in an image; everything else says its unit.
bool carries_unit(const std::string& name) {
  static const std::set<std::string> kPure = {
      "gamma",       "xi",     "phase_x",     "phase_z",     "steps_per_tick",
      "columns",     "rows",   "rise_frames", "first_frame", "acceleration_frames",
      "last_frame",  "width",  "height",      "row",         "first_column",
      "last_column", "column", "seed",        "cell",        "replicate"};
  static const char* const kUnits[] = {"_m",     "_s",       "_hz",       "_deg",     "_px",
                                       "_per_m", "_N_per_m", "_Ns_per_m", "_m_per_s", "_m_per_s2"};
  return kPure.contains(name) || std::any_of(std::begin(kUnits), std::end(kUnits),
                                             [&](const char* unit) { return name.ends_with(unit); });
}

TEST(Parameters, NumbersCarryTheirUnit) {
  for_each_owner([](const std::string& label, const auto& make) {
    SCOPED_TRACE(label);
    const auto owner = make();
    for (const Parameter& p : owner->settings()) {
      std::vector<std::string> names;
      if (is_number(p)) names = {p.name};
      if (const auto* rows = std::get_if<Rows>(&p.value)) names = rows->columns;
      for (const std::string& name : names) EXPECT_TRUE(carries_unit(name)) << name;
    }
  });
}

TEST(Parameters, DefaultsAreAllowedAndSurviveARoundTrip) {
  for_each_owner([](const std::string& label, const auto& make) {
    SCOPED_TRACE(label);
    const auto owner = make(), again = make();
    const Json defaults = written(*owner);
    EXPECT_EQ(defaults.size(), owner->settings().size());
    ASSERT_NO_THROW(read_parameters(Json::parse(defaults.dump()), again->settings(), "part", false));
    EXPECT_EQ(written(*again), defaults);
  });
}

// Another value than the default, with as many digits as a number can have.
struct Change {
  const Parameter& p;
  double inside(double share) const { return p.low + share * (p.high - p.low); }
  void operator()(double* v) const { *v = inside(0.31415926535897931); }
  void operator()(int* v) const { *v = static_cast<int>(std::floor(inside(0.4))); }
  void operator()(std::uint64_t* v) const { *v = p.high > 1e19 ? 18446744073709551557u : 4294967291u; }
  void operator()(bool* v) const { *v = !*v; }
  void operator()(std::string* v) const { *v = "a \"name\" \\ of one's own: \u00fc"; }
  void operator()(Vec3* v) const { *v = Vec3(inside(0.1), inside(1.0 / 3), inside(0.7)); }
  void operator()(const Choice& c) const { c.set(static_cast<int>(c.names.size()) - 1); }
  void operator()(const Rows& r) const {
    for (std::size_t i = 0; i < 3 * r.columns.size(); ++i)
      r.values->push_back(inside(1 / (3.0 + static_cast<double>(i))));
  }
};

TEST(Parameters, EveryValueSurvivesARoundTrip) {
  for_each_owner([](const std::string& label, const auto& make) {
    SCOPED_TRACE(label);
    const auto owner = make(), again = make();
    for (const Parameter& p : owner->settings()) std::visit(Change{p}, p.value);
    const Json changed = written(*owner);
    const Json defaults = written(*again);
    for (const auto& [name, value] : defaults.items()) EXPECT_NE(changed[name], value) << name;
    ASSERT_NO_THROW(read_parameters(Json::parse(changed.dump()), again->settings(), "part", false));
    EXPECT_EQ(written(*again), changed);
  });
}

// --- what a parameter takes and refuses ---

// For each kind of parameter: both ends of the range, and what lies just outside.
struct Bounds {
  const Parameter& p;
  double below() const { return std::nextafter(p.low, -kInfinity); }
  double above() const { return std::nextafter(p.high, kInfinity); }

  void operator()(double*) const {
    EXPECT_LT(p.low, p.high);
    for (const double v : {p.low, p.high}) expect_taken(p, v);
    for (const double v : {below(), above(), kInfinity, -kInfinity, kNan}) expect_refused(p, v);
  }
  void operator()(int*) const {
    EXPECT_LT(p.low, p.high);
    const auto low = static_cast<std::int64_t>(p.low), high = static_cast<std::int64_t>(p.high);
    for (const std::int64_t v : {low, high}) expect_taken(p, v);
    for (const std::int64_t v : {low - 1, high + 1}) expect_refused(p, v);
    for (const double v : {p.low + 0.5, below(), above(), 1e300, kNan}) expect_refused(p, v);
  }
  void operator()(std::uint64_t*) const {
    expect_taken(p, 0u);
    expect_taken(
        p, p.high > 1e19 ? std::numeric_limits<std::uint64_t>::max() : static_cast<std::uint64_t>(p.high));
    expect_refused(p, -1);
    expect_refused(p, 0.5);
    expect_refused(p, above());
    if (p.high < 1e19) expect_refused(p, static_cast<std::uint64_t>(p.high) + 1);
  }
  void operator()(bool*) const { expect_taken(p, true), expect_taken(p, false); }
  void operator()(std::string*) const { expect_taken(p, ""), expect_taken(p, "a/b c"); }
  void operator()(Vec3*) const {
    EXPECT_LT(p.low, p.high);
    expect_taken(p, {p.low, 0, p.high});
    for (const double v : {below(), above(), kInfinity, kNan}) {
      expect_refused(p, {v, 0, 0});
      expect_refused(p, {0, 0, v});
    }
    expect_refused(p, {0, 0});
    expect_refused(p, {0, 0, 0, 0});
    expect_refused(p, {0, "0", 0});
  }
  void operator()(const Choice& choice) const {
    for (const std::string& name : choice.names) expect_taken(p, name);
    for (const std::string name : {"", "no such name"}) expect_refused(p, name);
    expect_refused(p, choice.names.front() + " ");
  }
  void operator()(const Rows& rows) const {
    const Json row(std::vector<double>(rows.columns.size(), p.high));
    Json long_row = row, high_row = row, text_row = row;
    long_row.push_back(0), high_row.back() = above(), text_row.back() = "0";
    expect_taken(p, Json::array());
    expect_taken(p, Json::array({row, row}));
    expect_refused(p, row);
    for (const Json& wrong : {long_row, high_row, text_row, Json::array(), Json(3)})
      expect_refused(p, Json::array({row, wrong}));
  }
};

TEST(Parameters, TakeTheEndsOfTheRangeAndRefuseJustOutside) {
  for_each_owner([](const std::string& label, const auto& make) {
    const auto owner = make();
    for (const Parameter& p : owner->settings()) {
      SCOPED_TRACE(label + "." + p.name);
      std::visit(Bounds{p}, p.value);
    }
  });
}

TEST(Parameters, RefuseEveryOtherKind) {
  for_each_owner([](const std::string& label, const auto& make) {
    const auto owner = make();
    for (const Parameter& p : owner->settings()) {
      SCOPED_TRACE(label + "." + p.name);
      const bool vector = std::holds_alternative<Vec3*>(p.value);
      const bool text = std::holds_alternative<std::string*>(p.value);
      expect_refused(p, nullptr);
      expect_refused(p, Json::object());
      expect_refused(p, Json::array({Json::object()}));
      if (!std::holds_alternative<bool*>(p.value)) expect_refused(p, true);
      if (!text) expect_refused(p, "1");
      if (!is_number(p) || vector) expect_refused(p, 1);
      if (!std::holds_alternative<Rows>(p.value)) expect_refused(p, Json::array());
    }
  });
}

TEST(Parameters, AWholeNumberMayBeWrittenWithAPoint) {
  int count = 0;
  const Parameters list = {{"count", &count, 0, 10, "a count"}};
  read_parameters(Json::parse(R"({"count": 3.0})"), list, "part", false);
  EXPECT_EQ(count, 3);
}

TEST(Parameters, TheMessageIsThatOfTheManual) {
  EXPECT_EQ(refusal([] { Experiment::load("fig4.11", {"renderer.stiffness_N_per_m=-3"}); }),
            "renderer.stiffness_N_per_m = -3: allowed 0 to 10000");
  EXPECT_EQ(refusal([] { Experiment::load("fig4.11", {"haptic_rate_hz=fast"}); }),
            "haptic_rate_hz = \"fast\": allowed 100 to 10000");
}

TEST(Parameters, ALongValueIsShortenedInTheMessage) {
  int count = 0;
  const Parameter p{"count", &count, 0, 10, "a count"};
  const std::string message = refused(p, std::string(5000, 'x'));
  EXPECT_LT(message.size(), 300u);
  EXPECT_HAS(message, "part.count = \"xxx");
  EXPECT_HAS(message, "...: allowed whole numbers 0 to 10");
}

TEST(Parameters, AnUnknownKeyIsRefusedWithTheNearest) {
  const auto nearest = [](const std::string& assignment) {
    return refusal([&] { Experiment::load("fig4.11", {assignment}); });
  };
  EXPECT_EQ(nearest("renderer.stiffnes=3"),
            "renderer.stiffnes: unknown; the nearest allowed is renderer.stiffness_N_per_m");
  EXPECT_HAS(nearest("renderer.stifness_N_per_m=3"), "renderer.stiffness_N_per_m");
  EXPECT_HAS(nearest("renderer.r1=3"), "allowed is renderer.r1_m");
  EXPECT_HAS(nearest("scenario.colums=3"), "allowed is scenario.columns");
  EXPECT_HAS(nearest("trajectory.waypoint=3"), "allowed is trajectory.waypoints");
  EXPECT_HAS(nearest("duration=3"), "duration: unknown; the nearest allowed is duration_s");
  EXPECT_HAS(nearest("sede=3"), "allowed is seed");
}

TEST(Parameters, DefaultsFitTogether) {
  const auto expect_no_contradiction = [](const auto& entries) {
    for (const auto& entry : entries)  // a recording has no default path
      EXPECT_EQ(entry.make()->contradiction().empty(), entry.name != std::string("recording")) << entry.name;
  };
  expect_no_contradiction(scenarios()), expect_no_contradiction(renderers()),
      expect_no_contradiction(trajectories());
}

// --- experiments ---

TEST(Experiments, AllFilesAreStored) {
  const std::filesystem::path folder = std::filesystem::path(REMOTE_TOUCH_SOURCE_DIR) / "data/experiments";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    ++files;
    const auto stored = std::find_if(
        stored_experiments().begin(), stored_experiments().end(),
        [&](const StoredExperiment& s) { return entry.path().filename() == std::string(s.name) + ".json"; });
    ASSERT_NE(stored, stored_experiments().end()) << entry.path();
    EXPECT_EQ(stored->json, bytes_of(entry.path()));
  }
  EXPECT_EQ(stored_experiments().size(), files);
}

TEST(Experiments, SurviveARoundTrip) {
  for (const StoredExperiment& stored : stored_experiments()) {
    SCOPED_TRACE(stored.name);
    const Experiment experiment = Experiment::load(stored.name);
    const std::string text = experiment.to_json();
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(Experiment::from_json(text, "again").to_json(), text);
    EXPECT_FALSE(experiment.settings().title.empty());

    // What the file says is in the resolved configuration.
    const Json file = Json::parse(stored.json), resolved = Json::parse(text);
    for (const auto& [key, value] : file.items()) {
      if (!value.is_object()) {
        EXPECT_EQ(resolved[key], value) << key;
        continue;
      }
      for (const auto& [name, number] : value.items())
        EXPECT_EQ(resolved[key][name], number) << key << "." << name;
    }
  }
}

// The resolved configuration has every parameter of the run and of its parts.
TEST(Experiments, AreResolvedCompletely) {
  const Json json = Json::parse(Experiment::load("fig4.11").to_json());
  RunBlueprint run;
  EXPECT_EQ(json.size(), run.settings().size() + 3);
  const auto expect_all = [&](const char* part, auto entries) {
    const auto blueprint = find_entry(entries, json[part]["name"].template get<std::string>(), part).make();
    EXPECT_EQ(json[part].size(), blueprint->settings().size() + 1) << part;
    for (const Parameter& p : blueprint->settings()) EXPECT_TRUE(json[part].contains(p.name)) << p.name;
  };
  expect_all("scenario", scenarios()), expect_all("renderer", renderers()),
      expect_all("trajectory", trajectories());
}

constexpr const char* kSmall = R"({"seed": 5, "scenario": {"name": "flat-grid", "columns": 7},
    "renderer": {"name": "proxy", "xi": 0.25}, "trajectory": {"name": "waypoints"}})";

Json resolved(const std::vector<std::string>& overrides) {
  return Json::parse(Experiment::from_json(kSmall, "small", overrides).to_json());
}

TEST(Experiments, DefaultsThenFileThenOverrides) {
  const Json plain = resolved({});
  EXPECT_EQ(plain["seed"], 5);
  EXPECT_EQ(plain["scenario"]["columns"], 7);
  EXPECT_EQ(plain["scenario"]["rows"], 100);
  const Json changed = resolved({"scenario.columns=8", "scenario.rows=9", "seed=6"});
  EXPECT_EQ(changed["seed"], 6);
  EXPECT_EQ(changed["scenario"]["columns"], 8);
  EXPECT_EQ(changed["scenario"]["rows"], 9);
  EXPECT_EQ(changed["renderer"], plain["renderer"]);
}

TEST(Experiments, TheLastOverrideCounts) {
  EXPECT_EQ(resolved({"seed=6", "seed=7"})["seed"], 7);
  EXPECT_EQ(resolved({"seed=-1", "seed=7"})["seed"], 7);
  // A whole part, then one of its parameters.
  const Json json =
      resolved({R"(renderer={"name": "proxy", "gamma": 0.5})", "renderer.steps_per_tick=3"})["renderer"];
  EXPECT_EQ(json["gamma"], 0.5);
  EXPECT_EQ(json["steps_per_tick"], 3);
  EXPECT_EQ(json["xi"], resolved({R"(renderer={"name": "proxy"})"})["renderer"]["xi"]);
}

TEST(Experiments, OverridesAreJsonOrPlainText) {
  EXPECT_EQ(resolved({"title=a plain text = with more"})["title"], "a plain text = with more");
  EXPECT_EQ(resolved({"title=\"3\""})["title"], "3");
  EXPECT_EQ(resolved({"title="})["title"], "");
  EXPECT_EQ(resolved({"renderer.step_rule=fixed"})["renderer"]["step_rule"], "fixed");
  EXPECT_EQ(resolved({"trajectory.waypoints=[[0,0.01,0,0],[0.1,0.01,0,1e-2]]"})["trajectory"]["waypoints"],
            Json::parse("[[0.0, 0.01, 0.0, 0.0], [0.1, 0.01, 0.0, 0.01]]"));
}

TEST(Experiments, RefuseOverridesThatAreNone) {
  const auto why = [](const std::string& assignment) { return refusal([&] { resolved({assignment}); }); };
  EXPECT_HAS(why("seed"), "--set seed: allowed key=value");
  EXPECT_HAS(why("=3"), "--set =3: allowed key=value");
  EXPECT_HAS(why("seed.x=3"), "--set seed.x=3: the path leads through a value");
  EXPECT_HAS(why("scenario=3"), "scenario");
  EXPECT_HAS(why("renderer.=3"), "renderer");
  EXPECT_HAS(why("title=\xff"), "title");
  EXPECT_HAS(why("renderer.xi=" + std::string(1000, '[')), "renderer.xi");
  EXPECT_HAS(why("renderer.xi=" + std::string(1000, '[') + std::string(1000, ']')), "renderer.xi");
}

TEST(Experiments, RefuseSettingsThatContradictEachOther) {
  const auto why = [](const std::string& assignment) { return refusal([&] { resolved({assignment}); }); };
  EXPECT_HAS(why("renderer.r1_m=0.006"), "renderer.r1_m = 0.006: allowed below r2_m = 0.00501");
  EXPECT_HAS(why("renderer.r3_m=0.005"), "renderer.r2_m = 0.00501: allowed below r3_m = 0.005");
  EXPECT_HAS(why("trajectory.waypoints=[]"), "trajectory.waypoints = []");
  EXPECT_HAS(why("trajectory.waypoints=[[0,0,0,-1]]"), "trajectory.waypoints");
  EXPECT_HAS(why(R"(scenario={"name":"recording"})"), "scenario.path");
}

TEST(Experiments, RefuseTextThatIsNoExperiment) {
  const auto why = [](const std::string& text) {
    return refusal([&] { Experiment::from_json(text, "file.json"); });
  };
  for (const char* text : {"", "{", "[", "{\"seed\": NaN}", "{\"seed\": 1e999}", "nonsense", "{} {}", "\xff"})
    EXPECT_HAS(why(text), "file.json: ") << text;
  for (const char* text : {"[]", "3", "null", "\"text\""})
    EXPECT_HAS(why(text), "file.json: not an object") << text;
  EXPECT_HAS(why(std::string(100000, '[')), "file.json: nested too deep");
  EXPECT_HAS(why("{}"), "scenario: missing");
  EXPECT_HAS(why(R"({"scenario": {"columns": 3}})"), "scenario: missing");
  EXPECT_HAS(why(R"({"scenario": {"name": "moon"}})"), "scenario.name = \"moon\": allowed flat-grid, ");
  EXPECT_HAS(why(R"({"scenario": {"name": "flat-grid"}})"), "renderer: missing");
  EXPECT_HAS(why(R"({"scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"}})"),
             "trajectory: missing");
}

TEST(Experiments, AreLoadedByNameOrFile) {
  const TestFolder folder("configuration_test");
  const std::string file = folder.write("small.json", kSmall).string();
  EXPECT_EQ(Experiment::load(file).to_json(), Experiment::from_json(kSmall, "small").to_json());
  EXPECT_EQ(Experiment::load(file, {"seed=9"}).settings().key.seed, 9u);
  const std::string missing = (folder / "missing.json").string();
  EXPECT_HAS(refusal([&] { Experiment::load(missing); }), missing + ": ");
  EXPECT_HAS(refusal([&] { Experiment::load(folder.path().string()); }), folder.path().string() + ": ");
  EXPECT_HAS(refusal([&] { Experiment::load(folder.write("cut.json", "{\"see").string()); }), "cut.json: ");
}

TEST(Experiments, TellNumbersOfTheirRenderer) {
  const Experiment experiment = Experiment::from_json(kSmall, "small", {"renderer.r1_m=0.004"});
  EXPECT_EQ(experiment.renderer_number("r1_m"), 0.004);
  EXPECT_HAS(refusal([&] { (void)experiment.renderer_number("step_rule"); }), "renderer.step_rule");
  EXPECT_HAS(refusal([&] { (void)experiment.renderer_number("moon"); }), "renderer.moon");
}

}  // namespace
}  // namespace remote_touch
