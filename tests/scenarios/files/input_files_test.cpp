// Texts, JSON and the order of files: what is read, what is refused, and which file comes first.
#include "scenarios/files/input_files.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/stat.h>
#include <algorithm>
#include <csignal>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::text_file_test {
namespace {

namespace fs = std::filesystem;

std::string refused(const fs::path& file) {
  return refusal([&] { read_text_file(file, "expected a list"); });
}

TEST(TextFile, IsReadWhole) {
  const TestFolder folder("text_file_test");
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{65536}, kMaxTextBytes}) {
    const std::string text(size, 'x');
    EXPECT_EQ(read_text_file(folder.write("x", text), ""), text);
  }
  EXPECT_EQ(read_text_file(folder.write("x", std::string("\0\r\n\xff", 4)), ""),
            std::string("\0\r\n\xff", 4));
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF# x"), "# x");
  for (const char* text : {"", "\xEF\xBB", "x\xEF\xBB\xBF"}) EXPECT_EQ(without_byte_order_mark(text), text);
}

TEST(TextFile, IsRefusedIfItIsTooLongOrNoFile) {
  const TestFolder folder("text_file_test");
  EXPECT_HAS(refused(folder.write("long", std::string(kMaxTextBytes + 1, 'x'))),
             "long: is longer than 16 MiB: expected a list");
  EXPECT_HAS(refused(fs::path("/dev/zero")), "/dev/zero: is longer than 16 MiB: expected a list");
  EXPECT_HAS(refused(folder.path()), "cannot be read (Is a directory): expected a list");
  EXPECT_HAS(refused(folder / "none"), "none: cannot be read (No such file or directory): expected a list");
}

// A reader of a pipe that nobody writes to would wait for ever.
TEST(TextFile, AnInputIsNeitherPipeNorDeviceNorFolder) {
  const TestFolder folder("text_file_test");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "zero");
  const auto refused_input = [](const fs::path& file) {
    EXPECT_EQ(refusal([&] { require_file(file); }), refusal([&] { read_input_text(file, ""); }));
    return refusal([&] { require_file(file); });
  };
  for (const char* name : {"pipe", "zero"}) {
    const std::string expected =
        (folder / name).string() + ": cannot be read (a pipe or a device): expected a file";
    EXPECT_EQ(refused_input(folder / name), expected);
    EXPECT_EQ(refusal([&] { require_file_or_folder(folder / name); }), expected);
  }
  EXPECT_EQ(refused_input(folder.path()),
            folder.path().string() + ": cannot be read (a folder): expected a file");
  require_file_or_folder(folder.path());
  fs::create_symlink(folder.write("text", "a list"), folder / "link");
  EXPECT_EQ(read_input_text(folder / "link", ""), "a list");
  require_file(folder / "none");
  EXPECT_HAS(refusal([&] { read_input_text(folder / "none", "expected a list"); }), "No such file");
}

TEST(TextFile, APipeIsReadToItsEnd) {
  const TestFolder folder("text_file_test");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  auto text = std::async(std::launch::async, [&] { return read_text_file(folder / "pipe", ""); });
  const std::string sent(300'000, 'p');
  folder.write("pipe", sent);
  EXPECT_EQ(text.get(), sent);
}

// The signal arrives like SIGTERM, whose handler lets interrupted calls continue.
TEST(TextFile, ASignalEndsTheWaitForAPipe) {
  const TestFolder folder("text_file_test");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto before = std::signal(SIGUSR1, [](int) {});
  std::promise<pthread_t> started;
  auto answer = std::async(std::launch::async, [&] {
    started.set_value(::pthread_self());
    return refused(folder / "pipe");
  });
  const pthread_t reader = started.get_future().get();
  while (answer.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready)
    ::pthread_kill(reader, SIGUSR1);
  EXPECT_HAS(answer.get(), "cannot be read (Interrupted system call)");
  std::signal(SIGUSR1, before);
}

}  // namespace
}  // namespace remote_touch::text_file_test

namespace remote_touch::json_text_test {
namespace {

std::string refused(const std::string& text) {
  return refusal([&] { parse_json(text, "x.json"); });
}

TEST(JsonText, KeepsTheOrderOfItsKeys) {
  EXPECT_EQ(parse_json(R"({"b": 1, "a": {"b": [2, {"b": 3}]}})", "x").dump(),
            R"({"b":1,"a":{"b":[2,{"b":3}]}})");
}

// One row for each refusal.
TEST(JsonText, IsRefusedWithTheReason) {
  const std::string zero(1, '\0'), no_json = ": expected JSON with finite numbers";
  const std::string deep = "x.json: nested too deep: expected at most 64 levels";
  const auto nested = [](int levels, const std::string& open, char close) {
    std::string text;
    for (int i = 0; i < levels; ++i) text += open;
    return text + "1" + std::string(static_cast<std::size_t>(levels), close);
  };
  std::vector<std::pair<std::string, std::string>> rows = {
      {"{\"a\":\n nul}", "line 2, column 5"},
      {R"({"seed": 1, "seed": 2})", R"(x.json: the key "seed" appears twice in one object)"},
      {R"([{"a": {"b": 1, "c": [{"b": 2}], "b": 3}}])", R"(the key "b" appears twice)"},
      {R"({"\u0061": 1, "a": 2})", R"(the key "a" appears twice)"},
      {R"([{"a": 1, "b": {"a": {"a": 2}}}, {"a": 3}])", "no InputError"},
      {nested(kMaxJsonDepth, "[", ']'), "no InputError"},
      {nested(kMaxJsonDepth + 1, "[", ']'), deep},
      {nested(100'000, "[", ']'), deep},
      {nested(100'000, "{\"a\":", '}'), deep},
  };
  for (const char* text : {"", "{", "[1,]", "{\"a\": NaN}", "{\"a\" 1}", "\xff", "1e999", "nul"}) {
    rows.push_back({text, no_json});
    EXPECT_FALSE(contains(refused(text), "json.exception")) << text;
  }
  // Otherwise all that follows the byte would be ignored.
  for (const std::string& text :
       {"{}" + zero, "{}" + zero + "{\"a\": 1}", zero + "{}", "{\"a\": \"" + zero + "\"}"}) {
    rows.push_back({text, "x.json: has the byte 0 at byte "});
    EXPECT_FALSE(json_or_none(text, "x"));
  }
  for (const auto& [text, why] : rows) EXPECT_HAS(refused(text), why);
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

namespace remote_touch::file_order_test {
namespace {

using Files = std::vector<std::filesystem::path>;

void expect_order(const Files& expected) {
  Files files = expected;
  std::sort(files.begin(), files.end());
  do {
    Files sorted = files;
    sort_by_name(sorted);
    ASSERT_EQ(sorted, expected);
  } while (std::next_permutation(files.begin(), files.end()));
}

// Equal numbers are in the order of their texts; times of a clock have decimals.
TEST(FileOrder, NumbersInNamesAreNumbers) {
  expect_order({"1b.png", "9.png", "10.png", "0100.png"});
  expect_order({"a_1_10.pcd", "a_2_9.pcd", "a_2_10.pcd", "b_1_1.pcd"});
  expect_order({"x", "x1", "x" + std::string(39, '9'), "x1" + std::string(39, '0')});
  expect_order({"a/2.png", "a/10.png"});
  expect_order({"a0", "a00", "a001", "a01", "a1", "a01b", "a1b"});
  expect_order({"1305031102.16.png", "1305031102.160407.png", "1305031102.5.png", "1305031103.1.png"});
  expect_order({"2.5.png", "2.16.png"});
  expect_order({"1305031102_5.png", "1305031102_16.png"});
}

TEST(FileOrder, NamesWithEqualNumbersAreFound) {
  const auto found = [](std::vector<std::filesystem::path> files) {
    sort_by_name(files);
    return equal_numbers(files);
  };
  EXPECT_EQ(found({"frame_1.pcd", "frame_2.pcd", "frame_01.pcd"}),
            "frame_01.pcd and frame_1.pcd have equal numbers: all are frames");
  EXPECT_EQ(found({"3.png", "0003.png", "7.PNG", "7.png", "8.png"}),
            "0003.png and 3.png have equal numbers, and so have 1 more pair(s): all are frames");
  for (const std::vector<std::filesystem::path>& files :
       {std::vector<std::filesystem::path>{},
        {"1.png", "10.png", "100.png"},
        {"a1.png", "b1.png", "1.png"},
        {"1305031102.5.png", "1305031102.05.png", "1305031102.50.png"}})
    EXPECT_EQ(found(files), "");
}

// The order is transitive for all names: if a is before b and b is before c, then a is before c.
TEST(FileOrder, IsTransitive) {
  Files names;
  for (const char* first : {"", "1", "01", "0000000001", "1305031102", "01305031102", "a"})
    for (const char* point : {"", ".", "_"})
      for (const char* last : {"", "5", "16", "016", "x"}) names.push_back(std::string(first) + point + last);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const auto before = [](const auto& a, const auto& b) {
    Files two{a, b};
    sort_by_name(two);
    return a != b && two.front() == a;
  };
  Files sorted = names;
  sort_by_name(sorted);
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = i + 1; j < sorted.size(); ++j) EXPECT_TRUE(before(sorted[i], sorted[j]));
}

}  // namespace
}  // namespace remote_touch::file_order_test
