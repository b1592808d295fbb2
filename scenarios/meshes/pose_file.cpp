#include "scenarios/meshes/pose_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "core/geometry/near_origin.h"
#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMatrix = "expected 16 numbers, a 4 x 4 matrix row by row, or 16 nan";
constexpr const char* kStamped = "expected lines 't tx ty tz qx qy qz qw'";

std::vector<std::string_view> words_in(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

// Calls use(where, words) for each line that is no comment, and comment(words) for each other one. `where` is
// "file:line".
template <class Use, class Comment>
void for_each_line(const fs::path& file, const char* expected, Use&& use, Comment&& comment) {
  const std::string text = read_input_text(file, expected);
  std::string_view rest = without_byte_order_mark(text);
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::vector<std::string_view> words = words_in(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!words.empty() && words.front().front() == '#')
      comment(words);
    else
      use(file.string() + ":" + std::to_string(number), words);
  }
}

double number_in(const std::string& where, std::string_view word) {
  const bool has_plus = word.size() > 1 && word[0] == '+' && word[1] != '-';  // from_chars() takes no plus
  const std::string_view digits = has_plus ? word.substr(1) : word;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size()) return value;
  refuse(where, "'", std::string(word.substr(0, 32)), "': expected a number");
}

template <std::size_t kCount>
std::array<double, kCount> numbers_in(const std::string& where, const std::vector<std::string_view>& words,
                                      const char* expected) {
  if (words.empty()) refuse(where, "is empty: ", expected);
  if (words.size() != kCount) refuse(where, "has ", words.size(), " words: ", expected);
  std::array<double, kCount> numbers{};
  for (std::size_t i = 0; i < kCount; ++i) numbers[i] = number_in(where, words[i]);
  return numbers;
}

// The columns of a file whose first comment names the elements of [R | t]: "# frame r00 r01 r02 tx r10 ...".
class NamedColumns {
 public:
  NamedColumns() = default;
  // Has no columns unless the comment names all 12 elements.
  explicit NamedColumns(std::vector<std::string_view> names) {
    constexpr std::array<std::string_view, 12> kElements = {"r00", "r01", "r02", "tx",  "r10", "r11",
                                                            "r12", "ty",  "r20", "r21", "r22", "tz"};
    if (names.front() == "#")
      names.erase(names.begin());
    else
      names.front().remove_prefix(1);
    const auto place_of = [&](std::string_view name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    for (std::size_t i = 0; i < kElements.size(); ++i) {
      place_[i] = place_of(kElements[i]);
      if (place_[i] == names.size()) return;
    }
    count_ = names.size(), frame_ = place_of("frame");
  }
  explicit operator bool() const { return count_ > 0; }

  std::array<double, 16> matrix(const std::string& where, const std::vector<std::string_view>& words,
                                std::size_t frame) const {
    if (words.size() != count_)
      refuse(where, "has ", words.size(), " words: expected ", count_, ", as the first comment names");
    if (frame_ < count_ && number_in(where, words[frame_]) != static_cast<double>(frame))
      refuse(where, "is for frame ", std::string(words[frame_]), ": expected frame ", frame,
             ", one line for each frame in order");
    std::array<double, 16> numbers{};
    for (std::size_t i = 0; i < place_.size(); ++i) numbers[i] = number_in(where, words[place_[i]]);
    const bool is_unknown =
        std::all_of(numbers.begin(), numbers.begin() + 12, [](double x) { return std::isnan(x); });
    for (std::size_t i = 12; i < 16; ++i) numbers[i] = is_unknown ? std::nan("") : i == 15 ? 1 : 0;
    return numbers;
  }

 private:
  std::array<std::size_t, 12> place_{};
  std::size_t count_ = 0, frame_ = 0;  // number of words in a line; column of the frame's number
};

bool is_not_finite(double value) {
  return !std::isfinite(value);
}

bool is_nan(double value) {
  return std::isnan(value);
}

void require_near_origin(const std::string& where, const Vec3& p) {
  if (!is_near_origin(p)) refuse(where, far_from_origin("the position is"));
}

// Iterates R <- (R + R^-T) / 2, which converges quadratically to the orthogonal factor of the polar
// decomposition. The first error, at most 1e-3, is below 1e-12 after two steps.
Eigen::Matrix3d nearest_rotation(Eigen::Matrix3d R) {
  for (int step = 0; step < 4; ++step) {
    Eigen::Matrix3d cofactors;
    cofactors << R.col(1).cross(R.col(2)), R.col(2).cross(R.col(0)), R.col(0).cross(R.col(1));
    R = 0.5 * (R + cofactors / R.col(0).dot(cofactors.col(0)));
  }
  return R;
}

Eigen::Matrix3d rotation_in(const std::string& where, const Eigen::Matrix3d& R) {
  constexpr double kMaxError = 1e-3;
  const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kMaxError))
    refuse(where, "R^T R differs from the identity by ", error, ": expected a rigid pose, at most 0.001");
  if (R.col(0).dot(R.col(1).cross(R.col(2))) < 0)
    refuse(where, "the matrix mirrors (its determinant is -1): expected a rotation");
  return nearest_rotation(R);
}

// Returns nothing for 16 nan.
std::optional<RigidTransform> pose_in(const std::string& where, const std::array<double, 16>& numbers) {
  if (std::all_of(numbers.begin(), numbers.end(), is_nan)) return {};
  if (std::any_of(numbers.begin(), numbers.end(), is_nan)) refuse(where, "has nan beside numbers: ", kMatrix);
  if (std::any_of(numbers.begin(), numbers.end(), is_not_finite))
    refuse(where, "has a number that is not finite: ", kMatrix);
  constexpr double kMaxOff = 1e-6;
  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  const Matrix matrix = Eigen::Map<const Matrix>(numbers.data());
  if (!((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kMaxOff))
    refuse(where, "the last row is not 0 0 0 1: expected a 4 x 4 matrix row by row");
  RigidTransform X = RigidTransform::Identity();
  X.linear() = rotation_in(where, matrix.topLeftCorner<3, 3>());
  X.translation() = matrix.topRightCorner<3, 1>();
  require_near_origin(where, X.translation());
  return X;
}

// numbers: t tx ty tz qx qy qz qw.
StampedPose stamped_pose_in(const std::string& where, const std::array<double, 8>& numbers) {
  if (std::any_of(numbers.begin(), numbers.end(), is_not_finite))
    refuse(where, "has a number that is not finite: ", kStamped);
  constexpr double kMaxStamp_s = 1e12, kMaxNormError = 1e-2;  // stamps as in lists of images: tum_layout.cpp
  const auto [t, tx, ty, tz, qx, qy, qz, qw] = numbers;
  if (std::abs(t) > kMaxStamp_s) refuse(where, "its time is above 1e12: expected seconds");
  const Eigen::Quaterniond q(qw, qx, qy, qz);
  if (!(std::abs(q.norm() - 1) <= kMaxNormError))
    refuse(where, "its quaternion has the norm ", q.norm(), ": expected 1, within 0.01");
  require_near_origin(where, {tx, ty, tz});
  StampedPose pose{t};
  pose.X.linear() = q.normalized().toRotationMatrix();
  pose.X.translation() = Vec3(tx, ty, tz);
  return pose;
}

}  // namespace

std::vector<std::optional<RigidTransform>> read_pose_matrices(const fs::path& file) {
  std::vector<std::optional<RigidTransform>> poses;
  NamedColumns columns;
  const auto use = [&](const std::string& where, const std::vector<std::string_view>& words) {
    poses.push_back(pose_in(
        where, columns ? columns.matrix(where, words, poses.size()) : numbers_in<16>(where, words, kMatrix)));
  };
  for_each_line(file, kMatrix, use, [&](const std::vector<std::string_view>& words) {
    if (poses.empty() && !columns) columns = NamedColumns(words);
  });
  return poses;
}

PosePath read_stamped_poses(const fs::path& file) {
  std::vector<StampedPose> poses;
  double origin_s = 0;
  for_each_line(
      file, kStamped,
      [&](const std::string& where, const auto& words) {
        if (words.empty()) return;
        StampedPose pose = stamped_pose_in(where, numbers_in<8>(where, words, kStamped));
        if (poses.empty()) origin_s = pose.time_s;
        pose.time_s -= origin_s;
        if (!poses.empty() && !(pose.time_s > poses.back().time_s))
          refuse(where, "its time is not above that of the line before: expected increasing times");
        poses.push_back(pose);
      },
      [](const auto&) {});
  if (poses.empty()) refuse(file, "has no pose: ", kStamped);
  return PosePath(std::move(poses));
}

}  // namespace remote_touch
