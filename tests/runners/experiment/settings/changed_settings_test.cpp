// Settings as JSON: changes that --set and the like make, differences between configurations, numbers of the
// second implementation, and the folder of the cache.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/settings/cache_file.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "tests/support/test_files.h"

namespace remote_touch::changed_settings_test {
namespace {

// --- numbers of the second implementation ---

// Read without second_number(). A loop over a part of a table that no longer exists would read wrong values,
// or none.
TEST(SecondImplementation, GivesTheNumbersOfItsTables) {
  std::ifstream file(REMOTE_TOUCH_SOURCE_DIR "/data/second_implementation/chapter_4.json");
  const nlohmann::json table = nlohmann::json::parse(file), rows = table["map"]["regions"];
  EXPECT_EQ(second_number("chapter_4", "/lifts/noisy/survived"),
            table["lifts"]["noisy"]["survived"].get<double>());
  ASSERT_GT(rows.size(), 20U);
  for (const auto& [name, value] : rows[0].items()) {
    if (!value.is_number()) continue;
    const std::vector<double> column = second_column("chapter_4", "/map/regions", name);
    ASSERT_EQ(column.size(), rows.size()) << name;
    for (std::size_t i = 0; i < rows.size(); ++i)
      EXPECT_EQ(column[i], rows[i][name].get<double>()) << name << " " << i;
  }
}

// A number of a claim comes from the program itself, whatever files there are.
TEST(SecondImplementation, RefusesWhatIsNotThere) {
  const char* const file = REMOTE_TOUCH_SOURCE_DIR "/data/second_implementation/chapter_4.json";
  EXPECT_THROW(second_number(file, "/lifts/noisy/survived"), InputError);
  EXPECT_THROW(second_number("chapter_0", "/lifts"), InputError);
  EXPECT_THROW(second_number("chapter_4", "/lifts/nothing"), std::exception);
  EXPECT_THROW(second_column("chapter_4", "/map/regions", "nothing"), std::exception);
}

// --- changes: refused, named, and stated in the title ---

using Texts = std::vector<std::string>;

constexpr const char* kScene = R"(scenario={"name": "flat-grid", "columns": 30})";
const std::string kNone = "no InputError";

TEST(DiscardedSettings, AreRefusedWithBothPaths) {
  const struct {
    Texts assignments;
    std::string expected;
  } rows[] = {{{"scenario.noise_sigma_m=0.01", kScene},
               "--set scenario.noise_sigma_m=0.01: is overwritten by --set scenario: expected one of them"},
              {{"scenario.columns=40", kScene}, "--set scenario.columns=40: is overwritten by "},
              {{"seed=3", "faults.dropout_probability=0.5", "faults=null"},
               "--set faults.dropout_probability=0.5: is overwritten by --set faults: "},
              {{"fixtures.0.radius_m=0.1", "fixtures=[]"},
               "--set fixtures.0.radius_m=0.1: is overwritten by --set fixtures: "},
              {{"set.seed=1", "set={}"}, "--set set.seed=1: is overwritten by --set set: "},
              {{"trajectory.start_m.01=1", "trajectory.start_m=[0, 2, 0]"}, "is overwritten by "},
              // The later one keeps the value.
              {{"scenario.columns=30", kScene}, kNone},
              {{"trajectory.start_m.1=2", "trajectory.start_m=[0, 2, 0]"}, kNone},
              {{kScene, "scenario.noise_sigma_m=0.01"}, kNone},
              {{"scenario.columns=30", "scenario_.x={}", "scenario.rows=4"}, kNone},
              {{"seed=1", "seed=2"}, kNone}};  // named, see below
  for (const auto& row : rows) EXPECT_HAS(refusal([&] { refuse_discarded(row.assignments); }), row.expected);
}

TEST(ReplacedSettings, AreNamedInALineEach) {
  EXPECT_EQ(replaced_settings({"seed=1", "duration_s=2", "seed=2"}),
            (Texts{"--set seed=1 is replaced by --set seed=2"}));
  EXPECT_EQ(replaced_settings({kScene, "scenario.columns=40"}),
            (Texts{R"(--set scenario={"name":"flat-grid","columns":30} is replaced in part by --set )"
                   "scenario.columns=40"}));
  EXPECT_EQ(replaced_settings({"a.01=1", "a.1=2"}), (Texts{"--set a.01=1 is replaced by --set a.1=2"}));
  EXPECT_EQ(replaced_settings({"seed=1", "seed=2", "seed=3"}).size(), 2u);
  EXPECT_TRUE(replaced_settings({"seed=1", "seed=1", kScene, "scenario.rows=3", "seeds=4"}).empty());
}

std::string titled(const char* configuration, const Texts& assignments) {
  Json json = Json::parse(configuration);
  apply_overrides(json, assignments);
  return json.value("title", std::string("none"));
}

// The titles of the user are kept. No value is longer than 40 characters.
TEST(Titles, NameWhatWasChanged) {
  constexpr const char *kLift = R"({"title": "a lift", "seed": 1, "scenario": {"noise_sigma_m": 0.006}})",
                       *kShort = R"({"title": "a"})";
  const std::string list = Json(std::vector<int>(100, 7)).dump();
  const struct {
    const char* configuration;
    Texts assignments;
    std::string title;
  } rows[] = {
      {kLift,
       {"scenario.noise_sigma_m=0", "scenario.path=my/hand"},
       "a lift, changed: scenario.noise_sigma_m=0, scenario.path=my/hand"},
      {kLift, {}, "a lift"},
      {kLift, {"seed=1", "scenario.noise_sigma_m=6e-3"}, "a lift"},  // the values do not change
      {kLift, {"seed=2", "seed=3"}, "a lift, changed: seed=3"},
      {R"({"title": "a lift, changed: seed=3"})", {"duration_s=2"}, "a lift, changed: seed=3, duration_s=2"},
      {kLift, {"seed=2", "title=mine"}, "mine"},
      {R"({"title": ""})", {"seed=2"}, ""},
      {"{}", {"seed=2"}, "none"},
      {kShort,
       {"scenario.path=" + std::string(300, 'x') + "/sr305_hand_flex"},
       "a, changed: scenario.path=..." + std::string(24, 'x') + "/sr305_hand_flex"},
      {kShort, {"w=" + list}, "a, changed: w=" + list.substr(0, 40) + "..."}};
  for (const auto& row : rows) EXPECT_EQ(titled(row.configuration, row.assignments), row.title);
}

// A title has at most 120 characters of changes, then the count of the others.
TEST(Titles, HaveALimitedLength) {
  Texts many;
  for (int i = 0; i < 100; ++i)
    many.push_back("scenario.parameter_" + std::to_string(i) + "=" + std::to_string(i));
  const std::string title = titled(R"({"title": "a lift"})", many);
  EXPECT_HAS(title, "a lift, changed: scenario.parameter_0=0, scenario.parameter_1=1, ");
  EXPECT_HAS(title, " more");
  EXPECT_LE(title.size(), std::string("a lift, changed:  and 100 more").size() + 120);
}

// A character of several bytes is kept whole, or is left out.
TEST(Titles, AreUtf8) {
  for (std::size_t more = 0; more < 4; ++more) {
    std::string path = std::string(more, 'x');
    for (int i = 0; i < 30; ++i) path += "ü€";
    const std::string title = changed_title("a", {{"scenario.path", path}, {"list", Json::array({path})}});
    EXPECT_NO_THROW(static_cast<void>(Json(title).dump())) << more;  // throws for what is not UTF-8
  }
}

// --- differences between configurations: by path, without titles ---

// A title describes a configuration and does not change what it does. The limit of 57 bytes is in the middle
// of the 28th of these characters, behind a quotation mark and a letter. Long values that differ only after
// their beginning are shown from shortly before the difference on.
TEST(ConfigurationDifferences, AreOneTextEach) {
  const std::string folder(100, 'a'), tail(20, 'a');
  std::string umlauts,
      axes = R"({"axes": [{"from": 0, "parameter": "scenario.acceleration_m_per_s2", "to": )";
  for (int i = 0; i < 40; ++i) umlauts += "\xc3\xa4";
  const struct {
    std::string before, after;
    Texts found;
  } rows[] = {
      {R"({"seed": 1, "renderer": {"r1_m": 1}})",
       R"({"renderer": {"r1_m": 2}})",
       {"seed 1 against absent", "renderer.r1_m 1 against 2"}},
      {R"({"title": "a", "experiment": {"title": "c", "seed": 1}})",
       R"({"title": "b", "experiment": {"title": "d", "seed": 1}})",
       {}},
      {R"({"scenario": {"title": "a"}})",
       R"({"scenario": {"title": "b"}})",
       {R"(scenario.title "a" against "b")"}},
      {R"({"path": "x)" + umlauts + R"("})",
       R"({"path": 1})",
       {"path \"x" + umlauts.substr(0, 54) + "... against 1"}},
      {R"({"path": ")" + folder + R"(/one"})",
       R"({"path": ")" + folder + R"("})",
       {"path \"..." + tail + "/one\" against \"..." + tail + "\""}},
      {axes + "1, \"count\": 3}]}",
       axes + "2, \"count\": 3}]}",
       {"axes [...tion_m_per_s2\",\"to\":1,\"count\":3}] against [...tion_m_per_s2\",\"to\":2,\"count\":3}]"}}};
  for (const auto& row : rows) EXPECT_EQ(configuration_differences(row.before, row.after), row.found);
}

// --- settings from the command line ---

Json with(const std::string& json, const std::string& assignment) {
  Json configuration = Json::parse(json);
  apply_override(configuration, assignment);
  return configuration;
}

std::string refused(const std::string& json, const std::string& assignment) {
  return refusal([&] { with(json, assignment); });
}

// Numbers are taken as they are typed.
TEST(ApplyOverride, SetsWhatAPathLeadsTo) {
  const std::array<const char*, 3> rows[] = {
      {R"({"a": 1})", "b.c=[2]", R"({"a":1,"b":{"c":[2]}})"},
      {R"({"a": [{"b": 1}]})", "a.0.b=quick", R"({"a":[{"b":"quick"}]})"},
      {R"({"a": null})", "a.b=1", R"({"a":{"b":1}})"},
      {"{}", "title=grün", R"({"title":"grün"})"},
      {"{}", "a=.3", R"({"a":0.3})"},
      {"{}", "a=-.25", R"({"a":-0.25})"},
      {"{}", "a=3.", R"({"a":3.0})"},
      {"{}", "a=1e-3", R"({"a":0.001})"}};
  for (const auto& [before, assignment, after] : rows) EXPECT_EQ(with(before, assignment).dump(), after);
  for (const char* text : {"01", "..", ".", "./a.h5", "x.", ".3s", "-."})
    EXPECT_EQ(with("{}", std::string("a=") + text)["a"], text);
}

// Printing or destroying a value makes one call for each level. 60000 levels exhausted the stack.
TEST(ApplyOverride, APathOfMoreThan64LevelsIsRefused) {
  const auto path = [](int levels) {
    std::string keys = "title";
    for (int i = 1; i < levels; ++i) keys += ".a";
    return keys + "=1";
  };
  EXPECT_EQ(refused(R"({"title": null})", path(64)), "no InputError");
  EXPECT_HAS(refused(R"({"title": null})", path(65)), "expected at most 64 levels");
  EXPECT_HAS(refused(R"({"title": null})", path(60000)), "expected at most 64 levels");
}

TEST(ApplyOverride, ATextThatIsNotUtf8IsRefused) {
  for (const char* assignment : {"title=\xff", "ti\xfftle=1", "scenario.name.\xff=1", "a=\"\xff\""})
    EXPECT_HAS(refused("{}", assignment), "expected UTF-8") << assignment;
}

TEST(ReadParameters, ATextHasNoZeroInIt) {
  std::string title;
  const auto read = [&](const char* json) {
    return refusal([&] { read_parameters(Json::parse(json), {{"title", &title, 0, 0, ""}}, ""); });
  };
  EXPECT_HAS(read(R"({"title": "a\u0000b"})"), R"(title = "a\u0000b": expected UTF-8 text)");
  EXPECT_EQ(read(R"({"title": "a b"})"), "no InputError");
  EXPECT_EQ(title, "a b");
}

TEST(ReadParameters, AnIntegerMadeInMemoryMayBeSigned) {
  std::uint64_t seed = 0;
  const auto read = [&](int value) {
    return refusal([&] { read_parameters({{"seed", value}}, {{"seed", &seed, 0, 10, ""}}, ""); });
  };
  EXPECT_EQ(read(1), "no InputError");
  EXPECT_EQ(seed, 1u);
  EXPECT_HAS(read(-1), "seed = -1: expected integers 0 to 10");
}

TEST(ReadParameters, AnUnknownKeyIsRefusedWithTheNearest) {
  double longest_force_N = 0;
  const Parameters parameters = {{"longest_force_N", &longest_force_N, 0, 1, ""}};
  EXPECT_EQ(refusal([&] {
              read_parameters({{"longst_force_N", 1}}, parameters, "method mine: safety");
            }),
            "method mine: safety.longst_force_N: unknown; did you mean safety.longest_force_N");
  EXPECT_EQ(refusal([&] {
              read_parameters({{"longst_force_N", 1}}, {}, "safety");
            }),
            "safety.longst_force_N: unknown; no parameters here");
}

TEST(ReadParameters, AKeyOfAnyBytesIsShown) {
  Json object = Json::object();
  object[std::string("a\0\xff", 3)] = 1;
  EXPECT_HAS(refusal([&] { read_parameters(object, {}, ""); }), "a\\x00\\xff: unknown");
}

// --- the folder of the cache ---

TEST(CacheFolder, IsTakenFromTheEnvironment) {
  ::setenv("REMOTE_TOUCH_CACHE", "/c", 1);
  EXPECT_EQ(cache_folder(), "/c");
  ::unsetenv("REMOTE_TOUCH_CACHE");
  const char* home = std::getenv("HOME");
  const std::string kept = home != nullptr ? home : "";
  ::unsetenv("XDG_CACHE_HOME"), ::setenv("HOME", "/h", 1);
  EXPECT_EQ(cache_folder(), "/h/.cache/remote-touch");
  ::setenv("XDG_CACHE_HOME", "/x", 1);
  EXPECT_EQ(cache_folder(), "/x/remote-touch");
  ::unsetenv("XDG_CACHE_HOME"), ::unsetenv("HOME");
  EXPECT_EQ(cache_folder(), "");
  if (home != nullptr) ::setenv("HOME", kept.c_str(), 1);
}

// The folder of the cache is bounded: what was used longest ago goes first.

void take(Unpacker& unpack) {
  std::string text;
  unpack.text(text);
}

class CacheSizeTest : public testing::Test {
 protected:
  CacheSizeTest() { ::unsetenv("REMOTE_TOUCH_CACHE_MB"); }  // the user may have set it
  ~CacheSizeTest() override { ::unsetenv("REMOTE_TOUCH_CACHE_MB"); }

  void add(const std::string& name, std::size_t bytes, int used_s_ago) const {
    folder_.write(name, std::string(bytes, 'x'));
    set_used(name, used_s_ago);
  }
  void set_used(const std::string& name, int s_ago) const {
    const timespec times[] = {{std::time(nullptr) - s_ago, 0}, {0, UTIME_OMIT}};
    ASSERT_EQ(::utimensat(AT_FDCWD, (folder_ / name).c_str(), times, 0), 0);
  }
  std::vector<std::string> names() const { return files_in(folder_.path()); }

  TestFolder folder_{"cache_size"};
};

TEST_F(CacheSizeTest, RemovesTheLeastRecentlyUsedFilesFirst) {
  add("a.tool", 100, 30), add("b.spheres", 100, 50), add("c.tool", 100, 10), add("d.tool", 100, 40);
  EXPECT_EQ(cache_size(folder_.path()).bytes, 400u);
  EXPECT_EQ(shrink_cache(folder_.path(), 400).files, 4u);
  const CacheSize left = shrink_cache(folder_.path(), 250);
  EXPECT_EQ(left.files, 2u);
  EXPECT_EQ(left.bytes, 200u);
  EXPECT_EQ(names(), (std::vector<std::string>{"a.tool", "c.tool"}));
  EXPECT_EQ(shrink_cache(folder_.path(), 0).files, 0u);
  EXPECT_TRUE(names().empty());
  EXPECT_EQ(cache_size(folder_ / "nowhere").files, 0u);
  EXPECT_EQ(shrink_cache(folder_ / "nowhere", 0).files, 0u);
}

// A writer removes what killed programs left.
TEST_F(CacheSizeTest, OnlyItsOwnFilesGo) {
  add("notes.txt", 100, 9999), add("k.partial-AbCdEf", 100, 7200), add("l.partial-AbCdEf", 100, 60);
  ASSERT_TRUE(write_cache_file(folder_.path(), {"tool", 1}, "m", [](CacheWriter&) {}));
  EXPECT_EQ(names(), (std::vector<std::string>{"l.partial-AbCdEf", "m.tool", "notes.txt"}));
  add("k.partial-AbCdEf", 100, 7200);
  EXPECT_EQ(shrink_cache(folder_.path(), 0).bytes, 0u);
  EXPECT_EQ(names(), (std::vector<std::string>{"l.partial-AbCdEf", "notes.txt"}));
}

// Written files make room for themselves, and reading one keeps it.
TEST_F(CacheSizeTest, WritingKeepsTheCacheBelowItsMaximum) {
  ::setenv("REMOTE_TOUCH_CACHE_MB", "0.0025", 1);  // 2500 bytes: two files
  const auto put = [](CacheWriter& pack) { pack.text(std::string(1000, 'x')); };
  const CacheKind kind{"tool", 1};
  ASSERT_TRUE(write_cache_file(folder_.path(), kind, "a", put));
  ASSERT_TRUE(write_cache_file(folder_.path(), kind, "b", put));
  set_used("a.tool", 60), set_used("b.tool", 50);
  ASSERT_TRUE(read_cache_file(folder_.path(), kind, "a", take));
  ASSERT_TRUE(write_cache_file(folder_.path(), kind, "c", put));
  EXPECT_EQ(names(), (std::vector<std::string>{"a.tool", "c.tool"}));
}

TEST_F(CacheSizeTest, AWriterThatFailsLeavesNoFile) {
  const auto put = [](CacheWriter& pack) {
    pack.text("a part");
    throw std::bad_alloc();
  };
  EXPECT_THROW(write_cache_file(folder_.path(), {"tool", 1}, "a", put), std::bad_alloc);
  EXPECT_TRUE(names().empty());
}

TEST_F(CacheSizeTest, AFileOfAnotherKeyIsNotTaken) {
  const CacheKind kind{"tool", 1};
  ASSERT_TRUE(write_cache_file(folder_.path(), kind, "a", [](CacheWriter& pack) { pack.text("of a"); }));
  folder_.write("b.tool", bytes_of(folder_ / "a.tool"));
  std::string taken;
  const auto take = [&](Unpacker& unpack) { unpack.text(taken); };
  EXPECT_FALSE(read_cache_file(folder_.path(), kind, "b", take));
  EXPECT_EQ(taken, "");
  EXPECT_TRUE(read_cache_file(folder_.path(), kind, "a", take));
  EXPECT_EQ(taken, "of a");
}

TEST_F(CacheSizeTest, TheMaximumIsTakenFromTheEnvironment) {
  EXPECT_EQ(max_cache_bytes(), 512'000'000u);
  ::setenv("REMOTE_TOUCH_CACHE_MB", "1.5", 1);
  EXPECT_EQ(max_cache_bytes(), 1'500'000u);
  for (const char* wrong : {"-1", "x", "1 MB", "nan", "inf"}) {
    ::setenv("REMOTE_TOUCH_CACHE_MB", wrong, 1);
    EXPECT_HAS(refusal([] { max_cache_bytes(); }), std::string("REMOTE_TOUCH_CACHE_MB = ") + wrong);
  }
}

}  // namespace
}  // namespace remote_touch::changed_settings_test
