// Commands that are stored in results can be typed into a shell.
#include "runners/experiment/provenance/shell_command.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace remote_touch::shell_command_test {
namespace {

using Words = std::vector<std::string>;

const Words kAwkward[] = {
    {"remote-touch", "run", "fig4.11"},
    {"remote-touch", "run", "my file.json", "--set", "title=two words"},
    {"remote-touch", "run", "", "--set", ""},
    {""},
    {"", ""},
    {" "},
    {"  two  blanks  ", "\t", "a\tb"},
    {"it's", "'", "''", "'''", "it''s", "'quoted'", "ends with '"},
    {"\"", "say \"no\"", "'\"'\"'"},
    {"\\", "\\\\", "\\'", "'\\''", "\\n", "ends with \\"},
    {"a\nb", "\n", "two\n\nlines\n"},
    {"axes=[{\"parameter\": \"seed\", \"values\": [1, 2]}]", "{}", "[a-z]*"},
    {"$HOME", "$(false)", "`false`", "!!",  "#x", "~",  "~root", "*", "?", "a;b", "a; b",
     "; ",    ";",        "a&b",     "a|b", "<x", ">x", "(",     ")", "=", "a=b"},
    {"grün", "\xff\xfe", "\x01\x7f"},
    {"-", "--", "-n", "%s", "%", "@", "+", ":", "1/2"},
};

TEST(ShellCommand, PlainWordsStayAsTheyAre) {
  EXPECT_EQ(shell_command({"remote-touch", "run", "a/b_c-1.json", "--set", "axes.0.to=1e-3,5:6+7%8@9"}),
            "remote-touch run a/b_c-1.json --set axes.0.to=1e-3,5:6+7%8@9");
  EXPECT_EQ(shell_command({"x", "", "a b", "it's"}), "x '' 'a b' 'it'\\''s'");
}

std::string said_by_shell(const std::string& command) {
  FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return "no shell";
  std::string said;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) said += static_cast<char>(c);
  EXPECT_EQ(::pclose(pipe), 0) << command;
  return said;
}

TEST(ShellCommand, AShellTakesTheSameWords) {
  for (const Words& words : kAwkward) {
    Words command = {"printf", "%s\\n"};
    std::string want;
    for (const std::string& word : words) command.push_back(word), want += word + "\n";
    EXPECT_EQ(said_by_shell(shell_command(command)), want) << shell_command(command);
  }
}

}  // namespace
}  // namespace remote_touch::shell_command_test
