#include "runners/presentation/result_pages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/runners/presentation/read_page.h"

namespace remote_touch::view_page_test {
namespace {

TEST(PageFile, MakesNoTagOfItsTitleNamesOrTexts) {
  if (viewer_script().empty()) GTEST_SKIP() << "built without the viewer";
  const std::string words = "\"'></script></title><script>alert(1)</script><!--<script>&lt;";
  const Json json = {{"title", words}, {words, {words, {{"deep", words}}}}};
  const std::string html = page_file(words, json.dump(), words), plain = page_file("x", "{}", "x");
  for (const char* tag : {"<script", "</script", "</title", "<!--"})
    EXPECT_EQ(count(html, tag), count(plain, tag)) << tag;
  const ReadPage page(html);
  EXPECT_EQ(page.json, json);
  EXPECT_EQ(page.bytes, words);
}

}  // namespace
}  // namespace remote_touch::view_page_test
