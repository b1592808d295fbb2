// Lines that fit into a terminal, and words that are spelt similarly.
#include <gtest/gtest.h>

#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "runners/experiment/settings/json_parameters.h"
#include "runners/interfaces/cli/outputs.h"

namespace remote_touch {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Wrapped, LaterLinesBeginBelowTheLastColumn) {
  EXPECT_EQ(wrapped("  r1_m      the distance below which the proxy is entrenched", 40),
            "  r1_m      the distance below which the\n"
            "            proxy is entrenched\n");
  EXPECT_EQ(wrapped("proxy: a renderer of an experiment", 20), "proxy: a renderer of\n  an experiment\n");
  EXPECT_EQ(wrapped("a line that fits", 40), "a line that fits\n");
  EXPECT_EQ(wrapped("", 40), "\n");
}

// The columns of a table that is nearly as wide as the terminal are not the place of the rest.
TEST(Wrapped, AColumnInTheRightHalfIsNoIndent) {
  EXPECT_EQ(wrapped("  a name that is long        and its meaning", 36),
            "  a name that is long        and its\n    meaning\n");
}

TEST(Wrapped, AWordThatIsTooLongStaysWhole) {
  EXPECT_EQ(wrapped("see /a/very/long/folder/with/a/file.h5 there", 16),
            "see\n  /a/very/long/folder/with/a/file.h5\n  there\n");
  EXPECT_EQ(wrapped("/a/very/long/folder/with/a/file.h5", 16), "/a/very/long/folder/with/a/file.h5\n");
}

TEST(Wrapped, CharactersAreNotBytes) {
  const std::string metres = "\u00e9\u00e9\u00e9\u00e9 \u00e9\u00e9\u00e9\u00e9";
  EXPECT_EQ(wrapped(metres, 9), metres + "\n");
  EXPECT_EQ(wrapped(metres, 8), "\u00e9\u00e9\u00e9\u00e9\n  \u00e9\u00e9\u00e9\u00e9\n");
}

TEST(Wrapped, NoWordIsLostAndNoLineIsTooLong) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 300; ++trial) {
    std::string line(random() % 6, ' ');
    for (unsigned word = random() % 30; word > 0; --word)
      line += std::string(1 + random() % 12, static_cast<char>('a' + random() % 26)) +
              std::string(1 + random() % 3, ' ');
    const std::size_t width = 30 + random() % 60;
    const std::string text = wrapped(line, width);
    ASSERT_EQ(words_of(text), words_of(line)) << line;
    const std::vector<std::string> lines = lines_of(text);
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) ASSERT_LE(lines[i].size(), width) << text;
  }
}

TEST(SimilarKey, IsTheSimilarWordOnly) {
  const std::vector<std::string> commands{"run", "sweep", "describe", "compare"};
  EXPECT_EQ(similar_key("descirbe", commands), "describe");
  EXPECT_EQ(similar_key("swep", commands), "sweep");
  EXPECT_EQ(similar_key("frobnicate", commands), "");
  EXPECT_EQ(similar_key("run", {}), "");
}

}  // namespace
}  // namespace remote_touch
