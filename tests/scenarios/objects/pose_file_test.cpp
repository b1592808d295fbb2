// Files of poses: what is read, and what is refused with its line.
#include "scenarios/objects/mesh_object.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "tests/support/note_kinds.h"
#include "tests/support/test_files.h"

namespace remote_touch::pose_file_test {
namespace {

namespace fs = std::filesystem;

// A quarter turn about z: x of the object is y of the camera.
const std::string kQuarterTurn = "0 -1 0 0.1 1 0 0 0.2 0 0 1 0.3 0 0 0 1";
const std::string kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
const std::string kUnknown = "nan nan nan nan nan nan nan nan nan nan nan nan nan nan nan nan";

std::string line_of(const Eigen::Matrix3d& R, const Vec3& position_m, const char* format) {
  std::string line;
  char number[64];
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const double last_row = column == 3 ? 1 : 0;
      const double value = row == 3 ? last_row : column == 3 ? position_m[row] : R(row, column);
      std::snprintf(number, sizeof number, format, value);
      line += (line.empty() ? "" : " ") + std::string(number);
    }
  return line + "\n";
}

Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return q.normalized().toRotationMatrix();
}

double error_of(const Eigen::Matrix3d& R) {
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

class PoseFiles : public testing::Test {
 protected:
  std::vector<std::optional<RigidTransform>> read(const std::string& bytes) const {
    return read_poses(folder_.write("poses.txt", bytes), PoseLines::of_frames).poses;
  }
  PosePath read_path(const std::string& bytes) const {
    const PoseFile poses = read_poses(folder_.write("path.txt", bytes), PoseLines::stamped);
    return path_of(poses, poses.stamps_s.front());
  }

  const TestFolder folder_{"pose_file_test"};
};

TEST_F(PoseFiles, OfFramesAreReadRowByRow) {
  const auto poses = read("\xEF\xBB\xBF# r00 r01\r\n" + kIdentity + "\r\n  # more\r\n\t" + kQuarterTurn +
                          " \r\n" + kUnknown + "\n+1 0.0 -0 1e-2 0 1.0E0 0 +2.5e-1 0 0 1 -.5 0 0 0 1.");
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_TRUE(poses[0]->matrix().isIdentity(0));
  EXPECT_LT((*poses[1] * Vec3(1, 0, 0) - Vec3(0.1, 1.2, 0.3)).norm(), 1e-15);
  EXPECT_LT((*poses[1] * Vec3(0, 1, 0) - Vec3(-0.9, 0.2, 0.3)).norm(), 1e-15);
  EXPECT_EQ(poses[1]->translation(), Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(poses[1]->matrix().row(3), Eigen::RowVector4d(0, 0, 0, 1));
  EXPECT_FALSE(poses[2]) << "not known";
  EXPECT_EQ(poses[3]->translation(), Vec3(0.01, 0.25, -0.5));
  for (const char* nothing : {"", "# nothing\n"}) EXPECT_EQ(read(nothing).size(), 0u);
}

// The digits of a file are few. The result is the nearest rotation, which the singular values give.
TEST_F(PoseFiles, BecomeTheNearestRotation) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-2e-4, 2e-4);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d R = random_rotation(random);
    const Eigen::Matrix3d rounded = read(line_of(R, {1, 2, 3}, "%.8f")).at(0)->linear();
    EXPECT_LT(error_of(rounded), 2e-15);
    EXPECT_LT((rounded - R).cwiseAbs().maxCoeff(), 1e-8);
    Eigen::Matrix3d bent = R;
    for (double& value : bent.reshaped()) value += off(random);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(bent, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d nearest = read(line_of(bent, {1, 2, 3}, "%.17g")).at(0)->linear();
    EXPECT_LT(error_of(nearest), 2e-15);
    EXPECT_LT((nearest - svd.matrixU() * svd.matrixV().transpose()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST_F(PoseFiles, MayNameTheirColumnsInTheFirstComment) {
  const std::string names = "# frame r00 r01 r02 tx r10 r11 r12 ty r20 r21 r22 tz error\n";
  const auto poses = read(names + "0 0 -1 0 0.1 1 0 0 0.2 0 0 1 0.3 0.4\n# a break\n" +
                          "1 nan nan nan nan nan nan nan nan nan nan nan nan 0.4\n");
  ASSERT_EQ(poses.size(), 2U);
  ASSERT_TRUE(poses[0]);
  EXPECT_EQ(poses[0]->matrix(), read(kQuarterTurn)[0]->matrix());
  EXPECT_FALSE(poses[1]);
}

// One row for each refusal: the line, and what is wrong in it.
TEST_F(PoseFiles, OfFramesAreRefused) {
  struct Row {
    std::string bytes, line, text;
  };
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d sheared = I, mirror = I;
  sheared(0, 1) = 0.0011, mirror(2, 2) = -1;
  const auto of = [](const Eigen::Matrix3d& R) { return line_of(R, Vec3::Zero(), "%.17g"); };
  const std::string rows_of_pose = "1 0 0 0 0 1 0 0 0 0 1 0 ", rest = kIdentity.substr(1),
                    rigid = "expected a rigid pose";
  const std::string frame_names = "# frame r00 r01 r02 tx r10 r11 r12 ty r20 r21 r22 tz error\n";
  const std::string stamped_names = "# t tx ty tz qx qy qz qw\n";
  std::vector<Row> rows = {
      {kIdentity + "\n" + of(1.001 * I), "2", rigid},
      {of(1e200 * I), "1", rigid},
      {of(0 * I), "1", rigid},
      {of(sheared), "1", rigid},
      {of(mirror), "1", "mirrors"},
      {rows_of_pose + "0 0 0 1.000002", "1", "the last row is not 0 0 0 1"},
      {rows_of_pose + "0 0 -0.5 1", "1", "the last row is not 0 0 0 1"},
      {rows_of_pose + "0.1 0.2 0.3 1", "1", "row by row"},  // column by column: the translation is there
      {rows_of_pose + "0 0 0 inf", "1", "has a number that is not finite"},
      {kIdentity + "\n" + kIdentity + " 0\n", "2", "has 17 words: expected 16 numbers"},
      {"# comment\n1 0 0 0 0 1 0 0 0 0 1 0\n", "2", "has 12 words"},
      {kIdentity + "\n\n" + kIdentity + "\n", "2", "is empty"},
      {"\n" + kIdentity + "\n", "1", "is empty"},
      {"nan" + rest, "1", "has nan beside numbers"},
      {"inf" + rest, "1", "has a number that is not finite"},
      {"1 0 0 0 0 1 0 -1001 0 0 1 0 0 0 0 1", "1", "more than 1000 m from the origin"},
      {"1 0 0 0 0 1 0 -2000 0 0 1 0 0 0 0 1", "1", "; positions may be millimetres instead of metres"},
      {frame_names + "1 0 -1 0 0.1 1 0 0 0.2 0 0 1 0.3 0.4\n", "2", "is for frame 1: expected frame 0"},
      {frame_names + "0 0 -1 0 0.1 1 0 0 0.2 0 0 1 0.3\n", "2", "has 13 words: expected 14"},
      {stamped_names + "0 0 0 0 0 0 0 1\n", "2", "has a time: expected one pose for each frame"},
  };
  for (const char* word : {"0x1", "1,0", "1.0f", "one", "--1", "+-1", "+", "1e999"})
    rows.push_back({word + rest, "1", std::string("'") + word + "': expected a number"});
  for (const Row& row : rows) {
    const std::string text = refusal([&] { read(row.bytes); });
    EXPECT_EQ(text.rfind((folder_ / "poses.txt").string() + ":" + row.line + ": ", 0), 0u) << text;
    EXPECT_HAS(text, row.text);
  }
  EXPECT_TRUE(read(of(1.0004 * I))[0]) << "1.0004^2 - 1 = 0.0008";
  EXPECT_TRUE(read(rows_of_pose + "0 0 0 1.0000009")[0]);
  EXPECT_TRUE(read("1 0 0 1000 0 1 0 0 0 0 1 0 0 0 0 1")[0]);
  EXPECT_EQ(read(kIdentity + "\n \t\r\n\n").size(), 1u);
}

TEST_F(PoseFiles, WithStampsAreRefused) {
  struct Row {
    std::string bytes, line, text;
  };
  const std::string good = "0 0 0 0 0 0 0 1\n", rest = " 0 0 0 0 0 0 1\n";
  const Row rows[] = {
      {"1" + rest + "# comment\n2" + rest + "1.5" + rest, "4", "below that of the line before"},
      {"-1e13" + rest, "1", "its time is above 1e12"},
      {"inf" + rest, "1", "has a number that is not finite"},
      {good + "1 0 0 0 0 0 0\n", "2", "has 7 words: expected lines 't tx ty tz qx qy qz qw'"},
      {good + "1 0 0 0 0 0 0 1 0\n", "2", "has 9 words"},
      {good + "1,0 0 0 0 0 0 0 1\n", "2", "'1,0' in column t: expected a number"},
      {good + "1 0 nan 0 0 0 0 1\n", "2", "has a number that is not finite"},
      {good + "1 0 0 1001 0 0 0 1\n", "2", "more than 1000 m from the origin"},
      {"0 0 0 0 0 0 0 0.98\n", "1", "its quaternion has the norm 0.98"},
      {"0 0 0 0 0 0 0 1.02\n", "1", "expected 1, within 0.01"},
      {"# t tx ty qx qy qz qw\n", "1", "names some columns of a pose: expected tx ty tz"},
      {"# t tx ty tz qx qy qz\n", "1", "names some columns of a pose"},
      {"# t tx ty tz qx qy qz qw x_mm\n", "1", "column x_mm: expected one column of tx"},
      {"# tx ty tz qx qy qz qw\n0 0 0 0 0 0 1\n", "2", "has no time"},
  };
  const std::string file = (folder_ / "path.txt").string();
  for (const Row& row : rows) {
    const std::string text = refusal([&] { read_path(row.bytes); });
    EXPECT_EQ(text.rfind(file + ":" + row.line + ": ", 0), 0u) << text;
    EXPECT_HAS(text, row.text);
  }
  for (const char* bytes : {"", "# nothing\n", "\n\n"})
    EXPECT_HAS(refusal([&] { read_path(bytes); }), file + ": has no pose");
  for (const PoseLines lines : {PoseLines::stamped, PoseLines::of_frames})
    EXPECT_HAS(refusal([&] { read_poses(folder_ / "none.txt", lines); }), "none.txt: cannot be read");
}

// The quaternion's real part is the last number. (0, 0, s, s) is a quarter turn about z.
TEST_F(PoseFiles, AreReadInTheFormatOfTum) {
  const PosePath path =
      read_path("\xEF\xBB\xBF# timestamp tx ty tz qx qy qz qw\r\n1305031102.25 1 2 3 0 0 0 1\r\n\r\n" +
                std::string("1305031102.75 2 2 3 0 0 0.7071067811865476 0.7071067811865476\r\n"));
  ASSERT_EQ(path.poses().size(), 2u);
  EXPECT_EQ(path.poses()[0].time_s, 0);
  EXPECT_EQ(path.duration_s(), 0.5);
  EXPECT_TRUE(path.at(0).linear().isIdentity(0));
  EXPECT_EQ(path.at(0).translation(), Vec3(1, 2, 3));
  EXPECT_LT((path.at(1) * Vec3(1, 0, 0) - Vec3(2, 3, 3)).norm(), 1e-15);
  const double half = std::sqrt(0.5);
  EXPECT_LT((path.at(0.25) * Vec3(1, 0, 0) - Vec3(1.5 + half, 2 + half, 3)).norm(), 4e-15);
}

TEST_F(PoseFiles, HaveTheirQuaternionsNormalised) {
  const Eigen::Matrix3d R = read_path("0 0 0 0 0.6 0 0 0.806").at(0).linear();
  EXPECT_LT(error_of(R), 1e-15);
  const Eigen::Matrix3d expected = Eigen::Quaterniond(0.806, 0.6, 0, 0).normalized().toRotationMatrix();
  EXPECT_LT((R - expected).norm(), 1e-15);
}

TEST_F(PoseFiles, OfEqualTimesAreReadOnceWithANote) {
  const fs::path file = folder_.write("path.txt", "1 0 0 0 0 0 0 1\n1 5 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  const PoseFile poses = read_poses(file, PoseLines::stamped);
  ASSERT_EQ(poses.poses.size(), 2u);
  EXPECT_EQ(poses.poses[0]->translation(), Vec3::Zero());
  ASSERT_EQ(kinds_of(poses.notes), Kinds{"unusual poses"});
  EXPECT_HAS(poses.notes[0].text, "1 line(s) have the time of the line before");
}

// The numbers of some poses by the names of their columns.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  std::string text(const std::vector<std::size_t>& order, bool is_comment) const {
    std::string text = is_comment ? "# " : "";
    for (const std::size_t column : order) text += names[column] + " ";
    for (const std::vector<std::string>& row : rows) {
      text += "\n";
      for (const std::size_t column : order) text += row[column] + " ";
    }
    return text + "\n";
  }
};

Table random_table(bool has_quaternions, std::mt19937& random) {
  std::uniform_real_distribution<double> place(-3, 3);
  Table table{{"timestamp", "tx", "ty", "tz"}, {}};
  const std::vector<std::string> of_quaternion = {"qx", "qy", "qz", "qw"};
  const std::vector<std::string> of_matrix = {"r00", "r01", "r02", "r10", "r11", "r12", "r20", "r21", "r22"};
  for (const std::string& name : has_quaternions ? of_quaternion : of_matrix) table.names.push_back(name);
  table.names.push_back("error");
  const auto text_of = [](double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return std::string(text);
  };
  for (int i = 0; i < 5; ++i) {
    const Eigen::Matrix3d R = random_rotation(random);
    const Eigen::Quaterniond q(R);
    std::vector<double> values = {0.1 * i, place(random), place(random), place(random)};
    if (has_quaternions)
      values.insert(values.end(), {q.x(), q.y(), q.z(), q.w()});
    else
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) values.push_back(R(row, column));
    values.push_back(0.25);
    table.rows.emplace_back();
    for (const double value : values) table.rows.back().push_back(text_of(value));
  }
  return table;
}

// The same columns in any order, with their names, are the same poses to the last bit.
TEST_F(PoseFiles, AreReadByTheNamesOfTheirColumnsInAnyOrder) {
  std::mt19937 random(11);
  for (const bool has_quaternions : {true, false}) {
    const Table table = random_table(has_quaternions, random);
    std::vector<std::size_t> order(table.names.size());
    std::iota(order.begin(), order.end(), 0u);
    const PosePath expected = read_path(table.text(order, true));
    ASSERT_EQ(expected.poses().size(), 5u);
    for (int i = 0; i < 50; ++i) {
      std::shuffle(order.begin(), order.end(), random);
      const PosePath path = read_path(table.text(order, i % 2 == 0));
      for (std::size_t k = 0; k < 5; ++k) {
        EXPECT_EQ(path.poses()[k].time_s, expected.poses()[k].time_s);
        EXPECT_EQ(path.poses()[k].X.matrix(), expected.poses()[k].X.matrix());
      }
    }
  }
}

TEST_F(PoseFiles, HaveTheUnitsOfTheirColumns) {
  for (const char* names :
       {"# t_ms tx_mm ty_mm tz_mm qx qy qz qw", "#Time\t[ms], P_X [mm], py_mm, z (mm), qx [], qy, qz, qw"}) {
    const PosePath path = read_path(std::string(names) + "\n500 250 -750 1000 0 0 0 1\n1500 0 0 0 0 0 0 1\n");
    EXPECT_EQ(path.poses()[0].X.translation(), Vec3(0.25, -0.75, 1));
    EXPECT_DOUBLE_EQ(path.duration_s(), 1);
  }
  const fs::path file = folder_.write("path.txt", "# camera poses in mm.\n0 0 0 0 0 0 0 1\n");
  const PoseFile poses = read_poses(file, PoseLines::stamped);
  ASSERT_EQ(kinds_of(poses.notes), Kinds{"unusual poses"});
  EXPECT_HAS(poses.notes[0].text, "path.txt:1: the comment says 'mm', which is not read");
}

std::vector<Note> notes_on(const std::vector<double>& times_s, const Vec3& step_m,
                           const Eigen::Quaterniond& turn) {
  std::vector<StampedPose> poses;
  for (const double time_s : times_s) {
    poses.push_back({time_s});
    poses.back().X.linear() = turn.toRotationMatrix();
    poses.back().X.translation() = static_cast<double>(poses.size() - 1) * step_m;
  }
  return unusual_poses("a.txt", poses, true);
}

TEST(PosesOfFiles, ThatAreImprobableAreReportedWithTheirLikelyCause) {
  const std::vector<double> at_30_hz = {0, 0.0333, 0.0667, 0.1};
  const Eigen::Quaterniond tilted = Eigen::Quaterniond(0.9, 0.3, 0.2, -0.1).normalized();
  const Eigen::Quaterniond reordered(tilted.z(), tilted.w(), tilted.x(), tilted.y());  // read with qw first
  EXPECT_TRUE(notes_on(at_30_hz, {0.02, 0, 0}, tilted).empty());
  const auto expect_note = [](const std::vector<Note>& notes, const std::string& part) {
    ASSERT_FALSE(notes.empty()) << part;
    EXPECT_EQ(notes.front().kind, "unusual poses");
    EXPECT_HAS(notes.front().text, part);
  };
  expect_note(notes_on(at_30_hz, {20, 0, 0}, tilted),
              "pose 1 is reached at 601 m/s: positions may be millimetres");
  expect_note(notes_on({0, 20, 40}, {0, 7, 0}, tilted),
              "pose 2 is 14 m from the origin: positions may be mill");
  expect_note(notes_on({0, 33, 67, 100}, {0.02, 0, 0}, tilted),
              "0.03 Hz: times are read as seconds, these may be");
  expect_note(notes_on({0, 3e-5, 6e-5}, Vec3::Zero(), tilted), "a rate of 3.33e+04 Hz");
  expect_note(notes_on(at_30_hz, {0.02, 0, 0}, reordered), "turned by about 180 degrees around x");
}

TEST(PosesOfFiles, OfOneClockKeepTheirTimes) {
  const auto file = [](double first_s, double last_s) {
    PoseFile poses;
    poses.stamps_s = {first_s, last_s};
    return poses;
  };
  const PoseFile a = file(100, 102), b = file(100.5, 104), c = file(103.5, 110), later = file(111, 112);
  PoseFile at_rest = file(7, 7);
  at_rest.stamps_s.pop_back();
  std::vector<Note> notes;
  using Files = std::vector<const PoseFile*>;
  EXPECT_EQ(origins_of_clocks(Files{&b, &a}, notes), (std::vector<double>{100, 100}));
  EXPECT_EQ(origins_of_clocks(Files{&c, &b, &a}, notes), (std::vector<double>{100, 100, 100}));
  EXPECT_EQ(origins_of_clocks(Files{&at_rest, &b}, notes), (std::vector<double>{7, 100.5}));
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(origins_of_clocks(Files{&later, &a, &b}, notes), (std::vector<double>{111, 100, 100.5}));
  ASSERT_EQ(kinds_of(notes), Kinds{"unusual poses"});
  EXPECT_HAS(notes[0].text, "one begins at 100 s, another at 111 s, after the end at 104 s");
}

}  // namespace
}  // namespace remote_touch::pose_file_test
