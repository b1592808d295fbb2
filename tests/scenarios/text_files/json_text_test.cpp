#include "scenarios/text_files/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/test_files.h"

namespace remote_touch::json_text_test {
namespace {

std::string refused(const std::string& text) {
  return refusal([&] { parse_json(text, "x.json"); });
}

TEST(JsonText, KeepsTheOrderOfItsKeys) {
  EXPECT_EQ(parse_json(R"({"b": 1, "a": {"b": [2, {"b": 3}]}})", "x").dump(),
            R"({"b":1,"a":{"b":[2,{"b":3}]}})");
}

TEST(JsonText, ReportsWhereItIsNotJson) {
  for (const char* text : {"", "{", "[1,]", "{\"a\": NaN}", "{\"a\" 1}", "\xff", "1e999", "nul"}) {
    const std::string message = refused(text);
    EXPECT_HAS(message, "x.json: ");
    EXPECT_HAS(message, ": expected JSON with finite numbers");
    EXPECT_FALSE(contains(message, "json.exception")) << message;
  }
  EXPECT_HAS(refused("{\"a\":\n nul}"), "line 2, column 5");
}

// Otherwise all that follows the byte would be ignored.
TEST(JsonText, TheByteZeroIsRefused) {
  const std::string zero(1, '\0');
  for (const std::string& text :
       {"{}" + zero, "{}" + zero + "{\"a\": 1}", zero + "{}", "{\"a\": \"" + zero + "\"}"}) {
    EXPECT_HAS(refused(text), "x.json: has the byte 0 at byte ");
    EXPECT_FALSE(json_or_none(text, "x"));
  }
}

TEST(JsonText, AKeyTwiceIsRefused) {
  EXPECT_HAS(refused(R"({"seed": 1, "seed": 2})"), R"(x.json: the key "seed" appears twice in one object)");
  EXPECT_HAS(refused(R"([{"a": {"b": 1, "c": [{"b": 2}], "b": 3}}])"), R"(the key "b" appears twice)");
  EXPECT_HAS(refused(R"({"\u0061": 1, "a": 2})"), R"(the key "a" appears twice)");
  EXPECT_EQ(refused(R"([{"a": 1, "b": {"a": {"a": 2}}}, {"a": 3}])"), "no InputError");
}

TEST(JsonText, IsRefusedIfItNestsTooDeep) {
  const auto nested = [](int levels, const std::string& open, const std::string& close) {
    std::string text;
    for (int i = 0; i < levels; ++i) text += open;
    text += "1";
    for (int i = 0; i < levels; ++i) text += close;
    return refused(text);
  };
  EXPECT_EQ(nested(kMaxJsonDepth, "[", "]"), "no InputError");
  for (const int levels : {kMaxJsonDepth + 1, 100'000}) {
    EXPECT_HAS(nested(levels, "[", "]"), "x.json: nested too deep: expected at most 64 levels");
    EXPECT_HAS(nested(levels, "{\"a\":", "}"), "x.json: nested too deep: expected at most 64 levels");
  }
}

TEST(JsonText, IsDistinguishedFromPlainText) {
  EXPECT_EQ(*json_or_none("[1, 2]", "x"), Json::parse("[1, 2]"));
  EXPECT_FALSE(json_or_none("quick", "x"));
  EXPECT_FALSE(json_or_none("\xff", "x"));
  EXPECT_HAS(refusal([] { json_or_none(R"({"a": 1, "a": 2})", "--set x"); }),
             "--set x: the key \"a\" appears twice");
}

TEST(JsonText, AFileThatIsNoJsonIsNull) {
  const TestFolder folder("json_text_test");
  EXPECT_EQ(json_in_file(folder.write("x.json", "[1]")), Json::parse("[1]"));
  for (const auto& file : {folder.write("bad.json", "[1"), folder.write("twice.json", R"({"a": 1, "a": 2})"),
                           folder / "none.json", folder.path()})
    EXPECT_TRUE(json_in_file(file).is_null()) << file;
}

TEST(JsonText, IsShownShortAndSafe) {
  EXPECT_EQ(shown(Json("gr\xfcn")), "\"gr\\ufffdn\"");
  EXPECT_EQ(shown(Json(std::string("a\0b\n", 4))), "\"a\\u0000b\\n\"");
  EXPECT_EQ(shown(Json(std::string(1000, 'a'))).size(), 163u);
}

}  // namespace
}  // namespace remote_touch::json_text_test
