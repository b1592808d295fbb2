// Tests of the text that the command `hashes` prints.
#include <gtest/gtest.h>

#include "runners/interfaces/cli/program.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::compare_test {
namespace {

std::string printed(int ticks) {
  const TestFolder folder("hashes");
  const std::string trace = (folder / "trace.h5").string(), hashes = (folder / "hashes.h5").string();
  write_trace(trace, awkward_trace(ticks), kProvenance, {});
  HashesRequest request;
  request.trace = trace, request.output = hashes, request.every = 1;
  testing::internal::CaptureStdout();
  EXPECT_EQ(command_hashes({}, request), kDone);
  return testing::internal::GetCapturedStdout();
}

TEST(Hashes, NameTheirLastTickIfThereIsOne) {
  EXPECT_HAS(printed(3), "hashes.h5: 3 hashes, the last of tick 2\n");
  EXPECT_HAS(printed(0), "hashes.h5: 0 hashes\n");
}

}  // namespace
}  // namespace remote_touch::compare_test
