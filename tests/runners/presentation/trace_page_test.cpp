// The page of a trace: events, claims, columns, points and notes.
#include "runners/presentation/result_pages.h"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "analysis/storage/result_file.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/runners/presentation/read_page.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::trace_page_test {
namespace {

Column column(const char* name, Values values, int width = 1) {
  return {name, "1", "", std::move(values), width, {}};
}

std::vector<std::string> found(std::vector<Column> columns) {
  std::vector<std::string> list;
  for (const TraceEvent& event : trace_events(ColumnsInMemory(std::move(columns))))
    list.push_back(std::to_string(event.tick) + " " + event.kind);
  return list;
}

using Doubles = std::vector<double>;
using Integers = std::vector<std::int32_t>;
using Texts = std::vector<std::string>;

TEST(TraceEvents, AreThoseOfTheirColumns) {
  Integers often;
  Texts not_converged;
  for (int i = 0; i < 400; ++i) often.push_back(i % 2);
  for (int i = 0; i <= 50; ++i) not_converged.push_back(std::to_string(2 * i) + " not converged");
  const std::pair<std::vector<Column>, Texts> cases[] = {
      // The proxy gets below the true surface.
      {{column("signed_distance", Doubles{0.1, 0, -0.1, -0.2, 0.1, -0.1, NAN, -0.1})},
       {"2 pop-through", "5 pop-through"}},
      {{column("force", Doubles{0, 0, 0, 0, 1, 0, 0, 1, 0, 3, 4, 0, 3, 4, 1}, 3)},
       {"3 force jump", "4 largest force"}},
      {{column("force", Doubles{0, 1, 0, 0, 1, 0}, 3)}, {"0 largest force"}},  // it never changes
      {{column("force", Doubles{0, 0, 0, 0, 0, 0}, 3)}, {}},
      {{column("slave_peak_force", Doubles{NAN, 0, 2, 7, 7, 3})}, {"2 slave contact", "3 hardest hit"}},
      {{column("slave_peak_force", Doubles{NAN, 0, 0})}, {}},
      {{column("contact_count", Integers{0, 0, 2, 0, 1})}, {"2 first contact"}},
      {{column("contact_count", Integers{0, 0})}, {}},
      {{column("converged", Integers{1, 0, 0, 1, 0})}, {"1 not converged", "4 not converged"}},
      {{column("converged", Integers{0, 0, 1, 0})}, {"0 not converged", "3 not converged"}},
      // A tool says it in another column.
      {{column("converged", Integers{0, 0, 0}), column("budget_exhausted", Integers{0, 0, 1})},
       {"2 not converged"}},
      {{column("converged", often)}, not_converged},
      // A step of a task can begin or end in the first tick: step 0 is done, step 1 begins.
      {{column("sequence_step", Integers{0, 0}), column("sequence_running", Integers{1, 1})}, {"0 task"}},
      {{column("sequence_step", Integers{1, 1}), column("sequence_running", Integers{1, 1})},
       {"0 task", "0 task"}},
      {{column("sequence_step", Integers{0, 0, 1, 1, 2}),
        column("signed_distance", Doubles{1, 1, 1, -1, -1})},
       {"2 task", "3 pop-through", "4 task"}}};
  for (std::size_t i = 0; i < std::size(cases); ++i) EXPECT_EQ(found(cases[i].first), cases[i].second) << i;
  EXPECT_EQ(trace_events(ColumnsInMemory({column("converged", often)})).back().text,
            "The first of 150 more spells without convergence, which are not listed.");
  const auto events = trace_events(ColumnsInMemory(
      {column("slave_peak_force", Doubles{0, 12.34}), column("force", Doubles{0, 2, 0, 0, 2, 0}, 3)}));
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].text, "The largest force of the renderer, 2 N.");
  EXPECT_EQ(events[2].text, "The largest force of the scene on the slave, 12.3 N.");
}

TEST(TraceEvents, AProxyThatRestsOnTheSurfaceDoesNotPopThroughIt) {
  const ColumnsInMemory resting(
      std::vector<Column>{column("signed_distance", Doubles{0.01, -1e-9, 1e-9, -1e-4, -0.003})});
  EXPECT_EQ(trace_events(resting).size(), 2u);
  ASSERT_EQ(trace_events(resting, {}, 0.0025).size(), 1u);
  EXPECT_EQ(trace_events(resting, {}, 0.0025)[0].tick, 4u);
}

TEST(TraceEvents, StepsOfATaskHaveTheirResult) {
  const auto events =
      trace_events(ColumnsInMemory({column("sequence_step", Integers{0, 0, 1, 1, 2}),
                                    column("sequence_running", Integers{0, 1, 1, 1, 0}),
                                    column("sequence_missed", Integers{0, 0, 0, 0, 1}),
                                    column("sequence_distance", Doubles{NAN, NAN, NAN, NAN, 0.0005}),
                                    column("sequence_angle", Doubles{NAN, NAN, NAN, NAN, M_PI / 2})}),
                   {"activate right"});
  Texts texts;
  for (const TraceEvent& event : events) texts.push_back(std::to_string(event.tick) + " " + event.text);
  EXPECT_EQ(texts, (Texts{"1 Step 0 of the task (activate right) begins.",
                          "2 Step 0 of the task (activate right) is done.", "2 Step 1 of the task begins.",
                          "4 Step 1 of the task is missed, 0.5 mm and 90 deg from its goal."}));
}

// --- the claims of a figure beside a run of its experiment ---

constexpr const char* kClaims = R"([
  {"figure": "4.12", "claim": "height", "paper": "3 mm", "measured": 0.003, "criterion": "at most 0.004", "unit": "m",
   "verdict": "pass", "set_up": false},
  {"figure": "4.16", "claim": "other", "paper": "-", "measured": null, "criterion": "-", "unit": "1",
   "verdict": "not run", "set_up": false},
  {"figure": "4.12", "claim": "speed", "paper": "1", "measured": 2, "criterion": "-", "unit": "1", "verdict": "differs",
   "set_up": false}])";

TextAttributes run(const std::string& experiment, const std::vector<std::string>& overrides = {}) {
  return {{kRecipe, to_json(Recipe{"run", experiment, overrides})}};
}

class ShownClaimsTest : public testing::Test {
 protected:
  std::string why(const std::string& text) {
    return refusal([&] { shown_claims(folder_.write("bad.json", text), run("fig4.12")); });
  }
  const TestFolder folder_{"shown_claims"};
  const std::filesystem::path file_ = folder_.write("claims.json", kClaims);
};

TEST_F(ShownClaimsTest, AreThoseOfTheFigureInTheirOrder) {
  const Json claims = shown_claims(file_, run("fig4.12"));
  ASSERT_EQ(claims.size(), 2u);
  EXPECT_EQ(claims[0]["claim"], "height");
  EXPECT_EQ(claims[0]["measured"], 0.003);
  EXPECT_EQ(claims[1]["verdict"], "differs");
  EXPECT_FALSE(claims[0].contains("set_up"));
}

TEST_F(ShownClaimsTest, ARunOfAnotherExperimentOrWithOtherSettingsHasNone) {
  EXPECT_TRUE(shown_claims(file_, run("fig4.14")).empty());
  EXPECT_TRUE(shown_claims(file_, run("fig4.12", {"seed=3"})).empty());
  EXPECT_TRUE(shown_claims(file_, run("my.json")).empty());
  EXPECT_TRUE(shown_claims(file_, {}).empty());
  EXPECT_TRUE(shown_claims({}, run("fig4.12")).empty());
}

TEST_F(ShownClaimsTest, AnotherFileIsRefused) {
  for (const char* text : {"{}", "[3]", R"([{"claim": "x"}])", R"([{"figure": "4.12"}])"})
    EXPECT_HAS(why(text), "bad.json: is not a list of claims") << text;
  EXPECT_HAS(why("[{"), "bad.json");
  EXPECT_HAS(refusal([&] { shown_claims(folder_ / "none.json", run("fig4.12")); }), "none.json");
}

// --- the page ---

class TracePageTest : public testing::Test {
 protected:
  Trace store(const std::string& file, const std::string& experiment,
              std::vector<std::string> overrides = {}) {
    const Experiment one = Experiment::load(experiment, overrides);
    const Trace trace = simulate(one);
    write_trace(folder_ / file, trace, provenance(one.to_json(), "a test", ""), {});
    return trace;
  }
  ViewOptions options() const {
    ViewOptions options;
    options.kernels = &scenes::kernels();
    return options;
  }
  TestFolder folder_{"trace_page"};
};

// Every touching point is on the page, and there are as many of them as the renderer counted.
void expect_touching_as_counted(const ReadPage& page, const Trace& trace) {
  std::size_t ticks = 0, touching = 0;
  for (const Json& frame : page.json["runs"][0]["frames"]) {
    const auto end = page.numbers<std::uint32_t>(frame["touching_end"]);
    const auto places = page.numbers<std::uint32_t>(frame["touching"]);
    const std::size_t points = frame["positions"]["length"].get<std::size_t>() / 3;
    for (const std::uint32_t place : places) ASSERT_LT(place, points);
    const int index = frame["index"];
    const auto first = static_cast<std::size_t>(
        std::find(trace.frame_index.begin(), trace.frame_index.end(), index) - trace.frame_index.begin());
    for (std::size_t k = 0; k < end.size(); ++k, ++ticks) {
      const auto count = static_cast<std::int32_t>(end[k] - (k > 0 ? end[k - 1] : 0));
      EXPECT_EQ(count, trace.contact_count[first + k]) << "tick " << first + k;
      touching += static_cast<std::size_t>(count);
    }
  }
  EXPECT_EQ(ticks, trace.length());
  EXPECT_GT(touching, 100u);
}

TEST_F(TracePageTest, HasTheColumnsAndWhatTouches) {
  const Trace trace = store("a.h5", "fig4.12");
  const ReadPage page(trace_page({folder_ / "a.h5"}, options()).html);
  EXPECT_EQ(page.numbers<double>(page.column("time")), trace.time_s);
  EXPECT_EQ(page.numbers<std::int32_t>(page.column("contact_count")), trace.contact_count);
  const auto force = page.numbers<double>(page.column("force"));
  ASSERT_EQ(force.size(), 3 * trace.length());
  for (std::size_t i = 0; i < trace.length(); ++i)
    EXPECT_EQ(Vec3(force[3 * i], force[3 * i + 1], force[3 * i + 2]), trace.force_N[i]);
  expect_touching_as_counted(page, trace);
}

TEST_F(TracePageTest, ForbiddenRegionsTouchToo) {
  expect_touching_as_counted(
      ReadPage((store("a.h5", "fig5.6"), trace_page({folder_ / "a.h5"}, options()).html)),
      simulate(Experiment::load("fig5.6")));
}

TEST_F(TracePageTest, TwoTracesHaveTheTickAtWhichTheyDiffer) {
  const Trace a = store("a.h5", "fig4.12"), b = store("b.h5", "fig4.12", {"renderer.r3_m=0.0076"});
  std::size_t first = 0;
  while (a.normal[first] == b.normal[first] && a.proxy_position_m[first] == b.proxy_position_m[first] &&
         a.force_N[first] == b.force_N[first] && a.frame_correction_m[first] == b.frame_correction_m[first])
    ++first;
  const ReadPage page(trace_page({folder_ / "a.h5", folder_ / "b.h5"}, options()).html);
  ASSERT_EQ(page.json["runs"].size(), 2u);
  Json divergence;
  for (const Json& event : page.json["runs"][0]["events"])
    if (event["kind"] == "divergence") divergence = event;
  ASSERT_TRUE(divergence.is_object());
  EXPECT_LE(divergence["tick"].get<std::size_t>(), first);
  EXPECT_GT(divergence["tick"].get<std::size_t>(), 100u);
}

// The author of a result may have put a script into any of its texts.
TEST_F(TracePageTest, HostileWordsStayWords) {
  const std::string words = "\"'></script><script>alert(1)</script></title><img src=x onerror=alert(1)><!--";
  store("plain.h5", "fig4.12", {"duration_s=0.05"});
  const std::string plain = trace_page({folder_ / "plain.h5"}, options()).html;
  const Experiment one = Experiment::load("fig4.12", {"duration_s=0.05", "title=" + Json(words).dump()});
  TextAttributes attributes = provenance(one.to_json(), "a test", "");
  for (auto& [name, value] : attributes)
    if (name != "config" && name != "recipe" && name != "input_digests") value = words;
  write_trace(folder_ / "hostile.h5", simulate(one), attributes, {});
  const std::string html = trace_page({folder_ / "hostile.h5"}, options()).html;
  for (const char* tag : {"<script", "</script", "<img", "</title", "<!--"})
    EXPECT_EQ(count(html, tag), count(plain, tag)) << tag;
  const Json run = ReadPage(html).json["runs"][0];
  for (const char* field : {"title", "command", "version"}) EXPECT_EQ(run[field], words) << field;
  EXPECT_EQ(run["configuration"]["title"], words);
}

// A program that makes other frames than those of the run would show points that were not touched.
TEST_F(TracePageTest, HasNotesOnOtherFramesAndOnAContactRadiusThatChanges) {
  const auto note = [&](const std::string& parameter, const char* value, std::uint64_t other_frames) {
    const Experiment one = Experiment::load(
        "fig4.12", {"duration_s=0.1", R"(changes=[{"time_s": 0.05, "parameter": "renderer.)" + parameter +
                                          R"(", "value": )" + value + "}]"});
    SimulationOptions with_hashes;
    with_hashes.hash_frames = true;
    Trace trace = simulate(one, with_hashes);
    for (std::uint64_t& hash : trace.frame_hash) hash += other_frames;
    write_trace(folder_ / "a.h5", trace, provenance(one.to_json(), "a test", ""), {});
    return ReadPage(trace_page({folder_ / "a.h5"}, options()).html)
        .json["runs"][0]["note"]
        .get<std::string>();
  };
  EXPECT_EQ(note("stiffness_N_per_m", "300", 0), "");
  const std::string radius = note("r1_m", "0.003", 0), both = note("r1_m", "0.003", 1);
  EXPECT_HAS(radius, "The contact radius changes");
  EXPECT_HAS(both, "The contact radius changes");
  EXPECT_EQ(count(radius, "These are not the frames of the run"), 0u);
  EXPECT_EQ(count(both, "These are not the frames of the run"), 1u) << both;
}

TEST_F(TracePageTest, RefusesTwoTracesOfOtherTickRates) {
  store("a.h5", "fig4.12"), store("b.h5", "fig4.12", {"haptic_rate_hz=500"});
  EXPECT_HAS(refusal([&] {
               trace_page({folder_ / "a.h5", folder_ / "b.h5"}, options());
             }),
             "b.h5: has 500.0 ticks per second, but ");
}

// The last bytes cannot be made shorter, so that both are done in several pieces.
TEST(PageFile, NumbersComeBackFromTheirCompressedForm) {
  std::string bytes;
  for (int i = 0; i < 100000; ++i) bytes += static_cast<char>(i % 251 * (i % 251) % 251);
  for (const std::size_t length : {0u, 1u, 2u, 3u, 1000u, 100000u})
    EXPECT_EQ(decompressed(gzip_base64(bytes.substr(0, length)), 200000), bytes.substr(0, length));
  std::mt19937 random(1);
  for (int i = 0; i < 7'000'001; ++i) bytes += static_cast<char>(random() & 0xff);
  EXPECT_TRUE(decompressed(gzip_base64(bytes), bytes.size() + 1) == bytes);
}

}  // namespace
}  // namespace remote_touch::trace_page_test
