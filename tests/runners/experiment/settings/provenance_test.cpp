// Statements of a result on its origin: kernels, command, program, and how it is cited.
#include "runners/experiment/settings/provenance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "core/kernels/kernels.h"
#include "tests/support/test_files.h"

namespace remote_touch::provenance_test {
namespace {

TEST(KernelsOfLevel, AreTheHighestIfNoneIsForced) {
  EXPECT_EQ(&kernels_of_level(""), supported_kernels().back());
  for (const Kernels* kernels : supported_kernels()) EXPECT_EQ(&kernels_of_level(kernels->isa), kernels);
  EXPECT_HAS(refusal([] { kernels_of_level("x86-64-v9"); }),
             "REMOTE_TOUCH_ISA = x86-64-v9: expected x86-64 up to x86-64");
}

// Commands that are stored in results can be typed into a shell.

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

// The identity belongs to the whole program, so it is reset for the other tests.
class Provenance : public testing::Test {
 protected:
  ~Provenance() override { identify_program({}); }
};

TEST_F(Provenance, NamesAProgramIfItIsAnother) {
  const TextAttributes own = provenance("{}", Recipe{"run", "fig4.11"}, "x86-64");
  EXPECT_EQ(program_text(), "remote-touch");
  EXPECT_EQ(attribute(own, "command"), "remote-touch run fig4.11");
  for (const char* name : {"program", "program_sha256", "plugins"}) EXPECT_EQ(attribute(own, name), "");
  EXPECT_NE(attribute(own, "source_digest"), "");
  identify_program({"press lab", "12ab"});
  const TextAttributes of = provenance("{}", Recipe{"sweep", "mine.json"}, "");
  EXPECT_EQ(attribute(of, "program"), "press lab");
  EXPECT_EQ(attribute(of, "program_sha256"), "12ab");
  EXPECT_EQ(attribute(of, "command"), "'press lab' sweep mine.json");
}

TEST_F(Provenance, NamesEachPlugin) {
  identify_program({"remote-touch", "", {{"./a.so", "01"}, {"b c.so", "02"}}});
  Recipe replay{"replay", "fig4.13"};
  replay.cell = {3, 4};
  const TextAttributes of = provenance("{}", replay, "");
  EXPECT_EQ(attribute(of, "plugins"), "./a.so: sha256 01\nb c.so: sha256 02");
  EXPECT_EQ(attribute(of, "program"), "");
  EXPECT_EQ(attribute(of, "command"),
            "remote-touch --plugin ./a.so --plugin 'b c.so' sweep fig4.13; "
            "remote-touch --plugin ./a.so --plugin 'b c.so' replay --cell 3,4 --replicate 0");
}

TEST_F(Provenance, SaysHowWellTheCommitIdentifiesTheSources) {
  EXPECT_EQ(commit_text({{"git_commit", "12ab"}, {"git_dirty", "no"}}), "commit 12ab");
  EXPECT_EQ(commit_text({{"git_commit", "12ab"}, {"git_dirty", "yes"}}), "commit 12ab with local changes");
  EXPECT_EQ(commit_text({{"git_commit", "unknown"}, {"git_dirty", "unknown"}}),
            "commit unknown (built without git)");
}

// A recipe is read back field by field, and no text of a file is accepted as a command.

const std::pair<Recipe, const char*> kRecipes[] = {
    {{"run", "fig4.11"}, "remote-touch run fig4.11"},
    {{"run", "it's my file.json", {"title=a; b", "trajectory.waypoints=[[0, 0.01, 0, 0]]"}},
     "remote-touch run 'it'\\''s my file.json' --set 'title=a; b' --set 'trajectory.waypoints=[[0, 0.01, 0, 0]]'"},
    {{"replay", "quick.json", {"seed=3"}, {0, 4000000000}, 2},
     "remote-touch sweep quick.json --set seed=3; remote-touch replay --cell 0,4000000000 --replicate 2"},
    {{"figure", "4.13", {}, {}, 0, 10}, "remote-touch figure 4.13 --coarse 10"},
    {{"compare", "a.h5", {}, {}, 0, 1, "b.h5", {"*=1", "force=1e-9,1e-6"}},
     "remote-touch compare a.h5 b.h5 --tolerance '*=1' --tolerance force=1e-9,1e-6"},
};

TEST(Recipe, ComesBackAndIsACommand) {
  for (const auto& [recipe, command] : kRecipes) {
    const auto again = recipe_of({{kRecipe, to_json(recipe)}});
    ASSERT_TRUE(again) << to_json(recipe);
    EXPECT_EQ(to_json(*again), to_json(recipe));
    EXPECT_EQ(command_text(*again), command);
  }
}

TEST(Recipe, IsNoneIfTheTextIsOfAnotherKind) {
  for (const char* text : {"", "remote-touch run fig4.11", "{}", "[]", "null", "{\"action\": \"run\"}",
                           "{\"subject\": \"fig4.11\"}", "{\"action\": 1, \"subject\": 2}",
                           "{\"action\": \"touch evil\", \"subject\": \"x\"}",
                           "{\"action\": \"run\", \"subject\": \"x\", \"set\": \"seed=3\"}",
                           "{\"action\": \"run\", \"subject\": \"x\", \"set\": [1]}",
                           "{\"action\": \"replay\", \"subject\": \"x\", \"cell\": \"3,4\"}",
                           "{\"action\": \"replay\", \"subject\": \"x\", \"cell\": [1e300]}",
                           "{\"action\": \"replay\", \"subject\": \"x\", \"cell\": [-1]}",
                           "{\"action\": \"replay\", \"subject\": \"x\", \"replicate\": 1e300}",
                           "{\"action\": \"figure\", \"subject\": \"x\", \"coarse\": 99999999999}",
                           "{\"action\": \"run\", \"action\": \"run\", \"subject\": \"x\"}"})
    EXPECT_FALSE(recipe_of({{kRecipe, text}})) << text;
  EXPECT_FALSE(recipe_of({}));
  EXPECT_TRUE(recipe_of({{kRecipe, to_json({"run", "\xff.json"})}})) << "a file may have any name";
}

int unknown() {
  throw InputError("renderer.name = \"centroid\"", "expected proxy");
}

// A result of this program, with its own plug-ins, is read as it is. An entry that is unknown here may be of
// the program or of a plug-in that made it.
TEST_F(Provenance, NamesTheMakerOfAnEntryThatIsUnknownHere) {
  const TextAttributes by_program = {{"program", "press-lab"}},
                       by_plugin = {{"plugins", "./a.so: sha256 01"}};
  const std::string here = "renderer.name = \"centroid\": expected proxy";
  const auto why = [](const TextAttributes& result) {
    return refusal([&] { read_configuration(result, "a.h5", unknown); });
  };
  EXPECT_EQ(other_maker({}), "");
  EXPECT_EQ(why({}), here);
  EXPECT_EQ(why(by_program),
            "a.h5: was made by press-lab, which has entries of its own: expected that "
            "program (here: " +
                here + ")");
  EXPECT_EQ(why(by_plugin),
            "a.h5: was made with plug-ins: expected --plugin for each of ./a.so: sha256 01 "
            "(here: " +
                here + ")");
  EXPECT_EQ(read_configuration(by_program, "a.h5", [] { return 3; }), 3);
  identify_program({"press-lab", "12ab"});
  EXPECT_EQ(other_maker(by_program), "");
  identify_program({"remote-touch", "", {{"./b.so", "02"}}});
  EXPECT_HAS(other_maker(by_plugin), "was made with plug-ins: ");
  identify_program({"remote-touch", "", {{"./b.so", "02"}, {"./renamed.so", "01"}}});
  EXPECT_EQ(other_maker(by_plugin), "");
  EXPECT_HAS(other_maker({{"plugins", "./a.so: sha256 01\n./c.so: sha256 03"}}), "was made with plug-ins: ");
}

// --- citations; the test command_line_cite reads whole entries ---

TEST(BibtexText, EscapesWhatTexReadsAsACommand) {
  const std::pair<const char*, const char*> rows[] = {
      {"50 % of r_c & #1 for $2", "50 \\% of r\\_c \\& \\#1 for \\$2"},
      {"a\\b^2~<c>|d",
       "a{\\textbackslash}b{\\textasciicircum}2{\\textasciitilde}{\\textless}c{\\textgreater}{\\textbar}d"},
      {"'x' `y`", "{\\textquotesingle}x{\\textquotesingle} {\\textasciigrave}y{\\textasciigrave}"},
      {"grün, plain: (4.11)", "grün, plain: (4.11)"},
      {"--set a-b ---", "-{}-set a-b -{}-{}-"}};  // hyphens are not joined to a dash
  for (const auto& [text, expected] : rows) EXPECT_EQ(bibtex_text(text), expected);
  const std::string hostile = bibtex_text("}}\n@misc{evil,{\x1b");
  EXPECT_EQ(hostile.find('\n'), std::string::npos);
  EXPECT_EQ(std::ranges::count(hostile, '{'), std::ranges::count(hostile, '}'));
  EXPECT_EQ(hostile.find("\\{"), std::string::npos) << "BibTeX counts this brace";
}

TextAttributes made_here() {
  return {{"version", version()},
          {"git_commit", std::string(40, 'a')},
          {"git_dirty", "no"},
          {"source_digest", "12ab"}};
}

CitedResult lift() {
  return {
      "runs/my lift#1.h5", "trace", "noise of 2 r_c", "digest 12ab", {"remote-touch run a_b -o x.h5"}, ""};
}

TEST(ResultEntry, NamesInputsProgramsAndPlugins) {
  TextAttributes attributes = made_here();
  attributes.insert(attributes.end(), {{"input_digests", "a_b: 1 file(s), 7 bytes, sha256 34cd"},
                                       {"program", "press lab"},
                                       {"program_sha256", "56ef"},
                                       {"plugins", "a.so: sha256 78"}});
  const std::string entry = result_entry(lift(), attributes);
  EXPECT_HAS(entry, "; it read a\\_b: 1 file(s), 7 bytes, sha256 34cd}");
  EXPECT_HAS(entry, "; in the program press lab, SHA-256 56ef; with the plug-ins a.so: sha256 78}");
}

TEST(ResultEntry, NamesReproInsteadOfACommandThatWouldChange) {
  for (const std::string& argument : {std::string("two\nlines"), std::string(2000, 'x')}) {
    CitedResult result = lift();
    result.commands = {"remote-touch run '" + argument + "' -o x.h5"};
    EXPECT_HAS(
        result_entry(result, made_here()),
        "; \\texttt{remote-touch repro {\\textquotesingle}runs/my lift\\#1.h5{\\textquotesingle}} prints");
  }
}

}  // namespace
}  // namespace remote_touch::provenance_test
