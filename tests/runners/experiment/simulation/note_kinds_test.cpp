// The kinds of notes: their order is part of the format of sweeps.
#include "runners/experiment/simulation/note_kinds.h"

#include <gtest/gtest.h>

#include <set>

namespace remote_touch::note_kinds_test {
namespace {

// New kinds are appended; a stored bit keeps its name.
TEST(NoteKinds, KeepTheirBits) {
  const std::string stored =
      "other,phase not reached,after the motion,no contact,no frame,wide spacing,"
      "points dropped,frames unused,frames apart,unusual rate,recording incomplete,"
      "colours missing,viewpoint unused,behind the surface,off the surface,holes bridged,"
      "edges bridged,object not scanned,camera changes,starts in contact,"
      "lost at the first touch,object not pressed,hand jumped,nothing selected,outcome unknown,"
      "few frames";
  const std::vector<std::string> names = note_kind_names();
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : ",") + name;
  EXPECT_EQ((joined + ",").substr(0, stored.size() + 1), stored + ",");
  EXPECT_LE(names.size(), 64u) << "bits of a number";
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) EXPECT_EQ(name.find(','), std::string::npos) << "it separates names";
}

TEST(NoteKinds, ANoteHasTheBitOfItsKind) {
  EXPECT_EQ(note_bits({}), 0u);
  EXPECT_EQ(note_bits({{"no contact", "a"}, {"wide spacing", "b"}, {"no contact", "c"}}), 1u << 3 | 1u << 5);
  EXPECT_EQ(note_bits({{"of another program", "a"}}), 1u);
}

TEST(NoteKinds, HaveATextForCounts) {
  EXPECT_EQ(text_of_kind("no contact"), "no contact: no point was touched and no force was felt");
  EXPECT_EQ(text_of_kind("of another program"), "of another program");
}

}  // namespace
}  // namespace remote_touch::note_kinds_test
