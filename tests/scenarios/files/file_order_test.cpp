#include "scenarios/files/file_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

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

TEST(FileOrder, NumbersInNamesAreNumbers) {
  expect_order({"9.png", "10.png", "0100.png"});
  expect_order({"1b.png", "9.png", "10.png", "0100.png"});
  expect_order({"a_1_10.pcd", "a_2_9.pcd", "a_2_10.pcd", "b_1_1.pcd"});
  expect_order({"x", "x1", "x" + std::string(39, '9'), "x1" + std::string(39, '0')});
  expect_order({"a/2.png", "a/10.png"});
}

TEST(FileOrder, EqualNumbersAreInTheOrderOfTheirTexts) {
  expect_order({"a0", "a00", "a001", "a01", "a1", "a01b", "a1b"});
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

TEST(FileOrder, TimesOfAClockHaveDecimals) {
  expect_order({"1305031102.16.png", "1305031102.160407.png", "1305031102.5.png", "1305031103.1.png"});
  expect_order({"2.5.png", "2.16.png"});
  expect_order({"1305031102_5.png", "1305031102_16.png"});
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
