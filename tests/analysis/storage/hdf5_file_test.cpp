// HDF5 files of other programs: attributes and datasets of shapes that this program does not write are read
// as they are, or refused with a message of one line before memory is allocated for them. Files that grow.
#include "analysis/storage/hdf5_file.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/hdf5_values.h"
#include "tests/analysis/storage/system_answers.h"
#include "tests/support/test_files.h"

namespace remote_touch::hdf5_foreign_test {
namespace {

struct ForeignAttributes : testing::Test {
  const TestFolder folder{"hdf5_foreign_test"};
};
using ForeignDatasets = ForeignAttributes;

namespace fs = std::filesystem;

Handle new_file(const fs::path& file) {
  return Handle(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
}

Handle text_of(std::size_t length, H5T_str_t padding) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type, length));
  check(H5Tset_strpad(type, padding));
  return type;
}

// texts: each has `length` characters, one after the other.
void write_texts(hid_t object, const char* name, const std::string& texts, std::size_t length,
                 H5T_str_t padding = H5T_STR_NULLTERM) {
  const Handle type = text_of(length, padding);
  const hsize_t count = texts.size() / length;
  const Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle made(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(H5Awrite(made, type, texts.data()));
}

struct Shape {
  std::vector<hsize_t> extent;
  std::vector<hsize_t> chunk = {};  // empty: in one piece
};

// Adds a dataset whose values are never written, so that a reader gets the fill value.
Handle add_dataset(hid_t file, const char* name, hid_t type, const Shape& shape) {
  const int rank = static_cast<int>(shape.extent.size());
  const std::vector<hsize_t> max_extent(shape.extent.size(),
                                        H5S_UNLIMITED);  // allows chunks larger than the extent
  const Handle space(rank == 0 ? H5Screate(H5S_SCALAR)
                               : H5Screate_simple(rank, shape.extent.data(),
                                                  shape.chunk.empty() ? nullptr : max_extent.data()),
                     H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (!shape.chunk.empty()) {
    check(H5Pset_chunk(creation, rank, shape.chunk.data()));
    check(H5Pset_deflate(creation, 9));
  }
  return Handle(H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
}

std::string refusal_of(const fs::path& file) {
  return refusal([&] { read_hdf5(file); });
}

TEST_F(ForeignAttributes, ListsOfTextsAreReadWhole) {
  {
    const Handle file = new_file(folder / "x.h5");
    write_texts(file, "axes", std::string("x\0\0\0y\0\0\0time", 12), 4, H5T_STR_NULLPAD);
    const Handle data = add_dataset(file, "data", H5T_NATIVE_DOUBLE, {{3}});
    write_texts(data, "units", std::string("m\0mmsm", 6), 2, H5T_STR_NULLPAD);
    write_texts(data, "long_name", std::string(32000, 'n'), 8, H5T_STR_NULLPAD);
  }
  const Hdf5Content content = read_hdf5(folder / "x.h5");
  EXPECT_EQ(attribute(content.attributes, "axes"), "x, y, time");
  ASSERT_EQ(content.datasets.size(), 1u);
  EXPECT_EQ(content.datasets[0].second.units, "m, mm, sm");
  EXPECT_EQ(content.datasets[0].second.long_name.size(), 4000u * 8 + 3999 * 2);
}

TEST_F(ForeignAttributes, EndWhereTheirTypeSays) {
  {
    const Handle file = new_file(folder / "x.h5");
    write_texts(file, "by a zero", std::string("ab\0cd", 5), 5, H5T_STR_NULLTERM);
    write_texts(file, "by zeros", std::string("ab\0\0\0", 5), 5, H5T_STR_NULLPAD);
    write_texts(file, "by blanks", "a b  ", 5, H5T_STR_SPACEPAD);
    write_texts(file, "full", "abcde", 5, H5T_STR_NULLPAD);
    write_texts(file, std::string(1000, 'n').c_str(), "text", 4, H5T_STR_NULLPAD);
  }
  const TextAttributes found = Hdf5Reader(folder / "x.h5").attributes();
  EXPECT_EQ(attribute(found, "by a zero"), "ab");
  EXPECT_EQ(attribute(found, "by zeros"), "ab");
  EXPECT_EQ(attribute(found, "by blanks"), "a b");
  EXPECT_EQ(attribute(found, "full"), "abcde");
  EXPECT_EQ(attribute(found, std::string(1000, 'n')), "text");
}

TEST_F(ForeignAttributes, AreEmptyTextsIfTheyAreOfOtherKinds) {
  {
    const Handle file = new_file(folder / "x.h5");
    const hsize_t three = 3;
    const Handle space(H5Screate_simple(1, &three, nullptr), H5Sclose), null(H5Screate(H5S_NULL), H5Sclose);
    const Handle pointers(H5Tcopy(H5T_C_S1), H5Tclose);
    check(H5Tset_size(pointers, H5T_VARIABLE));
    const Handle numbers(H5Acreate2(file, "numbers", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
    const Handle variable(H5Acreate2(file, "variable", pointers, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const std::array<const char*, 3> texts{"a", "b", "c"};
    check(H5Awrite(variable, pointers, texts.data()));
    const Handle nothing(
        H5Acreate2(file, "nothing", text_of(8, H5T_STR_NULLTERM), null, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  }
  const TextAttributes found = Hdf5Reader(folder / "x.h5").attributes();
  EXPECT_EQ(found.size(), 3u);
  for (const auto& [name, text] : found) EXPECT_EQ(text, "") << name;
}

// Adds a dataset of 16-bit integers with these names.
void add_enumeration(const fs::path& path, const std::vector<std::pair<const char*, std::int16_t>>& members) {
  const Handle type(H5Tenum_create(H5T_STD_I16BE), H5Tclose);
  for (const auto& [name, value] : members) {
    std::int16_t stored = value;
    check(H5Tconvert(H5T_NATIVE_INT16, H5T_STD_I16BE, 1, &stored, nullptr, H5P_DEFAULT));
    check(H5Tenum_insert(type, name, &stored));
  }
  add_dataset(new_file(path), "data", type, {{3}});
}

TEST_F(ForeignDatasets, NamesBelongToTheirValues) {
  add_enumeration(folder / "x.h5", {{"two", 2}, {"zero", 0}, {"one", 1}});
  EXPECT_EQ(read_hdf5(folder / "x.h5").datasets.at(0).second.value_names,
            (std::vector<std::string>{"zero", "one", "two"}));
  for (const int value : {-1, 3, 700}) {
    add_enumeration(folder / "x.h5", {{"zero", 0}, {"one", 1}, {"other", static_cast<std::int16_t>(value)}});
    EXPECT_HAS(refusal_of(folder / "x.h5"), "data names the value " + std::to_string(value));
  }
}

// They are refused before memory is allocated for them.
TEST_F(ForeignDatasets, OfOtherKindsOrMoreThanTheFileCanHoldAreRefused) {
  const hsize_t many = hsize_t{1} << 29;
  const Handle text = text_of(100'000'000, H5T_STR_NULLPAD);
  const struct {
    std::string problem;
    Shape shape;
    hid_t type = H5T_NATIVE_DOUBLE;
  } rows[] = {{"has rows of 2147483648 values", {{0, hsize_t{1} << 31}}},
              {"has rows of 4294967296 values", {{0, hsize_t{1} << 32}}},
              {"has rows of 4294967299 values", {{0, (hsize_t{1} << 32) + 3}}},
              {"claims more values than the file can hold", {{many}}},
              {"claims more values than the file can hold", {{many}, {4096}}},
              {"claims more values than the file can hold", {{many}, {many / 2}}},
              {"claims more values than the file can hold", {{many, many}, {1, 4096}}},
              {"claims more values than the file can hold", {{many, many, many}, {1, 1, 4096}}},
              {"claims more values than the file can hold", {{1}, {many / 2}}},
              {"claims more values than the file can hold", {{40}}, text},
              {"is neither numbers nor texts of one length", {{3}}, H5T_STD_REF_OBJ},
              {"has no dimension", {}}};
  for (const auto& row : rows) {
    add_dataset(new_file(folder / "x.h5"), "data", row.type, row.shape);
    EXPECT_HAS(refusal_of(folder / "x.h5"), "data " + row.problem);
  }
  add_dataset(new_file(folder / "x.h5"), "data", H5T_NATIVE_DOUBLE, {{0, 3}});
  EXPECT_EQ(read_hdf5(folder / "x.h5").datasets.at(0).second.length(), 0u);
}

// 32 bits would clip long integers, so they are read as doubles, which are exact up to 2^53. Data that
// compress well are read: deflate's best ratio is 1032 to 1.
TEST_F(ForeignDatasets, LongIntegersAndCompressedZerosKeepTheirValues) {
  const auto written = [&](hid_t type, const auto& values, std::vector<hsize_t> chunk) {
    const Handle file = new_file(folder / "x.h5");
    check(H5Dwrite(add_dataset(file, "data", type, {{values.size()}, std::move(chunk)}), type, H5S_ALL,
                   H5S_ALL, H5P_DEFAULT, values.data()));
  };
  const auto read = [&] { return read_hdf5(folder / "x.h5").datasets.at(0).second.values; };
  const std::vector<std::int64_t> values{0, -1, 1'000'000'000'000, -9'007'199'254'740'991};
  written(H5T_NATIVE_INT64, values, {});
  EXPECT_EQ(read(), Values(std::vector<double>(values.begin(), values.end())));
  const std::vector<double> zeros(1'000'000);
  written(H5T_NATIVE_DOUBLE, zeros, {zeros.size()});
  EXPECT_LT(fs::file_size(folder / "x.h5"), 20'000u);
  EXPECT_EQ(read(), Values(zeros));
}

// A file may state that its values are in another file, which may belong to anybody.
TEST_F(ForeignDatasets, ValuesOfAnotherFileAreRefused) {
  folder.write("secret", std::string(800, 's'));
  {
    const Handle file = new_file(folder / "x.h5");
    const hsize_t count = 100;
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    check(H5Pset_external(creation, (folder / "secret").c_str(), 0, 800));
    const Handle made(H5Dcreate2(file, "data", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                      H5Dclose);
  }
  EXPECT_HAS(refusal_of(folder / "x.h5"), "data has its values in another file");
}

// Each of these files made the library crash or hang. How the library fails depends on its version.
TEST(DamagedFiles, AreRefusedIfTheLibraryWouldNotSurviveThem) {
  const fs::path seeds = fs::path(REMOTE_TOUCH_SOURCE_DIR) / "tests/fuzz/corpus/hdf5_bytes";
  for (const char* name : {"library-bus-error", "library-crashes-1", "library-crashes-2", "library-crashes-3",
                           "library-divides-by-zero", "library-never-ends"})
    EXPECT_HAS(refusal_of(seeds / name), std::string(name) + ": damaged (") << name;
}

}  // namespace
}  // namespace remote_touch::hdf5_foreign_test

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

TEST_F(AppendedFile, AnExistingFileIsKeptUntilTheNewOneIsWhole) {
  const auto file = folder.write("old.h5", "old");
  { Hdf5Appender out(file); }
  EXPECT_EQ(std::filesystem::file_size(file), 3u);
  EXPECT_EQ(files_in(folder.path()).size(), 1u);
  Hdf5Appender out(file);
  out.finish();
  EXPECT_EQ(seal_state_of(file), SealState::valid);
}

TEST_F(AppendedFile, NamesTheFileThatCannotBeWritten) {
  EXPECT_HAS(refusal([&] { Hdf5Appender(folder / "nowhere/x.h5"); }), "nowhere/x.h5: cannot be written");
  EXPECT_HAS(refusal([&] { Hdf5Appender out(folder.path()); }), "cannot be written");
  EXPECT_HAS(refusal([] { Hdf5Appender("/dev/null"); }), "/dev/null: is a device: expected a file");
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
