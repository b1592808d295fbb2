// Values in HDF5 files: what the library refuses, dimensions and texts, answers of a child process, and files
// that cannot be read.
#include "analysis/storage/hdf5_values.h"

#include <gtest/gtest.h>
#include <hdf5_hl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/other_processes.h"
#include "analysis/storage/result_file.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

// A call that the HDF5 library refused becomes an exception with the reason.
namespace remote_touch::hdf5_handle_test {
namespace {

template <class Call>
std::string failure(Call call) {
  try {
    call();
  } catch (const std::bad_alloc&) {
    return "no memory";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

// Returns the message after the library has refused a call with this error and sentence.
std::string failure_after(hid_t major, hid_t minor, const std::string& sentence) {
  use_hdf5();
  H5Eclear2(H5E_DEFAULT);
  H5Epush2(H5E_DEFAULT, "file", "function", 1, H5E_ERR_CLS, major, minor, "%s", sentence.c_str());
  errno = 0;
  return failure([] { throw_refusal(); });
}

TEST(Hdf5Refusal, RepeatsTheWordsOfTheSystem) {
  const TestFolder folder("hdf5_handle_test");
  use_hdf5();
  EXPECT_EQ(failure([&] {
              const Handle file(H5Fopen((folder / "x.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
            }),
            "No such file or directory");
  const auto told = [](const std::string& words) {
    return failure_after(H5E_FILE, H5E_WRITEERROR, "errno = 1, error message = '" + words + "', more");
  };
  EXPECT_EQ(told("No space left on device"), "No space left on device");
  EXPECT_EQ(told("?"), "?");
  EXPECT_EQ(told(std::string(127, 'w')), std::string(127, 'w'));
  // These texts do not fit into the buffer, and are left out rather than cut.
  EXPECT_EQ(told(std::string(128, 'w')), "the HDF5 library failed: out of memory, or a damaged file");
  EXPECT_EQ(told(""), "the HDF5 library failed: out of memory, or a damaged file");
}

TEST(Hdf5Refusal, IsBadAllocIfMemoryRunsOut) {
  for (const hid_t minor : {H5E_NOSPACE, H5E_CANTALLOC})
    EXPECT_EQ(failure_after(H5E_RESOURCE, minor, "memory allocation failed"), "no memory") << minor;
  EXPECT_EQ(failure_after(H5E_RESOURCE, H5E_CANTINIT, ""),
            "the HDF5 library failed: out of memory, or a damaged file");
  EXPECT_EQ(failure_after(H5E_FILE, H5E_NOSPACE, ""),
            "the HDF5 library failed: out of memory, or a damaged file");
  // A full disk is no lack of memory.
  EXPECT_EQ(failure_after(H5E_RESOURCE, H5E_NOSPACE, "error message = 'No space left on device'"),
            "No space left on device");
}

// The library prints the errors of its first call in a process, so this test starts another process.
TEST(OpenHdf5, PrintsNothingWhenTheFirstCallFails) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto fail = [] { return failure([] { open_hdf5("/nowhere/x.h5"); }); };
  EXPECT_EXIT(::_exit(fail() == "No such file or directory" ? 0 : 1), testing::ExitedWithCode(0), "^$");
  EXPECT_EQ(fail(), "No such file or directory");
}

// The library prints nothing in another thread either.
TEST(OpenHdf5, NamesADatasetThatIsMissing) {
  const TestFolder folder("hdf5_handle_test");
  Hdf5Writer hdf5;
  hdf5.columns("/", {{"x", "m", "", std::vector<double>{1, 2}}}, "");
  hdf5.save(folder / "x.h5");
  for (const bool in_child : {false, true}) {
    const auto source = in_child ? open_hdf5_in_child(folder / "x.h5") : open_hdf5(folder / "x.h5");
    EXPECT_EQ(source->datasets(), std::vector<std::string>{"/x"});
    EXPECT_GT(source->offset("/x"), 0);
    EXPECT_EQ(failure([&] { source->column("/absent"); }), "/absent is missing");
    EXPECT_EQ(failure([&] { source->rows("/absent", 0, 1); }), "/absent is missing");
    EXPECT_EQ(failure([&] { source->offset("/absent"); }), "/absent is missing");
    EXPECT_EQ(failure([&] { source->column("/absent/too"); }), "/absent/too is missing");
  }
  // A dataset that is not found for lack of memory may exist.
  const auto source = open_hdf5(folder / "x.h5");
  EXPECT_EQ(failure([&] { errno = ENOMEM, source->column("/absent"); }), "no memory");
  testing::internal::CaptureStderr();
  std::string told;
  std::thread([&] { told = failure([&] { source->column("/absent"); }); }).join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(told, "/absent is missing");
}

}  // namespace
}  // namespace remote_touch::hdf5_handle_test

namespace remote_touch::hdf5_values_test {
namespace {

struct Hdf5Dimensions : testing::Test {
  const TestFolder folder{"hdf5_dimensions"};
};

const std::vector<std::string> kWords{"", "one", "\u00e9lan", "three"};

Column counts(const char* name, std::vector<std::string> names) {
  return {name, "1", "", std::vector<std::int32_t>{0, 1, 1, 0}, 1, std::move(names)};
}

// Writes a file with columns of every kind, along time and in a table.
void write_file(const std::filesystem::path& file) {
  Hdf5Writer hdf5;
  const Column time{"time", "s", "", std::vector<double>{0, 1, 2, 3}};
  const Column vectors{"v", "m", "", std::vector<double>(12, 2.0), 3, {}};
  const Column poses{"q", "1", "", std::vector<double>(16, 0.5), 4, {}};
  const Column words{"word", "1", "", kWords};
  hdf5.group("/trace");
  hdf5.columns("/trace", {time, vectors, poses, counts("state", {"free", "in contact"})}, "time");
  hdf5.group("/tables");
  hdf5.group("/tables/t");
  const Column rows{"row", "px", "", std::vector<double>{4, 3, 2, 1}};
  hdf5.columns("/tables/t",
               {rows, vectors, words, counts("state", {"off", "on"}), counts("again", {"no", "yes"})}, "");
  hdf5.array("/trace", words, {"time"}, Hdf5Writer::Storage::compact);
  hdf5.save(file);
}

std::vector<std::string> columns() {
  return {"/tables/t/again", "/tables/t/row", "/tables/t/state", "/tables/t/v", "/tables/t/word",
          "/trace/q",        "/trace/state",  "/trace/time",     "/trace/v",    "/trace/word"};
}

TEST_F(Hdf5Dimensions, AllDimensionsAndEnumerationsHaveNames) {
  write_file(folder / "a.h5");
  const Handle file(H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  for (const std::string& path : columns()) {
    const Handle data(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose), type(H5Dget_type(data), H5Tclose),
        space(H5Dget_space(data), H5Sclose);
    if (H5DSis_scale(data) == 0) {
      for (int i = 0; i < H5Sget_simple_extent_ndims(space); ++i)
        EXPECT_EQ(H5DSget_num_scales(data, static_cast<unsigned>(i)), 1) << path << ", dimension " << i;
    }
    if (H5Tget_class(type) == H5T_ENUM) {
      EXPECT_GT(H5Tcommitted(type), 0) << path;
    }
  }
  EXPECT_TRUE(H5Lexists(file, "/state_values", H5P_DEFAULT) > 0);   // free, in contact
  EXPECT_TRUE(H5Lexists(file, "/state_values2", H5P_DEFAULT) > 0);  // off, on
  const Handle state(H5Dopen2(file, "/trace/state", H5P_DEFAULT), H5Dclose);
  EXPECT_EQ(text_attribute(state, "flag_meanings"), "free in_contact");
}

TEST_F(Hdf5Dimensions, TextsComeBack) {
  write_file(folder / "a.h5");
  const Hdf5Reader file(folder / "a.h5");
  EXPECT_EQ(file.datasets(), columns()) << "dimensions are no columns";
  EXPECT_EQ(file.values<std::string>("/tables/t/word"), kWords);
  EXPECT_EQ(file.values<std::string>("/trace/word"), kWords);
  const Column some = file.rows("/trace/word", 1, 2);
  EXPECT_EQ(std::get<std::vector<std::string>>(some.values), (std::vector<std::string>{"one", "\u00e9lan"}));
  EXPECT_EQ(file.column("/trace/state").value_names, (std::vector<std::string>{"free", "in contact"}));
}

// Files of earlier versions store each text as one value of fixed length.
TEST_F(Hdf5Dimensions, TextsOfFormerFilesComeBack) {
  {
    const Handle file(H5Fcreate((folder / "a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                      H5Fclose);
    for (const std::size_t length : {1, 3}) {
      const Handle type = text_type(length);
      const std::array<hsize_t, 2> extent{2, 2};
      const Handle space(H5Screate_simple(2, extent.data(), nullptr), H5Sclose);
      const Handle data(H5Dcreate2(file, length == 1 ? "short" : "long", type, space, H5P_DEFAULT,
                                   H5P_DEFAULT, H5P_DEFAULT),
                        H5Dclose);
      check(
          H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, length == 1 ? "a\0cd" : "abcd\0\0ef\0\0\0\0"));
    }
  }
  const Hdf5Reader file(folder / "a.h5");
  EXPECT_EQ(file.values<std::string>("/short", 2), (std::vector<std::string>{"a", "", "c", "d"}));
  EXPECT_EQ(file.values<std::string>("/long", 2), (std::vector<std::string>{"abc", "d", "ef", ""}));
}

}  // namespace
}  // namespace remote_touch::hdf5_values_test

// Work in a separate process: its answer, its failure, and its end if it needs too much. The answer about an
// HDF5 file arrives unchanged, or is refused.
namespace remote_touch::child_process_test {
namespace {

constexpr ChildLimits kLimits{256u << 20, 1};

std::string failure_of(const std::function<std::string()>& work) {
  try {
    return "answered " + in_child(kLimits, work);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(ChildProcess, AnswersWithItsBytes) {
  EXPECT_EQ(in_child(kLimits, [] { return std::string(); }), "");
  const std::string bytes("a\0b\n", 4);
  EXPECT_EQ(in_child(kLimits, [&] { return bytes; }), bytes);
  const std::string more(10'000'000, 'x');  // more bytes than a pipe takes at once
  EXPECT_EQ(in_child(kLimits, [&] { return more; }), more);
  int changed = 0;
  in_child(kLimits, [&] { return changed = 1, std::string(); });
  EXPECT_EQ(changed, 0) << "it changes nothing here";
}

TEST(ChildProcess, FailsWithAReason) {
  using Work = std::string (*)();
  const std::pair<const char*, Work> failures[] = {
      {"no such thing", []() -> std::string { throw std::runtime_error("no such thing"); }},
      {"it needs more than 256 MiB of memory",
       [] { return std::string(std::size_t{1} << 30, 'x').substr(0, 1); }},
      {"it takes more than 1 s",
       []() -> std::string {
         for (std::atomic<unsigned> i = 0;;) ++i;
       }},
      {"the process that reads it ended with exit code 3, before its answer",
       []() -> std::string { ::_exit(3); }},
      {"its reader ended with signal 11, perhaps out of memory", [] {
         std::raise(SIGSEGV);
         return std::string();
       }}};
  for (const auto& [reason, work] : failures) EXPECT_EQ(failure_of(work), reason);
}

const Hdf5Summary kSummary{{{"schema", "x"}, {"empty", ""}}, {"/a", "/b/c"}, {-1, 2048}};

std::vector<Column> columns() {
  return {{"x", "m", "a vector", std::vector<double>{1, -0.0, 5e-324, 1e300, 2, 3}, 3, {}},
          {"state", "1", "", std::vector<std::int32_t>{0, 1, -7}, 1, {"no", "yes"}},
          {"hash", "1", "", std::vector<std::uint64_t>{0, ~std::uint64_t{0}}},
          {"name", "", "", std::vector<std::string>{"", "gr\xc3\xbcn", std::string("a\0b", 3)}},
          {"none", "s", "", std::vector<double>{}}};
}

TEST(ChildAnswer, ComesBackAsItWas) {
  const Hdf5Summary summary = unpacked_summary(packed(kSummary));
  EXPECT_EQ(summary.attributes, kSummary.attributes);
  EXPECT_EQ(summary.datasets, kSummary.datasets);
  EXPECT_EQ(summary.offsets, kSummary.offsets);
  for (const Column& column : columns()) {
    const Column again = unpacked_column(packed(column));
    EXPECT_EQ(again.name, column.name);
    EXPECT_EQ(again.units, column.units);
    EXPECT_EQ(again.long_name, column.long_name);
    EXPECT_EQ(again.values, column.values);
    EXPECT_EQ(again.width, column.width);
    EXPECT_EQ(again.value_names, column.value_names);
  }
}

TEST(ChildAnswer, IsRefusedIfItIsCutOrTooLongOrHasRowsInPart) {
  const auto expect_only_whole = [](const std::string& bytes, const auto& unpacked) {
    for (std::size_t length = 0; length < bytes.size(); ++length)
      EXPECT_THROW(unpacked(bytes.substr(0, length)), std::runtime_error) << length;
    EXPECT_THROW(unpacked(bytes + '\0'), std::runtime_error);
  };
  expect_only_whole(packed(kSummary), unpacked_summary);
  for (const Column& column : columns()) expect_only_whole(packed(column), unpacked_column);
  Column column = columns()[0];
  for (const int width : {0, -1, 4, 7}) {  // its rows are not whole
    column.width = width;
    EXPECT_THROW(unpacked_column(packed(column)), std::runtime_error) << width;
  }
}

}  // namespace
}  // namespace remote_touch::child_process_test

// Files that cannot be read as results are refused with a message of one line.
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

}  // namespace
}  // namespace remote_touch::hdf5_reading_test
