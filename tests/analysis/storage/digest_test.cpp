// A changed byte in a finished result is found, wherever it is, before the HDF5 library sees the file.
#include "analysis/storage/digest.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/other_processes.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::digest_test {
namespace {

struct FileDigest : testing::Test {
  const TestFolder folder{"file_digest_test"};
};

TEST_F(FileDigest, IsTheSha256OfWhatFollows) {
  write_trace(folder / "trace.h5", awkward_trace(50), kProvenance, {});
  const std::string bytes = bytes_of(folder / "trace.h5");
  EXPECT_NE(bytes.substr(0, kSealBlockSize).find(sha256_of_file(folder / "trace.h5", kSealBlockSize)),
            std::string::npos);
  EXPECT_EQ(bytes.substr(kSealBlockSize, 4), "\x89HDF");
  EXPECT_EQ(seal_state_of(folder / "trace.h5"), SealState::valid);
}

// Every byte of the seal and of the file's beginning is changed, and a sample of the others. Each change must
// be found, and none may lead to a crash.
TEST_F(FileDigest, NoChangedByteIsReadAsATrace) {
  write_trace(folder / "trace.h5", awkward_trace(50), kProvenance, {});
  const std::string bytes = bytes_of(folder / "trace.h5");
  std::size_t tried = 0;
  for (std::size_t i = 0; i < bytes.size(); i += i < 1024 ? 1 : 97) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ (1 << (i % 8)));
    const auto file = folder.write("changed.h5", changed);
    EXPECT_HAS(refusal([&] { Hdf5Reader{file}; }), "damaged");
    ++tried;
  }
  EXPECT_GT(tried, 1100u);
}

// The HDF5 library changes addresses like this if a program opens the file for writing, and closes it again.
std::string with_addresses_from_the_start(std::string bytes) {
  for (const std::size_t place : {24u, 40u}) {  // addresses of the base and of the end
    std::uint64_t address = 0;
    std::memcpy(&address, &bytes[kSealBlockSize + place], sizeof address);
    address += kSealBlockSize;
    std::memcpy(&bytes[kSealBlockSize + place], &address, sizeof address);
  }
  return bytes;
}

TEST_F(FileDigest, HoldsWhereAnotherProgramOpenedTheFileAndChangedNothing) {
  write_trace(folder / "trace.h5", awkward_trace(50), kProvenance, {});
  EXPECT_FALSE(was_opened_for_writing(folder / "trace.h5"));
  const std::string opened = with_addresses_from_the_start(bytes_of(folder / "trace.h5"));
  const auto file = folder.write("opened.h5", opened);
  EXPECT_TRUE(was_opened_for_writing(file));
  EXPECT_EQ(seal_state_of(file), SealState::valid);
  EXPECT_TRUE(same_bits(Hdf5Reader(file).column("/trace/force"),
                        Hdf5Reader(folder / "trace.h5").column("/trace/force")));
  for (std::size_t i = 0; i < opened.size(); i += i < 1024 ? 7 : 997) {
    std::string changed = opened;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(was_opened_for_writing(folder.write("changed.h5", changed))) << i;
  }
  folder.write("changed.h5", opened + "x");
  EXPECT_EQ(seal_state_of(folder / "changed.h5"), SealState::broken);
}

TEST_F(FileDigest, OtherHdf5FilesHaveNone) {
  const auto write = [&](const char* schema, const char* name) {
    Hdf5Writer hdf5(Hdf5Writer::Finished::no);
    hdf5.attribute("/", "schema", schema);
    hdf5.save(folder / name);
  };
  write("of-another/1", "other.h5"), write("remote-touch-trace/3", "ours.h5");
  EXPECT_EQ(seal_state_of(folder / "other.h5"), SealState::absent);
  const Hdf5Reader reader(folder / "other.h5");
  EXPECT_HAS(refusal([&] { reader.require_kind("trace", "what I write"); }), "of-another/1");
  EXPECT_HAS(refusal([&] { Hdf5Reader{folder / "ours.h5"}; }), "SHA-256 header is missing");
}

TEST(Sha256, KnownValues) {
  const TestFolder folder("file_digest_test");
  EXPECT_EQ(sha256_of_file(folder.write("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(folder.write("empty", "")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_file(folder.write("xyabc", "xyabc"), 2),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_HAS(refusal([&] { sha256_of_file(folder / "missing"); }),
             "missing: cannot be read (No such file or directory): expected a readable file");
  EXPECT_HAS(refusal([&] { sha256_of_file(folder.path()); }), "cannot be read (Is a directory)");
}

// The end of a file is not taken for an interrupted call, even if errno is still EINTR from an earlier call.
TEST(Sha256, AnEarlierInterruptionDoesNotCount) {
  const TestFolder folder("file_digest_test");
  const auto file = folder.write("abc", "abc");
  EXPECT_EQ(in_child({256u << 20, 5}, [&] { return errno = EINTR, sha256_of_file(file); }),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace remote_touch::digest_test
