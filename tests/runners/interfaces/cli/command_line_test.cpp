#include "runners/interfaces/cli/program.h"

#include <gtest/gtest.h>

namespace remote_touch::command_line_test {
namespace {

TEST(OtherKind, NamesTheCommand) {
  EXPECT_EQ(other_kind("4.12", "run"), "is a figure: expected `remote-touch figure 4.12 -o FOLDER`");
  EXPECT_EQ(other_kind("fig4.13", "run"), "is a sweep: expected `remote-touch sweep fig4.13 -o FILE`");
  EXPECT_EQ(other_kind("fig4.12", "sweep"), "is an experiment: expected `remote-touch run fig4.12 -o FILE`");
  EXPECT_EQ(other_kind("fig4.13", "figure"), "is a sweep: expected `remote-touch sweep fig4.13 -o FILE`");
  EXPECT_EQ(other_kind("figbounds", "figure"),
            "is a figure: expected `remote-touch figure bounds -o FOLDER`");
}

TEST(OtherKind, IsEmptyForTheCommandsOwnNamesForFilesAndForNoWord) {
  EXPECT_EQ(other_kind("fig4.12", "run"), "");
  EXPECT_EQ(other_kind("fig4.13", "sweep"), "");
  EXPECT_EQ(other_kind("4.13", "figure"), "");
  EXPECT_EQ(other_kind("/dev/null", "run"), "");
  EXPECT_EQ(other_kind("nonsense", "run"), "");
  EXPECT_EQ(other_kind("", "run"), "");
}

}  // namespace
}  // namespace remote_touch::command_line_test
