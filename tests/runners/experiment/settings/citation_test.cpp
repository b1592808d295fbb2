#include "runners/experiment/settings/provenance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/test_files.h"

namespace remote_touch::citation_test {
namespace {

const std::string kCommit(40, 'a');

TextAttributes made_by(const std::string& commit, const std::string& dirty) {
  return {{"version", version()}, {"git_commit", commit}, {"git_dirty", dirty}, {"source_digest", "12ab"}};
}

TEST(BibtexText, EscapesWhatTexReadsAsACommand) {
  EXPECT_EQ(bibtex_text("50 % of r_c & #1 for $2"), "50 \\% of r\\_c \\& \\#1 for \\$2");
  EXPECT_EQ(
      bibtex_text("a\\b^2~<c>|d"),
      "a{\\textbackslash}b{\\textasciicircum}2{\\textasciitilde}{\\textless}c{\\textgreater}{\\textbar}d");
  EXPECT_EQ(bibtex_text("'x' `y`"),
            "{\\textquotesingle}x{\\textquotesingle} {\\textasciigrave}y{\\textasciigrave}");
  EXPECT_EQ(bibtex_text("grün, plain: (4.11)"), "grün, plain: (4.11)");
}

TEST(BibtexText, DoesNotJoinHyphensToADash) {
  EXPECT_EQ(bibtex_text("--set a-b ---"), "-{}-set a-b -{}-{}-");
}

TEST(BibtexText, IsOneLineWithBalancedBraces) {
  const std::string text = bibtex_text("}}\n@misc{evil,{\x1b");
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(std::ranges::count(text, '{'), std::ranges::count(text, '}'));
  EXPECT_EQ(text.find("\\{"), std::string::npos) << "BibTeX counts this brace";
}

TEST(ProgramEntry, HasVersionYearAndCommit) {
  const std::string entry = program_entry(made_by(kCommit, "no"));
  EXPECT_TRUE(entry.starts_with("@software{remote_touch_aaaaaaaaaaaa,\n")) << entry;
  EXPECT_HAS(entry, "  version = {" + version() + "},\n");
  EXPECT_HAS(entry, "  year    = {2026},\n");
  EXPECT_HAS(entry, "note    = {version " + version() + ", commit " + kCommit + "}\n}\n");
}

TEST(ProgramEntry, IdentifiesTheSourcesIfTheCommitDoesNot) {
  EXPECT_HAS(program_entry(made_by(kCommit, "yes")),
             kCommit + " with local changes, sources with SHA-256 12ab}");
  const std::string unknown = program_entry(made_by("unknown", "unknown"));
  EXPECT_HAS(unknown, "@software{remote_touch_" + version() + ",");
  EXPECT_HAS(unknown, "commit unknown (built without git), sources with SHA-256 12ab}");
}

TEST(ProgramEntry, LeavesOutTheYearOfAnotherVersion) {
  TextAttributes older = made_by(kCommit, "no");
  older.front().second = "0.0.1";
  EXPECT_HAS(program_entry(older), "version = {0.0.1}");
  EXPECT_EQ(program_entry(older).find("year"), std::string::npos);
}

CitedResult lift() {
  return {
      "runs/my lift#1.h5", "trace", "noise of 2 r_c", "digest 12ab", {"remote-touch run a_b -o x.h5"}, ""};
}

TEST(ResultEntry, HasTitleDigestAndCommands) {
  const std::string entry = result_entry(lift(), made_by(kCommit, "no"));
  EXPECT_TRUE(entry.starts_with("@misc{my-lift-1,\n")) << entry;
  EXPECT_HAS(entry, "title        = {noise of 2 r\\_c},\n");
  EXPECT_HAS(entry,
             "{trace \\texttt{my lift\\#1.h5} of Remote Touch, version " + version() + ", commit " + kCommit);
  EXPECT_HAS(entry, "= {digest 12ab; made again by \\texttt{remote-touch run a\\_b -o x.h5}}\n}\n");
  EXPECT_EQ(entry.find("it read"), std::string::npos);
}

TEST(ResultEntry, NamesInputsProgramsAndPlugins) {
  TextAttributes attributes = made_by(kCommit, "no");
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
        result_entry(result, made_by(kCommit, "no")),
        "; \\texttt{remote-touch repro {\\textquotesingle}runs/my lift\\#1.h5{\\textquotesingle}} prints");
  }
}

TEST(ResultEntry, HasTheRemarkIfThereAreNoCommands) {
  CitedResult result = lift();
  result.title = "", result.commands = {}, result.remark = "made by 100 % chance";
  const std::string entry = result_entry(result, made_by(kCommit, "no"));
  EXPECT_HAS(entry, "{digest 12ab; made by 100 \\% chance}");
  EXPECT_HAS(entry, "title        = {my lift\\#1.h5}");
}

}  // namespace
}  // namespace remote_touch::citation_test
