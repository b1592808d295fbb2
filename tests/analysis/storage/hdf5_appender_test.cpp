#include "analysis/storage/hdf5_appender.h"

#include <gtest/gtest.h>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_reader.h"
#include "tests/analysis/storage/system_answers.h"
#include "tests/support/test_files.h"

namespace remote_touch::hdf5_appender_test {
namespace {

struct AppendedFile : testing::Test {
  const TestFolder folder{"hdf5_appender"};
};

using Number = Hdf5Appender::Number;

template <class T>
std::vector<T> numbers_of(const Hdf5Reader& file, const std::string& dataset) {
  return std::get<std::vector<T>>(file.column(dataset).values);
}

TEST_F(AppendedFile, GrownDatasetsAreReadAgainAndSealed) {
  const auto file = folder / "grown.h5";
  {
    Hdf5Appender out(file);
    out.attributes("/", {{"schema", "remote-touch-test/3"}, {"empty", ""}});
    out.group("/a");
    out.dataset({"/a/x", "m", "lengths", Number::f64, {3}, 7});
    out.dataset({"/a/image", "1", "pixels", Number::u16, {2, 4}, 1});
    out.dataset({"/a/many", "1", "bits", Number::u64});
    out.dataset({"/a/word", "1", "bits", Number::u32});
    for (int i = 0; i < 100; ++i) {
      const std::vector<double> rows(6, i);
      out.append("/a/x", rows.data(), 2);
      const std::vector<std::uint16_t> image(8, static_cast<std::uint16_t>(65000 + i));
      out.append("/a/image", image.data(), 1);
      const std::uint64_t bits = ~std::uint64_t{0} - static_cast<std::uint64_t>(i);
      out.append("/a/many", &bits, 1);
      out.append("/a/many", nullptr, 0);
      const std::uint32_t word = 0xffffffffu - static_cast<std::uint32_t>(i);
      out.append("/a/word", &word, 1);
    }
    EXPECT_FALSE(std::filesystem::exists(file)) << "before it is whole";
    out.finish();
  }
  EXPECT_EQ(seal_state_of(file), SealState::valid);
  EXPECT_EQ(files_in(folder.path()).size(), 1u);
  const Hdf5Reader in(file);
  EXPECT_EQ(attribute(in.attributes(), "schema"), "remote-touch-test/3");
  const Column x = in.column("/a/x");
  EXPECT_EQ(x.width, 3);
  EXPECT_EQ(x.units, "m");
  ASSERT_EQ(x.length(), 200u);
  EXPECT_EQ(std::get<std::vector<double>>(x.values)[599], 99);
  const Column image = in.rows("/a/image", 41, 1);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(image.values), std::vector<std::int32_t>(8, 65041));
  EXPECT_EQ(numbers_of<std::uint64_t>(in, "/a/many")[99], ~std::uint64_t{0} - 99);
  EXPECT_EQ(numbers_of<double>(in, "/a/word")[99], 0xffffffffu - 99.0);
}

// Rows that are already compressed are appended between rows that the library compresses.
TEST_F(AppendedFile, TakesDeflatedRows) {
  std::vector<std::uint16_t> depth;
  std::vector<std::uint32_t> colour;
  {
    Hdf5Appender out(folder / "x.h5");
    out.dataset({"/depth", "1", "pixels", Number::u16, {5, 7}, 1});
    out.dataset({"/colour", "1", "pixels", Number::u32, {5, 7}, 1});
    for (std::uint32_t row = 0; row < 6; ++row) {
      std::vector<std::uint16_t> a(35);
      std::vector<std::uint32_t> b(35);
      for (std::uint32_t i = 0; i < 35; ++i)
        a[i] = static_cast<std::uint16_t>(i * i * 7919 + row), b[i] = ~(i << row);
      depth.insert(depth.end(), a.begin(), a.end()), colour.insert(colour.end(), b.begin(), b.end());
      if (row % 2 == 0) {
        out.append("/depth", a.data(), 1), out.append("/colour", b.data(), 1);
        continue;
      }
      const std::string deflated = deflated_row(a.data(), 35, 2);
      EXPECT_TRUE(is_deflated_row(deflated, 70));
      EXPECT_FALSE(is_deflated_row(deflated, 69));
      EXPECT_FALSE(is_deflated_row(deflated, 71));
      EXPECT_FALSE(is_deflated_row(deflated + "x", 70));
      out.append_deflated("/depth", deflated), out.append_deflated("/colour", deflated_row(b.data(), 35, 4));
    }
    out.finish();
  }
  const Hdf5Reader in(folder / "x.h5");
  EXPECT_EQ(numbers_of<std::int32_t>(in, "/depth"), std::vector<std::int32_t>(depth.begin(), depth.end()));
  EXPECT_EQ(numbers_of<double>(in, "/colour"), std::vector<double>(colour.begin(), colour.end()));
}

TEST_F(AppendedFile, RefusesADeviceThatItWouldReplace) {
  EXPECT_HAS(refusal([] { Hdf5Appender("/dev/null"); }), "/dev/null: is a device: expected a file");
}

TEST_F(AppendedFile, LeavesNoFileIfItIsNotFinished) {
  { Hdf5Appender out(folder / "left.h5"); }
  EXPECT_TRUE(files_in(folder.path()).empty());
}

TEST_F(AppendedFile, AnExistingFileIsKeptUntilTheNewOneIsWhole) {
  const auto file = folder.write("old.h5", "old");
  { Hdf5Appender out(file); }
  EXPECT_EQ(std::filesystem::file_size(file), 3u);
  Hdf5Appender out(file);
  out.finish();
  EXPECT_EQ(seal_state_of(file), SealState::valid);
}

TEST_F(AppendedFile, NamesTheFileThatCannotBeWritten) {
  EXPECT_HAS(refusal([&] { Hdf5Appender(folder / "nowhere/x.h5"); }), "nowhere/x.h5: cannot be written");
  EXPECT_HAS(refusal([&] { Hdf5Appender out(folder.path()); }), "cannot be written");
  // The limit of 0 bytes acts like a full disk: the file is created, and its first bytes find no room.
  {
    const NoRoom limit(0);
    EXPECT_HAS(refusal([&] { Hdf5Appender out(folder / "x.h5"); }),
               "x.h5: cannot be written (File too large)");
  }
  EXPECT_TRUE(files_in(folder.path()).empty());
}

}  // namespace
}  // namespace remote_touch::hdf5_appender_test
