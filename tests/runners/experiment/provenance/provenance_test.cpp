#include "runners/experiment/provenance/provenance.h"

#include <gtest/gtest.h>

namespace remote_touch::provenance_test {
namespace {

// The identity belongs to the whole program, so it is reset for the other tests.
class Provenance : public testing::Test {
 protected:
  ~Provenance() override { identify_program({}); }
};

TEST_F(Provenance, NamesNoOtherProgramByDefault) {
  EXPECT_EQ(program_text(), "remote-touch");
  const TextAttributes of = provenance("{}", Recipe{"run", "fig4.11"}, "x86-64");
  EXPECT_EQ(attribute(of, "command"), "remote-touch run fig4.11");
  for (const char* name : {"program", "program_sha256", "plugins"}) EXPECT_EQ(attribute(of, name), "");
  EXPECT_NE(attribute(of, "source_digest"), "");
}

TEST_F(Provenance, NamesAProgramWithItsOwnCatalog) {
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

}  // namespace
}  // namespace remote_touch::provenance_test
