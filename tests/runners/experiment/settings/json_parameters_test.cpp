// Settings from the command line.
#include "runners/experiment/settings/json_parameters.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/test_files.h"

namespace remote_touch::json_parameters_test {
namespace {

Json with(const std::string& json, const std::string& assignment) {
  Json configuration = Json::parse(json);
  apply_override(configuration, assignment);
  return configuration;
}

std::string refused(const std::string& json, const std::string& assignment) {
  return refusal([&] { with(json, assignment); });
}

TEST(ApplyOverride, SetsWhatAPathLeadsTo) {
  EXPECT_EQ(with(R"({"a": 1})", "b.c=[2]").dump(), R"({"a":1,"b":{"c":[2]}})");
  EXPECT_EQ(with(R"({"a": [{"b": 1}]})", "a.0.b=quick").dump(), R"({"a":[{"b":"quick"}]})");
  EXPECT_EQ(with(R"({"a": null})", "a.b=1").dump(), R"({"a":{"b":1}})");
}

TEST(ApplyOverride, TakesNumbersAsTheyAreTyped) {
  EXPECT_EQ(with("{}", "a=.3").dump(), R"({"a":0.3})");
  EXPECT_EQ(with("{}", "a=-.25").dump(), R"({"a":-0.25})");
  EXPECT_EQ(with("{}", "a=3.").dump(), R"({"a":3.0})");
  EXPECT_EQ(with("{}", "a=1e-3").dump(), R"({"a":0.001})");
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
  EXPECT_EQ(with("{}", "title=grün").dump(), R"({"title":"grün"})");
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

}  // namespace
}  // namespace remote_touch::json_parameters_test
