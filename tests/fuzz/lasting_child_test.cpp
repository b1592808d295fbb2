// A child that reads many files answers like a child that begins anew for each of them.
#include "tests/fuzz/shared/lasting_child.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "runners/experiment/mesh_files/mesh_file.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/support/test_files.h"

namespace remote_touch::fuzz {
namespace {

constexpr ChildLimits kLimits{256u << 20, 1};

// Misbehaves as a library may that reads a damaged file.
std::string misbehave(const std::string& how) {
  static int count = 0;
  if (how == "count") return std::to_string(++count);
  if (how == "throw") throw std::runtime_error("no such thing");
  if (how == "crash") std::raise(SIGSEGV);
  if (how == "fill") return std::string(std::size_t{1} << 30, 'x').substr(0, 1);
  if (how == "end") ::_exit(0);
  return how;
}

std::string told(const RunInChild& run, const std::string& question) {
  try {
    return "answered " + run(kLimits, misbehave, question);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(LastingChild, ReadsManyFilesInOneProcess) {
  LastingChild child;
  for (int i = 1; i < 4; ++i) EXPECT_EQ(told(std::ref(child), "count"), "answered " + std::to_string(i));
  EXPECT_EQ(told(std::ref(child), "throw"), "no such thing");
  EXPECT_EQ(told(std::ref(child), "count"), "answered 4");
  EXPECT_EQ(child.begun(), 1);
  EXPECT_EQ(child.repeated(), 0);
}

TEST(LastingChild, ReportsEachEndLikeAChildPerQuestion) {
  LastingChild child;
  const std::string long_text(1'000'000, 'x');  // more than a pipe takes at once
  for (const std::string& question :
       {std::string(), long_text, std::string("a\0b\n", 4), std::string("throw"), std::string("crash"),
        std::string("fill"), std::string("end")}) {
    SCOPED_TRACE(question.substr(0, 10));
    EXPECT_EQ(told(std::ref(child), question), told(in_own_child, question));
    EXPECT_HAS(told(std::ref(child), "count"), "answered ");  // the next question is read as ever
  }
  EXPECT_EQ(child.repeated(), 3);
}

// The reader of meshes reports the same about every seed through both children: the mesh, or why there is
// none.
TEST(LastingChild, ReadsEverySeedOfMeshesAsAChildOfItsOwn) {
  const TestFolder folder("lasting_child_test");
  LastingChild child;
  const auto read = [](const std::filesystem::path& file, const RunInChild& run) -> std::string {
    try {
      const TriangleMesh mesh = read_mesh(file, run);
      return std::to_string(mesh.vertices.size()) + " vertices, " + std::to_string(mesh.triangles.size());
    } catch (const InputError& refusal) {
      return refusal.what();
    }
  };
  int seeds = 0;
  for (const std::string ending : {"obj", "stl"}) {
    const auto corpus =
        std::filesystem::path(REMOTE_TOUCH_SOURCE_DIR) / "tests/fuzz/corpus" / ("mesh_" + ending);
    for (const std::string& seed : files_in(corpus)) {
      const auto file = folder.write("mesh." + ending, bytes_of(corpus / seed));
      EXPECT_EQ(read(file, std::ref(child)), read(file, in_own_child)) << seed;
      ++seeds;
    }
  }
  EXPECT_GE(seeds, 10);
}

}  // namespace
}  // namespace remote_touch::fuzz
