// Units, the text of messages, and formatted text.
#include "core/parameters/parameter.h"

#include <gtest/gtest.h>
#include <string>
#include <utility>

namespace remote_touch::parameter_test {
namespace {

TEST(Unit, IsReadFromTheEndOfAName) {
  EXPECT_EQ(unit_of("r1_m")->text, std::string("m"));
  EXPECT_EQ(unit_of("stiffness_N_per_m")->text, std::string("N/m"));
  EXPECT_EQ(unit_of("force_rate_N_per_s")->text, std::string("N/s"));
  EXPECT_EQ(unit_of("damping_Nms_per_rad")->dimension, (Dimension{1, 1, 1}));
  for (const char* const name : {"rows", "gamma", "steps_per_tick", "m", ""})
    EXPECT_EQ(unit_of(name), nullptr) << name;
}

// An ending that comes too late in the table would never be found.
TEST(Unit, EveryUnitIsFoundByItsOwnEnding) {
  for (const Unit& unit : known_units())
    EXPECT_EQ(unit_of(std::string("x") + unit.ending), &unit) << unit.ending;
}

// A terminal obeys U+009B as it does ESC [, and some viewers begin a line at U+2028.
TEST(Printable, IsOneLineAndShowsWhatIsNotTextAsEscapes) {
  const std::pair<std::string, std::string> cases[] = {
      {"a\nb\tc\r\nd", "a b c  d"},
      {std::string("a\0b", 3), "a\\x00b"},
      {"\x1b[31m\x7f", "\\x1b[31m\\x7f"},
      {"z\xc2\x9b[z", "z\\xc2\\x9b[z"},
      {"\xc2\x80 \xc2\x9f", "\\xc2\\x80 \\xc2\\x9f"},
      {"z\xe2\x80\xa8z\xe2\x80\xa9", "z\\xe2\\x80\\xa8z\\xe2\\x80\\xa9"},
      {"\xff", "\\xff"},  // the others are no UTF-8
      {"gr\xfcn", "gr\\xfcn"},
      {"\xc3", "\\xc3"},                             // cut
      {"\xc0\x80", "\\xc0\\x80"},                    // longer than it needs to be
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},           // half of a pair of UTF-16
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // beyond Unicode
      {"\xe2\x82x", "\\xe2\\x82x"}};
  for (const auto& [text, shown] : cases) EXPECT_EQ(printable(text), shown);
  for (const char* text : {"", "renderer.r1_m = 3: expected 0 to 1", "grün", "€", "\xF0\x9F\x98\x80", "\\x00",
                           "\xc2\xa0", "\xe2\x80\xa7", "\xe2\x80\xaa", "\xc3\x9b"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ShortensWordsWithoutEnd) {
  const std::string digits(100000, '7'), path(400, 'a');
  EXPECT_EQ(printable("seed = " + digits + ": expected less"),
            "seed = " + std::string(199, '7') + "..." + std::string(99, '7') + ": expected less");
  EXPECT_EQ(printable("x " + path), "x " + path.substr(0, 199) + "..." + path.substr(0, 100));
  EXPECT_EQ(printable(path + ": no file"), path.substr(0, 200) + "..." + path.substr(0, 99) + ": no file");
  EXPECT_EQ(printable(path), path);
  std::string euros;
  for (int i = 0; i < 1000; ++i) euros += "€";
  const std::string shorter = printable(euros);
  EXPECT_LT(shorter.size(), 310u);
  EXPECT_EQ(shorter.find("\\x"), std::string::npos);  // no character is cut
  EXPECT_EQ(printable(shorter), shorter);
}

TEST(Printable, ShortensLinesOfManyWords) {
  std::string words;
  for (int i = 0; i < 1'000'000; ++i) words += "word ";
  const std::string shorter = printable("scenario.topic = " + words + ": expected /points");
  EXPECT_LE(shorter.size(), 1000u);
  EXPECT_EQ(shorter.find("scenario.topic = word word"), 0u);
  EXPECT_NE(shorter.find("wor...d word"), std::string::npos) << shorter;
  EXPECT_TRUE(shorter.ends_with(": expected /points"));
  EXPECT_EQ(printable(shorter), shorter);
  std::string limit = words.substr(0, 1000);
  EXPECT_EQ(printable(limit), limit);
  std::string euros;
  for (int i = 0; i < 1000; ++i) euros += "€ ";
  EXPECT_EQ(printable(euros).find("\\x"), std::string::npos);  // no character is cut
}

// The message is a C string, so a zero byte would end it.
TEST(InputErrorTest, KeepsItsWholeMessage) {
  EXPECT_STREQ(InputError(std::string("a\0b", 3), "expected c").what(), "a\\x00b: expected c");
  EXPECT_STREQ(InputError("a\xff: expected\nb").what(), "a\\xff: expected b");
}

TEST(Formatted, IsWhatPrintfPrintsAtAnyLength) {
  EXPECT_EQ(formatted("%zu of %s, %.3g %%", std::size_t{2}, "three", 0.25), "2 of three, 0.25 %");
  EXPECT_EQ(formatted("%s", ""), "");
  const std::string name(5000, 'x');
  EXPECT_EQ(formatted("%s!", name.c_str()), name + "!");
}

}  // namespace
}  // namespace remote_touch::parameter_test
