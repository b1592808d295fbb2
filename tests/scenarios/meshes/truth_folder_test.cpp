// The folder truth/ of a recording: what is found in it, and what is refused.
#include "scenarios/meshes/truth_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::truth_folder_test {
namespace {

namespace fs = std::filesystem;

// Only the names of meshes, poses and masks matter here: they are not opened.
class TruthFolders : public testing::Test {
 protected:
  void write(const std::string& name) const { folder_.write("truth/" + name, ""); }
  TruthFolder find() const { return find_truth(folder_.path()).value(); }
  // Expects a refusal about this file or folder in truth/.
  void expect_refused(const std::string& subject, const std::string& part) const {
    const std::string text = refusal([&] { find_truth(folder_.path()); });
    const fs::path named = subject.empty() ? folder_ / "truth" : folder_ / ("truth/" + subject);
    EXPECT_EQ(text.rfind(named.string() + ": ", 0), 0u) << text << "\nis not about " << named;
    EXPECT_HAS(text, part);
  }
  void expect_json_refused(const std::string& json, const std::string& part) const {
    folder_.write("truth/truth.json", json);
    expect_refused("truth.json", part);
  }
  // truth.json with one object, in which a part is replaced.
  void expect_object_refused(const std::string& part, const std::string& by,
                             const std::string& message) const {
    std::string json = R"({"objects": [{"name": "cube", "mesh": "cube.obj", "poses": "poses.txt"}]})";
    json.replace(json.find(part), part.size(), by);
    expect_json_refused(json, message);
  }
  std::vector<std::string> names_of(const TruthFolder& truth) const {
    std::vector<std::string> names;
    for (const TruthObjectFiles& object : truth.objects) names.push_back(object.name);
    return names;
  }
  fs::path in_truth(const std::string& name) const { return folder_ / ("truth/" + name); }

  const TestFolder folder_{"truth_folder_test"};
};

using Names = std::vector<std::string>;
using Paths = std::vector<fs::path>;

TEST_F(TruthFolders, AreOptional) {
  EXPECT_FALSE(find_truth(folder_.path()));
  EXPECT_FALSE(find_truth(folder_ / "none"));
  EXPECT_FALSE(find_truth(folder_.write("cloud.pcd", "")));
  folder_.write("other/truth", "a file");
  EXPECT_FALSE(find_truth(folder_ / "other"));
}

TEST_F(TruthFolders, AreDescribedByAFile) {
  for (const char* name : {"cube.obj", "poses.txt", "parts/table.ply", "still.txt", "unused.stl"})
    write(name);
  folder_.write("truth/truth.json",
                "\xEF\xBB\xBF"
                R"({"objects": [
      {"name": "cube", "mesh": "cube.obj", "poses": "poses.txt"},
      {"name": "table", "mesh": "parts/table.ply", "poses": "still.txt", "closed": false},
      {"name": "again", "mesh": "./cube.obj", "poses": "still.txt", "closed": true}],
      "uncertainty_m": 0.003})");
  const TruthFolder truth = find();
  ASSERT_EQ(names_of(truth), (Names{"cube", "table", "again"}));
  EXPECT_EQ(truth.objects[0].mesh, in_truth("cube.obj"));
  EXPECT_EQ(truth.objects[0].poses, in_truth("poses.txt"));
  EXPECT_EQ(truth.objects[0].closed, std::nullopt);
  EXPECT_EQ(truth.objects[1].mesh, in_truth("parts/table.ply"));
  EXPECT_EQ(truth.objects[1].poses, in_truth("still.txt"));
  EXPECT_EQ(truth.objects[1].closed, false);
  EXPECT_EQ(truth.objects[2].mesh, in_truth("cube.obj"));
  EXPECT_EQ(truth.objects[2].closed, true);
  EXPECT_EQ(truth.uncertainty_m, 0.003);
  EXPECT_EQ(truth.description, in_truth("truth.json"));
  EXPECT_TRUE(truth.masks.empty());
}

TEST_F(TruthFolders, NeedNoDescription) {
  for (const char* name : {"b10.stl", "b9.PLY", "a.obj", "scene.obj", "poses.txt", "overlay.jpg", ".b.obj"})
    write(name);
  const TruthFolder truth = find();
  EXPECT_EQ(names_of(truth), (Names{"a", "b9", "b10"}));
  EXPECT_EQ(truth.objects[1].mesh, in_truth("b9.PLY"));
  for (const TruthObjectFiles& object : truth.objects) {
    EXPECT_EQ(object.poses, in_truth("poses.txt"));
    EXPECT_EQ(object.closed, std::nullopt);
  }
  EXPECT_TRUE(std::isnan(truth.uncertainty_m));
  EXPECT_TRUE(truth.description.empty());
}

TEST_F(TruthFolders, UseTheSceneIfItIsTheOnlyMesh) {
  write("scene.obj"), write("poses.txt");
  EXPECT_EQ(names_of(find()), Names{"scene"});
}

TEST_F(TruthFolders, ListTheirFilesInOneOrder) {
  for (const char* name : {"b.obj", "a.obj", "poses.txt", "mask/10.png", "mask/9.png", "mask/.8.png",
                           "mask/notes.txt", "residuals.csv"})
    write(name);
  TruthFolder truth = find();
  EXPECT_EQ(truth.masks, in_truth("mask"));
  EXPECT_EQ(mask_files(truth), (Paths{in_truth("mask/9.png"), in_truth("mask/10.png")}));
  EXPECT_EQ(files_of(truth), (Paths{in_truth("a.obj"), in_truth("poses.txt"), in_truth("b.obj"),
                                    in_truth("mask/9.png"), in_truth("mask/10.png")}));
  folder_.write("truth/truth.json",
                R"({"objects": [{"name": "one", "mesh": "b.obj", "poses": "poses.txt"},
                                {"name": "two", "mesh": "b.obj", "poses": "poses.txt"}]})");
  fs::remove_all(in_truth("mask"));
  truth = find();
  EXPECT_TRUE(mask_files(truth).empty());
  EXPECT_EQ(files_of(truth), (Paths{in_truth("truth.json"), in_truth("b.obj"), in_truth("poses.txt")}));
}

TEST_F(TruthFolders, AreRefusedWithoutDescriptionOrPosesOfAMesh) {
  const std::string part = "has neither truth.json nor poses.txt with a mesh";
  write("notes.md");
  expect_refused("", part);
  write("poses.txt");
  expect_refused("", part);
  fs::remove(in_truth("poses.txt"));
  write("cube.obj");
  expect_refused("", part);
  fs::create_directory(in_truth("poses.txt"));
  expect_refused("", part);
}

TEST_F(TruthFolders, AreRefusedWithTwoObjectsOfOneName) {
  write("cube.obj"), write("cube.ply"), write("poses.txt");
  expect_refused("", "two objects have the name 'cube'");
  expect_json_refused(R"({"objects": [{"name": "c", "mesh": "cube.obj", "poses": "poses.txt"},
                                      {"name": "c", "mesh": "cube.ply", "poses": "poses.txt"}]})",
                      "two objects have the name 'c'");
}

TEST_F(TruthFolders, AreRefusedWithAnEmptyFolderOfMasks) {
  write("cube.obj"), write("poses.txt"), write("mask/0000.jpg");
  expect_refused("mask", "has no .png file");
}

// The truth would hold at all pixels without its masks.
TEST_F(TruthFolders, AreRefusedIfTheMasksAreNoFolder) {
  write("cube.obj"), write("poses.txt"), write("mask");
  expect_refused("mask", "is not a folder");
  for (const char* target : {"/dev/zero", "nowhere"}) {
    fs::remove(in_truth("mask"));
    fs::create_symlink(target, in_truth("mask"));
    expect_refused("mask", "is not a folder");
  }
}

TEST_F(TruthFolders, AreRefusedIfTheDescriptionIsOfAnotherForm) {
  write("cube.obj"), write("poses.txt");
  expect_json_refused("", "expected JSON");
  expect_json_refused("{", "expected JSON");
  expect_json_refused("[]", "is of type array: expected object");
  expect_json_refused("{}", "has no key 'objects'");
  expect_json_refused(R"({"objects": {}})", "objects = {}: expected a list of one object or more");
  expect_json_refused(R"({"objects": []})", "objects = []: expected a list of one object or more");
  expect_json_refused(R"({"objects": [], "units": "m"})",
                      R"(key "units": expected ["objects","uncertainty_m"])");
  expect_json_refused(R"({"objects": [3]})", "objects[0]: is of type number: expected object");
  fs::remove(in_truth("truth.json"));
  fs::create_symlink("none.json", in_truth("truth.json"));
  expect_refused("truth.json", "cannot be read");
}

TEST_F(TruthFolders, AreRefusedIfTheUncertaintyIsNoLength) {
  write("cube.obj"), write("poses.txt");
  for (const char* value : {"-0.001", "\"3 mm\"", "null", "[0.003]"})
    expect_object_refused("]}", "], \"uncertainty_m\": " + std::string(value) + "}",
                          "uncertainty_m = " + std::string(value) + ": expected a number of 0 or more");
  expect_object_refused("]}", "], \"uncertainty_m\": 1e999}", "expected");
}

TEST_F(TruthFolders, AreRefusedIfAnObjectIsOfAnotherForm) {
  write("cube.obj"), write("poses.txt");
  expect_object_refused("\"mesh\"", "\"file\"",
                        R"(objects[0]: key "file": expected ["name","mesh","poses","closed"])");
  expect_object_refused("\"name\": \"cube\", ", "", "objects[0]: has no key 'name'");
  expect_object_refused("\"mesh\": \"cube.obj\", ", "", "objects[0]: has no key 'mesh'");
  expect_object_refused(", \"poses\": \"poses.txt\"", "", "objects[0]: has no key 'poses'");
  expect_object_refused("\"cube\"", "\"\"", "objects[0]: name = \"\": expected a text");
  expect_object_refused("\"cube.obj\"", "7", "objects[0]: mesh = 7: expected a text");
  expect_object_refused("\"poses.txt\"", "[]", "objects[0]: poses = []: expected a text");
  expect_object_refused("\"poses.txt\"", "\"poses.txt\", \"closed\": 1",
                        "objects[0]: closed = 1: expected true, false");
}

TEST_F(TruthFolders, AreRefusedIfAFileIsElsewhere) {
  write("cube.obj"), write("poses.txt"), folder_.write("outside.obj", "");
  const fs::path absolute = in_truth("cube.obj");
  for (const std::string& name : {std::string("../outside.obj"), std::string("parts/../cube.obj"),
                                  absolute.string(), std::string("..")})
    expect_object_refused("\"cube.obj\"", "\"" + name + "\"", "expected a file inside truth/");
  expect_object_refused("cube.obj", "cube.obj\\u0000", "expected a file inside truth/");
  expect_object_refused("cube.obj", "ball.obj", "objects[0]: mesh: no file " + in_truth("ball.obj").string());
  expect_object_refused("poses.txt", "none.txt",
                        "objects[0]: poses: no file " + in_truth("none.txt").string());
  expect_object_refused("cube.obj", ".", "objects[0]: mesh: no file");
}

}  // namespace
}  // namespace remote_touch::truth_folder_test
