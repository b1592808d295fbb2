// The pairing of colour images with depth images of a folder.
#include "scenarios/recordings/image_folders.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::image_folders_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

class FolderFiles : public testing::Test {
 protected:
  void write(const Names& names) const {
    for (const std::string& name : names) folder_.write(name, "");
  }
  // Returns the names of the colour images, in the order of the depth images.
  Names colours() const {
    Names names;
    for (const fs::path& file : colour_images(files_in_order(folder_ / "depth", ".png"), folder_ / "rgb"))
      names.push_back(file.filename().string());
    return names;
  }
  std::string error() const {
    return refusal([&] { colours(); });
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const TestFolder folder_{"folder_files_test"};
};

TEST_F(FolderFiles, EqualNamesBelongTogether) {
  write({"depth/1.png", "depth/2.png"});
  EXPECT_EQ(colours(), (Names{"", ""})) << "there are no colour images";
  write({"rgb/2.png", "rgb/a1.png"});
  EXPECT_EQ(colours(), (Names{"", "2.png"}));
}

TEST_F(FolderFiles, OtherNamesBelongTogetherByTheirNumbers) {
  write({"depth/frame-9.depth.png", "depth/frame-10.depth.png", "depth/frame-11.depth.png"});
  write({"rgb/f010.color.png", "rgb/f9.color.png"});
  EXPECT_EQ(colours(), (Names{"f9.color.png", "f010.color.png", ""}));
}

TEST_F(FolderFiles, AllNumbersCount) {
  write({"depth/k2_0001.png", "depth/k3_0001.png", "rgb/3_1.png", "rgb/2_1.png"});
  EXPECT_EQ(colours(), (Names{"2_1.png", "3_1.png"}));
  fs::remove(folder_ / "rgb/2_1.png"), fs::remove(folder_ / "rgb/3_1.png");
  write({"rgb/1.png"});
  EXPECT_HAS(error(),
             path("rgb/1.png") + ": it is not clear whether it belongs to " + path("depth/k2_0001.png"));
}

TEST_F(FolderFiles, ColourImagesWithoutExactlyOnePartnerAreRefused) {
  write({"depth/a_1.png", "depth/a_2.png", "rgb/1.jpg"});
  EXPECT_HAS(error(),
             path("rgb") + ": holds no .png file: expected the colour images of " + path("depth/a_1.png"));
  write({"rgb/7.png"});
  EXPECT_HAS(error(), path("rgb/7.png") + ": it is not clear whether it belongs to " + path("depth/a_1.png"));
  write({"rgb/b_1.png", "rgb/c_01.png"});
  EXPECT_HAS(error(),
             path("rgb/c_01.png") + ": it is not clear whether it belongs to " + path("depth/a_1.png"));
  fs::remove(folder_ / "rgb/c_01.png");
  EXPECT_EQ(colours(), (Names{"b_1.png", ""}));
  write({"depth/z_1.png"});
  EXPECT_HAS(error(),
             path("rgb/b_1.png") + ": it is not clear whether it belongs to " + path("depth/z_1.png"));
}

TEST_F(FolderFiles, LinksToNothingAreRefused) {
  write({"depth/1.png", "rgb/1.png"});
  for (const char* name : {"depth/2.png", "rgb/2.png", "rgb"}) {
    fs::remove_all(folder_ / name);
    fs::create_symlink("nowhere", folder_ / name);
    EXPECT_HAS(error(), path(name) + ": is a link to a file that does not exist: expected a file");
    fs::remove(folder_ / name);
  }
}

}  // namespace
}  // namespace remote_touch::image_folders_test
