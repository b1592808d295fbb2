// A call that the HDF5 library refused becomes an exception with the reason.
#include "analysis/storage/hdf5_handle.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "analysis/storage/hdf5_source.h"
#include "tests/support/test_files.h"

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

TEST(OpenHdf5, PrintsNothingInAnotherThread) {
  const TestFolder folder("hdf5_handle_test");
  Hdf5Writer hdf5;
  hdf5.columns("/", {{"x", "m", "", std::vector<double>{1, 2}}}, "");
  hdf5.save(folder / "x.h5");
  const auto source = open_hdf5(folder / "x.h5");
  testing::internal::CaptureStderr();
  std::string told;
  std::thread([&] { told = failure([&] { source->column("/absent"); }); }).join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(told, "/absent is missing");
}

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
}

}  // namespace
}  // namespace remote_touch::hdf5_handle_test
