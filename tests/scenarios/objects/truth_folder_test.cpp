// The folder truth/ of a recording and its masks: what is found in it, the pixels at which the truth holds,
// and what is refused.
#include "scenarios/objects/recorded_truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"
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
  for (const char* name : {"b10.stl", "b9.PLY", "a.obj"}) fs::remove(in_truth(name));
  EXPECT_EQ(names_of(find()), Names{"scene"}) << "it is the only mesh";
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

// The subject of each refusal is truth.json.
TEST_F(TruthFolders, AreRefusedIfTheDescriptionIsOfAnotherForm) {
  write("cube.obj"), write("poses.txt"), write("cube.ply"), folder_.write("outside.obj", "");
  const std::pair<std::string, std::string> texts[] = {
      {"", "expected JSON"},
      {"[]", "is of type array: expected object"},
      {"{}", "has no key 'objects'"},
      {R"({"objects": {}})", "objects = {}: expected a list of one object or more"},
      {R"({"objects": []})", "objects = []: expected a list of one object or more"},
      {R"({"objects": [], "units": "m"})", R"(key "units": expected ["objects","uncertainty_m"])"},
      {R"({"objects": [3]})", "objects[0]: is of type number: expected object"},
      {R"({"objects": [{"name": "c", "mesh": "cube.obj", "poses": "poses.txt"},
                       {"name": "c", "mesh": "cube.ply", "poses": "poses.txt"}]})",
       "two objects have the name 'c'"},
  };
  for (const auto& [json, text] : texts)
    folder_.write("truth/truth.json", json), expect_refused("truth.json", text);
  struct Row {
    std::string part, by, text;  // the part is replaced in the description of one object
  };
  const std::string inside = "expected a file inside truth/";
  const Row rows[] = {
      {"\"mesh\"", "\"file\"", R"(objects[0]: key "file": expected ["name","mesh","poses","closed"])"},
      {"\"name\": \"cube\", ", "", "objects[0]: has no key 'name'"},
      {"\"mesh\": \"cube.obj\", ", "", "objects[0]: has no key 'mesh'"},
      {", \"poses\": \"poses.txt\"", "", "objects[0]: has no key 'poses'"},
      {"\"cube\"", "\"\"", "objects[0]: name = \"\": expected a text"},
      {"\"cube.obj\"", "7", "objects[0]: mesh = 7: expected a text"},
      {"\"poses.txt\"", "\"poses.txt\", \"closed\": 1", "objects[0]: closed = 1: expected true, false"},
      {"cube.obj", "../outside.obj", inside},
      {"cube.obj", "parts/../cube.obj", inside},
      {"cube.obj", in_truth("cube.obj").string(), inside},
      {"cube.obj", "..", inside},
      {"cube.obj", "cube.obj\\u0000", inside},
      {"cube.obj", "ball.obj", "objects[0]: mesh: no file " + in_truth("ball.obj").string()},
      {"poses.txt", "none.txt", "objects[0]: poses: no file " + in_truth("none.txt").string()},
      {"cube.obj", ".", "objects[0]: mesh: no file"},
      {"]}", R"(], "uncertainty_m": -0.001})", "uncertainty_m = -0.001: expected a number of 0 or more"},
      {"]}", R"(], "uncertainty_m": "3 mm"})", "uncertainty_m = \"3 mm\": expected a number of 0 or more"},
  };
  for (const Row& row : rows) {
    std::string json = R"({"objects": [{"name": "cube", "mesh": "cube.obj", "poses": "poses.txt"}]})";
    folder_.write("truth/truth.json", json.replace(json.find(row.part), row.part.size(), row.by));
    expect_refused("truth.json", row.text);
  }
  fs::remove(in_truth("truth.json"));
  fs::create_symlink("none.json", in_truth("truth.json"));
  expect_refused("truth.json", "cannot be read");
}

TEST_F(TruthFolders, AreRefusedIfAPartIsMissing) {
  const std::string neither = "has neither truth.json nor poses.txt with a mesh";
  write("notes.md"), expect_refused("", neither);
  write("poses.txt"), expect_refused("", neither);
  fs::remove(in_truth("poses.txt")), write("cube.obj"), expect_refused("", neither);
  fs::create_directory(in_truth("poses.txt")), expect_refused("", neither);
  fs::remove(in_truth("poses.txt")), write("poses.txt"), write("mask/0000.jpg");
  expect_refused("mask", "has no .png file");
  write("cube.ply"), expect_refused("", "two objects have the name 'cube'");
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

const CameraIntrinsics kCamera = {4, 3, 10, 20, 1.5, 1};
const Vec3 kCentre = unproject(kCamera, 1, 1, 2);  // a position at pixel (1, 1)
const std::vector<std::uint8_t> kAll(12, 255), kNone(12, 0);

class Masks : public testing::Test {
 protected:
  // A mask of 4 x 3 pixels or another width.
  void write(const std::string& name, const std::vector<std::uint8_t>& grey, int width = 4) const {
    const int height = static_cast<int>(grey.size()) / width;
    folder_.write_png("mask/" + name, width, height, PNG_FORMAT_GRAY, grey.data());
  }
  TruthMasks masks(const std::vector<std::string>& frames, const CameraIntrinsics& camera = kCamera) const {
    TruthFolder truth;
    truth.masks = folder_ / "mask";
    return {truth, frames, camera};
  }
  // Masks of frames that are numbered from 0.
  TruthMasks masks(std::size_t frames, const CameraIntrinsics& camera = kCamera) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < frames; ++i) names.push_back(std::to_string(i) + ".png");
    return masks(names, camera);
  }
  std::string why(std::size_t frames) const {
    return refusal([&] { masks(frames).holds_at(0, kCentre); });
  }

  const TestFolder folder_{"truth_masks_test"};
};

// A pixel reaches half a pixel to each side of its centre.
TEST_F(Masks, HoldAtTheirPixelsThatAreNeitherBlackNorTransparent) {
  const std::vector<std::uint8_t> grey = {0, 255, 0, 1, 7, 0, 0, 0, 0, 0, 128, 0};
  write("0000.png", grey);
  std::vector<std::uint8_t> rgba;
  for (const std::uint8_t value : grey) rgba.insert(rgba.end(), {9, 9, 9, value});
  for (const bool is_transparent : {false, true}) {
    if (is_transparent) folder_.write_png("mask/0000.png", 4, 3, PNG_FORMAT_RGBA, rgba.data());
    const TruthMasks one = masks(1);
    for (int v = 0; v < 3; ++v)
      for (int u = 0; u < 4; ++u)
        for (const double off : {-0.49, 0.0, 0.49})
          for (const double z_m : {0.1, 1.0, 30.0})
            EXPECT_EQ(one.holds_at(0, unproject(kCamera, u + off, v - off, z_m)), grey[4 * v + u] != 0)
                << u << " " << v << " " << off;
  }
}

TEST_F(Masks, HoldNowhereOutsideTheImageAndEverywhereWithoutAFolder) {
  write("0000.png", kAll);
  const TruthMasks one = masks(1), none(TruthFolder{}, std::vector<std::string>(3), {});
  for (const auto& [u, v] : {std::pair(-0.51, 1.0), {3.51, 1.0}, {1.0, -0.51}, {1.0, 2.51}, {1e300, 1.0}})
    EXPECT_FALSE(one.holds_at(0, unproject(kCamera, u, v, 1))) << u << " " << v;
  for (const Vec3& p_C : {unproject(kCamera, 1, 1, -1), Vec3(0, 0, 0), Vec3(NAN, NAN, NAN)}) {
    EXPECT_FALSE(one.holds_at(0, p_C));
    EXPECT_TRUE(none.holds_at(2, p_C));
  }
}

// The first frame has the number 1, and a mask of every other frame is missing.
TEST_F(Masks, BelongToTheFramesWithTheirNumbers) {
  std::vector<std::string> frames;
  for (int i = 1; i <= 6; ++i) frames.push_back("frame-00000" + std::to_string(i) + ".depth.png");
  write("m_1.png", kAll), write("m_3.png", kNone), write("m_0005.png", kAll);
  const TruthMasks some = masks(frames);
  const std::vector<bool> expected = {true, false, false, false, true, false};
  for (std::size_t frame = 0; frame < 6; ++frame) EXPECT_EQ(some.holds_at(frame, kCentre), expected[frame]);
}

// The names are frame_object. There are as many masks as frames, but two are those of one frame.
TEST_F(Masks, OfSeveralObjectsAreJoined) {
  std::vector<std::uint8_t> left(12, 0), right(12, 0);
  left[5] = 255, right[6] = 255;
  write("000001_000000.png", left), write("000001_000001.png", right), write("000002_000001.png", right);
  const TruthMasks three = masks({"000001.png", "000002.png", "000003.png"});
  const Vec3 other = unproject(kCamera, 2, 1, 2);
  EXPECT_TRUE(three.holds_at(0, kCentre) && three.holds_at(0, other));
  EXPECT_TRUE(!three.holds_at(1, kCentre) && three.holds_at(1, other));
  EXPECT_TRUE(!three.holds_at(2, kCentre) && !three.holds_at(2, other));
}

// More masks than are kept in memory, in an order that reads each of them several times.
TEST_F(Masks, StayWithTheirFrames) {
  for (int i = 0; i < 12; ++i) write("m" + std::to_string(i) + ".png", i % 3 == 0 ? kAll : kNone);
  const TruthMasks many = masks(12);
  for (std::size_t i = 0; i < 200; ++i) {
    const std::size_t frame = i * i * 7 % 12;
    ASSERT_EQ(many.holds_at(frame, kCentre), frame % 3 == 0) << frame;
    ASSERT_EQ(many.holds_at(i % 12, kCentre), i % 12 % 3 == 0) << i;
  }
}

// Reading an image a second time would fail.
TEST_F(Masks, AreReadOnceAndNotBeforeTheyAreNeeded) {
  write("0.png", kAll);
  const TruthMasks two = [&] {
    write("1.png", kNone);
    return masks(2);
  }();
  EXPECT_TRUE(two.holds_at(0, kCentre));
  fs::remove_all(folder_ / "mask");
  EXPECT_TRUE(two.holds_at(0, kCentre));
  EXPECT_HAS(refusal([&] { two.holds_at(1, kCentre); }), "1.png: cannot be read");
}

TEST_F(Masks, AreRefusedIfTheyDoNotFitTheFrames) {
  const auto why_not = [&](const std::vector<const char*>& names) {
    fs::remove_all(folder_ / "mask");
    for (const char* name : names) write(name, kAll);
    return why(3);
  };
  for (const char* name : {"3.png", "mask.png", "3_1.png", "99999999999999999999.png"})
    EXPECT_EQ(why_not({name}).rfind((folder_ / "mask" / name).string() +
                                        ": its name has the number of no frame: expected names with the ",
                                    0),
              0u);
  for (const char* more : {"01.png", "1_7.png"})
    EXPECT_HAS(why_not({"1.png", more}), "frame 1 has another mask");
  EXPECT_HAS(refusal([&] {
               masks(Names{"a1.png", "b1.png"});
             }),
             "it is not clear which of its files belong to a1.png and which to b1.png");
  EXPECT_EQ(refusal([&] { masks(Names{"0.png"}, {}); }),
            (folder_ / "mask").string() + ": the frames are not images: expected no masks");
  fs::remove_all(folder_ / "mask");
  write("0.png", kAll, 3);
  EXPECT_EQ(why(1), (folder_ / "mask/0.png").string() +
                        ": has 3 x 4 pixels: expected 4 x 3 pixels, as the camera has");
  const std::vector<std::uint16_t> deep(12, 1);
  folder_.write_png("mask/0.png", 4, 3, PNG_FORMAT_LINEAR_Y, deep.data());
  EXPECT_HAS(why(1), "expected up to 8 bits a channel");
  folder_.write("mask/0.png", "no image");
  EXPECT_HAS(why(1), "0.png: is not a whole PNG file");
}

}  // namespace
}  // namespace remote_touch::truth_folder_test
