// Blocks are read up to the first one that is not whole, whatever happened to the file. A journal is never
// overwritten.
#include "analysis/storage/block_journal.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/analysis/storage/system_answers.h"
#include "tests/support/test_files.h"

namespace remote_touch::block_journal_test {
namespace {

struct BlockJournal : testing::Test {
  const TestFolder folder{"block_journal"};
};

namespace fs = std::filesystem;

// Contents of blocks, among them the bytes of a header, of the opening, zeros, and no byte at all.
const std::vector<std::string> kContents{
    "first", std::string("RTb1\0\1\2\3", 8), "", std::string(300, '\0'), std::string(kJournalOpening),
    "last"};

// Writes the journal of FOLDER/x with kContents. Returns the size of the file after each block.
std::vector<std::uintmax_t> write(const TestFolder& folder) {
  std::vector<std::uintmax_t> sizes;
  JournalWriter writer(folder / "x", {0, kContents[0]});
  sizes.push_back(fs::file_size(writer.file()));
  for (std::size_t i = 1; i < kContents.size(); ++i) {
    writer.append({static_cast<std::uint32_t>(10 + i), kContents[i]});
    sizes.push_back(fs::file_size(writer.file()));
  }
  return sizes;
}

// Returns the number of blocks that are read, and checks that each is the one that was written.
std::size_t whole_blocks(const fs::path& file) {
  JournalReader reader(file);
  std::size_t count = 0;
  while (const std::optional<JournalBlock> block = reader.next()) {
    if (count >= kContents.size()) return kContents.size() + 1;
    EXPECT_EQ(block->content, kContents[count]);
    EXPECT_EQ(block->kind, count == 0 ? 0 : 10 + count);
    ++count;
  }
  return count;
}

TEST_F(BlockJournal, GivesBackItsBlocksAfterItsWriter) {
  const auto sizes = write(folder);
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"x.unfinished"});
  EXPECT_TRUE(is_journal(folder / "x.unfinished"));
  EXPECT_EQ(whole_blocks(folder / "x.unfinished"), kContents.size());
  JournalReader reader(folder / "x.unfinished");
  EXPECT_FALSE(reader.is_growing());
  reader.next();
  EXPECT_EQ(reader.left(), sizes.back() - sizes.front());
  const std::uint64_t before = reader.left();
  reader.next(), reader.reject();
  EXPECT_EQ(reader.left(), before);
}

// A kill or a power cut may end the file at any byte. The blocks before the cut are read.
TEST_F(BlockJournal, ACutFileGivesTheBlocksBeforeTheCut) {
  const auto sizes = write(folder);
  const std::string whole = bytes_of(folder / "x.unfinished");
  for (std::size_t size = kJournalOpening.size(); size <= whole.size(); ++size) {
    const fs::path cut = folder.write("cut", whole.substr(0, size));
    std::size_t expected = 0;
    while (expected < sizes.size() && sizes[expected] <= size) ++expected;
    ASSERT_EQ(whole_blocks(cut), expected) << size;
    // A power cut may leave zeros, or what was on the disk before, in place of the last blocks.
    for (const char byte : {'\0', '\xff'}) {
      std::string replaced = whole;
      for (std::size_t i = size; i < replaced.size(); ++i) replaced[i] = byte;
      ASSERT_LE(whole_blocks(folder.write("replaced", replaced)), sizes.size());
      if (size < whole.size()) {
        ASSERT_LE(whole_blocks(folder / "replaced"), expected + 1) << size;
      }
    }
  }
}

TEST_F(BlockJournal, AChangedByteEndsTheBlocksBeforeIt) {
  const auto sizes = write(folder);
  const std::string whole = bytes_of(folder / "x.unfinished");
  for (std::size_t at = kJournalOpening.size(); at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] ^= 0x10;
    std::size_t expected = 0;
    while (sizes[expected] <= at) ++expected;
    ASSERT_EQ(whole_blocks(folder.write("changed", changed)), expected) << at;
  }
}

TEST_F(BlockJournal, BlocksThatAreMissingOrComeTwiceEndIt) {
  const auto sizes = write(folder);
  const std::string whole = bytes_of(folder / "x.unfinished");
  const auto part = [&](std::size_t block) {
    return whole.substr(sizes[block - 1], sizes[block] - sizes[block - 1]);
  };
  const std::string start = whole.substr(0, sizes[0]);
  EXPECT_EQ(whole_blocks(folder.write("a", start + part(2) + part(1))), 1u);
  EXPECT_EQ(whole_blocks(folder.write("b", start + part(1) + part(1) + part(2))), 2u);
  EXPECT_EQ(whole_blocks(folder.write("c", whole + whole)), kContents.size());
  EXPECT_EQ(whole_blocks(folder.write("d", start + part(1) + "garbage" + part(2))), 2u);
}

TEST_F(BlockJournal, GrowsWhileItsWriterLives) {
  JournalWriter writer(folder / "x", {0, "first"});
  writer.append({1, "second"});
  writer.sync();
  JournalReader reader(folder / "x.unfinished");
  EXPECT_TRUE(reader.is_growing());
  EXPECT_EQ(reader.next()->content, "first");
  EXPECT_EQ(reader.next()->content, "second");
  EXPECT_FALSE(reader.next());
  writer.remove();
  EXPECT_TRUE(files_in(folder.path()).empty());
  // It is beside the file to which a link leads.
  fs::create_directory(folder / "deep");
  fs::create_symlink("deep/x", folder / "link");
  EXPECT_TRUE(
      fs::equivalent(JournalWriter(folder / "link", {0, "first"}).file(), folder / "deep/x.unfinished"));
}

TEST_F(BlockJournal, RefusesToOverwriteAnExistingFile) {
  write(folder);
  const std::string bytes = bytes_of(folder / "x.unfinished");
  const std::string why = refusal([&] { JournalWriter(folder / "x", {0, "first"}); });
  EXPECT_HAS(why, "x.unfinished: exists, an earlier recording");
  EXPECT_HAS(why, "remote-touch recover");
  EXPECT_HAS(refusal([&] { require_no_journal_beside(folder / "x"); }),
             "x.unfinished: exists, an earlier recording");
  EXPECT_EQ(bytes_of(folder / "x.unfinished"), bytes);
  EXPECT_EQ(files_in(folder.path()).size(), 1u);
  // A file that is no journal is not overwritten either.
  folder.write("y.unfinished", "mine");
  EXPECT_HAS(refusal([&] {
               JournalWriter(folder / "y", {0, "first"});
             }),
             "y.unfinished: exists, an earlier recording");
  EXPECT_EQ(bytes_of(folder / "y.unfinished"), "mine");
}

// Its writer was killed before the second block was whole: nothing can be recovered from it.
TEST_F(BlockJournal, ReplacesOneThatHoldsNothing) {
  const auto sizes = write(folder);
  const std::string bytes = bytes_of(folder / "x.unfinished");
  for (const std::uintmax_t size : {sizes[0], sizes[0] + 5, sizes[1] - 1}) {
    folder.write("x.unfinished", bytes.substr(0, size));
    EXPECT_NO_THROW(require_no_journal_beside(folder / "x"));
    EXPECT_EQ(bytes_of(folder / "x.unfinished").size(), size) << "only a writer replaces it";
    JournalWriter writer(folder / "x", {0, "new"});
    EXPECT_EQ(JournalReader(folder / "x.unfinished").next()->content, "new");
    EXPECT_HAS(refusal([&] {
                 JournalWriter(folder / "x", {0, "other"});
               }),
               "x.unfinished: exists")
        << "a writer that still runs";
    EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"x.unfinished"});
  }
  folder.write("x.unfinished", bytes.substr(0, sizes[1]));
  EXPECT_HAS(refusal([&] { JournalWriter(folder / "x", {0, "first"}); }), "x.unfinished: exists");
}

TEST_F(BlockJournal, RefusesWhatCannotBeWritten) {
  EXPECT_HAS(refusal([&] { JournalWriter(folder / "nowhere/x", {0, "first"}); }), "cannot be written");
  EXPECT_HAS(refusal([&] { JournalWriter(folder.path(), {0, "first"}); }), "cannot be written");
  EXPECT_HAS(refusal([&] { JournalWriter("/dev/null", {0, "first"}); }), "/dev/null: is a device");
  {
    const NoRoom limit(50);
    EXPECT_HAS(refusal([&] { JournalWriter(folder / "x", {0, std::string(100, 'x')}); }), "File too large");
  }
  EXPECT_TRUE(files_in(folder.path()).empty());
}

TEST_F(BlockJournal, ABlockWithoutRoomLeavesTheBlocksBeforeWhole) {
  JournalWriter writer(folder / "x", {0, "first"});
  const std::uintmax_t size = fs::file_size(writer.file());
  {
    const NoRoom limit(size + 50);
    EXPECT_HAS(refusal([&] {
                 writer.append({1, std::string(100, 'x')});
               }),
               "x: cannot be written (File too large)");
    EXPECT_EQ(fs::file_size(writer.file()), size) << "what was written of it is cut off";
  }
  writer.append({2, "later"});
  JournalReader reader(writer.file());
  EXPECT_EQ(reader.next()->content, "first");
  EXPECT_EQ(reader.next()->content, "later");
}

// A later block would be behind the written part of this one, where no reader finds it.
TEST_F(BlockJournal, RefusesBlocksBehindAPartThatCannotBeRemoved) {
  JournalWriter writer(folder / "x", {0, "first"});
  const auto append = [&] { return refusal([&] { writer.append({1, std::string(100, 'x')}); }); };
  {
    const NoRoom limit(fs::file_size(writer.file()) + 50);
    const FaultySystem failed({.truncations_fail = true});
    EXPECT_HAS(append(), "x: cannot be written (File too large)");
  }
  EXPECT_HAS(append(), "x: cannot be written (File too large)");
  JournalReader reader(writer.file());
  EXPECT_EQ(reader.next()->content, "first");
  EXPECT_FALSE(reader.next());
}

TEST_F(BlockJournal, RefusesToReadOtherFiles) {
  const auto why = [](const fs::path& file) { return refusal([&] { JournalReader{file}; }); };
  EXPECT_HAS(why(folder / "none"), "none: no such file");
  EXPECT_HAS(why(folder.write("empty", "")), "empty: is not an unfinished recording");
  EXPECT_HAS(why(folder.write("text", "Remote Touch result")), "text: is not an unfinished recording");
  EXPECT_HAS(why(folder.path()), "is not an unfinished recording");
  write(folder);
  EXPECT_HAS(why(folder.write("x", "a result")), "expected " + (folder / "x.unfinished").string());
  // A journal is named if its result is missing.
  const auto required = [&](const char* name) { return refusal([&] { require_no_journal(folder / name); }); };
  EXPECT_EQ(required("x"), "no InputError");
  EXPECT_EQ(required("other"), "no InputError");
  EXPECT_HAS(required("x.unfinished"), "is an unfinished recording");
  fs::remove(folder / "x");
  EXPECT_HAS(required("x"), "x: no such file, but its unfinished recording");
}

}  // namespace
}  // namespace remote_touch::block_journal_test
