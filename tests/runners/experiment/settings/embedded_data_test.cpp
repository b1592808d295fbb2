#include "runners/experiment/settings/embedded_data.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

// Reads the stored table without second_number().
nlohmann::json stored_chapter_4() {
  std::ifstream file(REMOTE_TOUCH_SOURCE_DIR "/data/second_implementation/chapter_4.json");
  return nlohmann::json::parse(file);
}

TEST(SecondImplementation, GivesTheNumberAtAPlace) {
  EXPECT_EQ(second_number("chapter_4", "/lifts/noisy/survived"),
            stored_chapter_4()["lifts"]["noisy"]["survived"].get<double>());
}

// A loop over a part of a table that no longer exists would read wrong values, or none.
TEST(SecondImplementation, GivesAColumnOfEveryRow) {
  const nlohmann::json table = stored_chapter_4(), rows = table["map"]["regions"];
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
TEST(SecondImplementation, ReadsNoFile) {
  const char* const file = REMOTE_TOUCH_SOURCE_DIR "/data/second_implementation/chapter_4.json";
  EXPECT_THROW(second_number(file, "/lifts/noisy/survived"), InputError);
}

TEST(SecondImplementation, RefusesWhatIsNotThere) {
  EXPECT_THROW(second_number("chapter_0", "/lifts"), InputError);
  EXPECT_THROW(second_number("chapter_4", "/lifts/nothing"), std::exception);
  EXPECT_THROW(second_column("chapter_4", "/map/regions", "nothing"), std::exception);
}

}  // namespace
}  // namespace remote_touch
