// A file that appears while a command computes is kept, and so is the result.
#include "analysis/storage/replacement_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/new_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::replacement_rule_test {
namespace {

namespace fs = std::filesystem;

class ReplacementRuleTest : public testing::Test {
 protected:
  // The rule of these tests: files that begin with "ours" may be replaced.
  void set_rule(const fs::path& target) const {
    set_replacement_rule(
        target, {.is_ours = [](const fs::path& file) { return bytes_of(file).starts_with("ours"); }});
  }
  std::string write(const fs::path& target, const std::string& text) const {
    return refusal([&] { write_file_atomically(target, text.data(), text.size()); });
  }
  // Returns the name of the only file that is not one of `others`.
  std::string kept_beside(const std::vector<std::string>& others) const {
    std::string kept;
    for (const std::string& name : files_in(folder_.path()))
      if (std::find(others.begin(), others.end(), name) == others.end()) kept += name;
    return kept;
  }
  const TestFolder folder_{"replacement_rule_test"};
};

constexpr const char* kNone = "no InputError";

TEST_F(ReplacementRuleTest, AFileThatAppearedAndTheResultAreKept) {
  const fs::path target = folder_ / "late.h5";
  set_rule(target);
  folder_.write("late.h5", "precious notes");
  const std::string problem = write(target, "ours, new");
  EXPECT_HAS(problem, "late.h5: was written by another program while this one computed, and is unchanged: ");
  EXPECT_EQ(bytes_of(target), "precious notes");
  const std::string kept = kept_beside({"late.h5"});
  EXPECT_HAS(kept, "late.h5.kept-");
  EXPECT_HAS(problem, (folder_ / kept).string());
  EXPECT_EQ(bytes_of(folder_ / kept), "ours, new");
  remove_leftovers(target);  // the next command does this
  EXPECT_TRUE(fs::exists(folder_ / kept));
}

TEST_F(ReplacementRuleTest, ReplacesFilesThatTheRuleAllows) {
  const fs::path target = folder_ / "x";
  set_rule(target);
  EXPECT_EQ(write(target, "ours, 1"), kNone);
  EXPECT_EQ(write(target, "ours, 2"), kNone);
  EXPECT_EQ(bytes_of(target), "ours, 2");
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"x"});
}

TEST_F(ReplacementRuleTest, HoldsForEveryWayToWriteTheTarget) {
  const fs::path target = folder_ / "x", here = fs::relative(target);
  folder_.write("x", "precious notes");
  set_rule(here);
  EXPECT_HAS(write(folder_ / "." / "x", "new"), "was written by another program");
  const fs::path temporary = temporary_of(target);
  folder_.write(temporary.filename(), "new");
  EXPECT_HAS(refusal([&] { move_into_place(temporary, target); }), "was written by another program");
  EXPECT_EQ(bytes_of(target), "precious notes");
}

TEST_F(ReplacementRuleTest, FilesThatBelongTogetherAppearAllOrNone) {
  set_rule(folder_ / "b");
  const std::string problem = refusal([&] {
    NewFiles files;
    files.begin(folder_ / "a"), files.append("new a");
    files.begin(folder_ / "b"), files.append("new b");
    folder_.write("b", "precious notes");
    files.finish();
  });
  EXPECT_HAS(problem, "b: was written by another program meanwhile, and is unchanged");
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"b"});
  EXPECT_EQ(bytes_of(folder_ / "b"), "precious notes");
}

TEST_F(ReplacementRuleTest, ReplacesEveryFileIfThereIsNoRule) {
  folder_.write("free", "anything");  // the rules of the other tests last as long as the process
  EXPECT_EQ(write(folder_ / "free", "new"), kNone);
  EXPECT_EQ(bytes_of(folder_ / "free"), "new");
}

}  // namespace
}  // namespace remote_touch::replacement_rule_test
