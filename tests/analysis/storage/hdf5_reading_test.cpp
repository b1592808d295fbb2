// Files that cannot be read as results are refused with a message of one line.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "analysis/storage/result_file.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::hdf5_reading_test {
namespace {

namespace fs = std::filesystem;

void expect_unreadable(const fs::path& file) {
  const std::string message = refusal([&] { read_hdf5(file); });
  EXPECT_HAS(message, file.string() + ": ");
  EXPECT_HAS(message, "expected");
}

TEST(ReadHdf5, RefusesAMissingFileAndOtherKindsOfFiles) {
  const TestFolder folder("hdf5_reading_test");
  expect_unreadable(folder / "missing.h5");
  expect_unreadable(folder.path());
  expect_unreadable(folder.write("empty.h5", ""));
  expect_unreadable(folder.write("text.h5", "{\"seed\": 1}\n"));
  expect_unreadable(folder.write("signature.h5", "\x89HDF\r\n\x1a\n"));
  expect_unreadable(folder.write("a file", "") / "inside.h5");
  expect_unreadable(folder / std::string(300, 'a'));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);  // nobody writes into it
  expect_unreadable(folder / "pipe");
  fs::create_symlink(folder / "loop", folder / "loop");
  expect_unreadable(folder / "loop");
}

TEST(ReadHdf5, RefusesATruncatedFile) {
  const TestFolder folder("hdf5_reading_test");
  write_trace(folder / "whole.h5", awkward_trace(50), kProvenance, {});
  const std::string bytes = bytes_of(folder / "whole.h5");
  for (std::size_t i = 0; i < 200; ++i)
    expect_unreadable(folder.write("cut.h5", bytes.substr(0, i * bytes.size() / 200)));
  EXPECT_NO_THROW(read_hdf5(folder.write("cut.h5", bytes)));
}

}  // namespace
}  // namespace remote_touch::hdf5_reading_test
