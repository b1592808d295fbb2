// A command writes no file twice, and none that it reads.

#include "runners/interfaces/cli/outputs.h"

#include <gtest/gtest.h>
#include <filesystem>

#include "analysis/storage/atomic_file.h"
#include "tests/support/test_files.h"

namespace remote_touch::outputs_test {
namespace {

namespace fs = std::filesystem;

class Outputs : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  static std::string refusal_of(const std::string& json, const std::string& junit) {
    return refusal([&] { require_distinct({{"--json", json}, {"--plot", ""}, {"--junit", junit}}); });
  }
  const TestFolder folder_{"outputs_test"};
};

constexpr const char* kNone = "no InputError";

TEST_F(Outputs, OneFileForTwoOptionsIsRefusedHoweverItIsWritten) {
  fs::create_directory(folder_ / "sub");
  fs::create_directory_symlink(folder_ / "sub", folder_ / "other");
  fs::create_symlink("sub/report", folder_ / "link");  // to a file that does not exist yet
  EXPECT_EQ(refusal_of(file("x"), file("x")),
            "--junit " + file("x") + ": is also the file of --json: expected another file");
  const std::string here = fs::relative(folder_.path()).string();
  for (const std::string& same : {file("sub/../x"), file("./x"), here + "/x", file("other/../x")})
    EXPECT_HAS(refusal_of(file("x"), same), "is also the file of --json") << same;
  EXPECT_HAS(refusal_of(file("sub/x"), file("other/x")), "is also the file of --json");
  EXPECT_HAS(refusal_of(file("sub/report"), file("link")), "is also the file of --json");
  EXPECT_EQ(refusal_of(file("x"), file("y")), kNone);
  EXPECT_EQ(refusal_of(file("x"), file("sub/x")), kNone);
}

TEST_F(Outputs, TwoNamesOfOneFileAreRefused) {
  folder_.write("x", "x");
  fs::create_hard_link(folder_ / "x", folder_ / "y");
  EXPECT_HAS(refusal_of(file("x"), file("y")), "is also the file of --json");
}

TEST_F(Outputs, AnEmptyNameAndADeviceMayComeTwice) {
  EXPECT_EQ(refusal_of("", ""), kNone);
  EXPECT_EQ(refusal_of("/dev/null", "/dev/null"), kNone);
}

// An input is no output, not even with --force.
TEST_F(Outputs, AnInputOrAPlugInIsNoOutput) {
  CommandLine line;
  line.force = true;
  line.plugins = {folder_.write("mine.so", "a library").string()};
  const std::string input = folder_.write("in.h5", "a result").string();
  for (const std::string& read : {input, line.plugins.front()})
    EXPECT_HAS(refusal([&] { require_report(line, read, {input}, kJsonReport); }), "is the input file");
}

// A run takes minutes: its output is checked before it and again after it.
TEST_F(Outputs, AFileThatAppearsMeanwhileIsKeptUnlessForced) {
  CommandLine line;
  for (const bool force : {false, true}) {
    line.force = force;
    const std::string output = file(force ? "forced.h5" : "late.h5");
    const FileLock lock = lock_output(line, output, {});
    folder_.write(fs::path(output).filename(), "precious notes");
    const std::string problem = refusal([&] { write_file_atomically(output, "new", 3); });
    EXPECT_EQ(bytes_of(output), force ? "new" : "precious notes");
    EXPECT_HAS(problem, force ? kNone : "late.h5: was written by another program");
  }
  const std::string report = file("report.json");
  require_report(CommandLine{}, report, {}, kJsonReport);
  folder_.write("report.json", "");  // by a shell that redirects to it
  EXPECT_EQ(refusal([&] { write_file_atomically(report, "new", 3); }), kNone);
  EXPECT_EQ(bytes_of(report), "new");
}

}  // namespace
}  // namespace remote_touch::outputs_test

namespace remote_touch::progress_test {
namespace {

TEST(ProgressText, StatesTheKnownProgress) {
  EXPECT_EQ(progress_text(0.25, 10), " 25 %, 2.5 %/s, 30 s left");
  EXPECT_EQ(progress_text(1, 10), "100 %, 10.0 %/s, 0 s left");
  EXPECT_EQ(progress_text(30, 100, 10, "runs", 10), "30 of 100 runs, 2/s, 35 s left");
}

// The remaining time is unknown before anything is done, which differs from 0 s.
TEST(ProgressText, PromisesNothingBeforeAnythingIsDone) {
  EXPECT_EQ(progress_text(0, 10), "  0 %");
  EXPECT_EQ(progress_text(10, 100, 10, "runs", 10), "10 of 100 runs");
  EXPECT_EQ(progress_text(0, 100, 0, "runs", 0), "0 of 100 runs");
}

}  // namespace
}  // namespace remote_touch::progress_test
