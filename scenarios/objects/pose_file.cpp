#include "scenarios/objects/mesh_object.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include "core/points/point_cloud.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string_view>;

constexpr const char* kMatrix = "expected 16 numbers, a 4 x 4 matrix row by row, or 16 nan";
constexpr const char* kStamped = "expected lines 't tx ty tz qx qy qz qw'";

// Indices of the quantities of a pose.
enum : std::size_t { kTime, kFrame, kPosition, kQuaternion = kPosition + 3, kRotation = kQuaternion + 4 };

std::vector<ColumnQuantity> made_quantities() {
  std::vector<ColumnQuantity> quantities = {
      {{"t", "time", "timestamp", "stamp"}, ColumnQuantity::Unit::time},
      {{"frame"}},
      {{"tx", "x", "px", "p_x", "t_x"}, ColumnQuantity::Unit::length},
      {{"ty", "y", "py", "p_y", "t_y"}, ColumnQuantity::Unit::length},
      {{"tz", "z", "pz", "p_z", "t_z"}, ColumnQuantity::Unit::length},
      {{"qx", "q_x"}},
      {{"qy", "q_y"}},
      {{"qz", "q_z"}},
      {{"qw", "q_w"}},
  };
  for (const char* element : {"r00", "r01", "r02", "r10", "r11", "r12", "r20", "r21", "r22"})
    quantities.push_back({{element}});
  return quantities;
}

const std::vector<ColumnQuantity>& quantities() {
  static const std::vector<ColumnQuantity> all = made_quantities();
  return all;
}

bool has_all(const NumberColumns& columns, std::size_t first, std::size_t count) {
  for (std::size_t i = first; i < first + count; ++i)
    if (!columns.has(i)) return false;
  return true;
}

// Returns the names in a comment or a line. "#timestamp [ns], tx [m]" names timestamp_ns and tx_m.
std::vector<std::string> names_in(std::string_view line) {
  std::string text;
  for (const char c : line) {
    if (c == '[' || c == '(') {
      text.erase(text.find_last_not_of(" \t") + 1);
      text += '_';
    } else if (c != ']' && c != ')') {
      text += c == ',' || c == '#' ? ' ' : c;
    }
  }
  const Words words = words_of_line(text);
  return {words.begin(), words.end()};
}

// Returns the columns that a line names, or nothing if it does not name three elements of a pose.
std::optional<NumberColumns> columns_named(const std::string& where, std::string_view line) {
  constexpr std::size_t kFewest = 3;
  const std::vector<std::string> names = names_in(line);
  std::size_t elements = 0;
  for (const std::string& name : names) {
    const NumberColumns one(where, {name}, quantities());
    for (std::size_t i = kPosition; i < quantities().size(); ++i) elements += one.has(i) ? 1 : 0;
  }
  if (elements < kFewest) return {};
  NumberColumns columns(where, names, quantities());
  if (!has_all(columns, kPosition, 3) ||
      !(has_all(columns, kQuaternion, 4) || has_all(columns, kRotation, 9)))
    refuse(where,
           "names some columns of a pose: expected tx ty tz with qx qy qz qw, or with r00 r01 r02 r10 "
           "... r22, or no names");
  return columns;
}

bool is_not_finite(double value) {
  return !std::isfinite(value);
}

void require_near_origin(const std::string& where, const Vec3& p) {
  if (is_near_origin(p)) return;
  refuse(where, far_from_origin("the position is"),
         (is_near_origin(p / 1000) ? "; positions may be millimetres instead of metres" : ""));
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

// values: tx ty tz qx qy qz qw.
std::optional<RigidTransform> pose_of_quaternion(const std::string& where,
                                                 const std::array<double, 7>& values, bool may_be_unknown) {
  constexpr double kMaxNormError = 1e-2;
  if (may_be_unknown && std::ranges::all_of(values, is_not_finite)) return {};
  if (std::ranges::any_of(values, is_not_finite))
    refuse(where, "has a number that is not finite: ", kStamped);
  const auto [tx, ty, tz, qx, qy, qz, qw] = values;
  const Eigen::Quaterniond q(qw, qx, qy, qz);
  if (!(std::abs(q.norm() - 1) <= kMaxNormError))
    refuse(where, "its quaternion has the norm ", q.norm(), ": expected 1, within 0.01");
  require_near_origin(where, {tx, ty, tz});
  RigidTransform X = RigidTransform::Identity();
  X.linear() = q.normalized().toRotationMatrix();
  X.translation() = Vec3(tx, ty, tz);
  return X;
}

// Returns the pose of the 16 numbers of a matrix.
std::optional<RigidTransform> pose_of_matrix(const std::string& where,
                                             const std::array<double, 16>& numbers) {
  constexpr std::array<double, 4> kLastRow = {0, 0, 0, 1};
  constexpr double kMaxOff = 1e-6;
  std::array<double, 12> rows{};
  std::copy_n(numbers.begin(), rows.size(), rows.begin());
  const bool is_known = !std::ranges::all_of(rows, is_not_finite);
  for (std::size_t i = 0; is_known && i < kLastRow.size(); ++i) {
    if (is_not_finite(numbers[rows.size() + i])) refuse(where, "has a number that is not finite: ", kMatrix);
    if (!(std::abs(numbers[rows.size() + i] - kLastRow[i]) <= kMaxOff))
      refuse(where, "the last row is not 0 0 0 1: expected a 4 x 4 matrix row by row");
  }
  return pose_of_rows(where, rows);
}

std::array<double, 16> sixteen_numbers(const std::string& where, const Words& words) {
  std::array<double, 16> numbers{};
  if (words.size() != numbers.size()) refuse(where, "has ", words.size(), " words: ", kMatrix);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::optional<double> number = number_of_word(words[i]);
    if (!number) refuse(where, "'", std::string(words[i].substr(0, 32)), "': expected a number");
    numbers[i] = *number;
  }
  return numbers;
}

class PoseReader {
 public:
  PoseReader(const fs::path& file, PoseLines expected) : expected_(expected) { result_.file = file; }

  void add(std::size_t number, std::string_view line) {
    const std::string where = result_.file.string() + ":" + std::to_string(number);
    const Words words = words_of_line(line);
    const bool is_comment = !words.empty() && words.front().front() == '#';
    const bool has_names = !words.empty() && !number_of_word(words.front());
    if (result_.poses.empty() && columns_.count() == 0 && (is_comment || has_names))
      if (std::optional<NumberColumns> named = columns_named(where, line)) {
        columns_ = *std::move(named), is_named_ = true;
        return;
      }
    if (is_comment && result_.poses.empty()) note_convention(where, words);
    if (is_comment) return;
    if (words.empty()) {
      if (empty_line_.empty()) empty_line_ = where;
      return;
    }
    add_pose(where, words);
    // Line i is the pose of frame i, so that a line without a pose would shift those behind it.
    if (result_.stamps_s.empty() && !empty_line_.empty()) refuse(empty_line_, "is empty: ", kMatrix);
  }

  PoseFile take() {
    if (result_.poses.empty() && expected_ == PoseLines::stamped)
      refuse(result_.file, "has no pose: ", kStamped);
    if (equal_ > 0)
      result_.notes.push_back(
          {"unusual poses", result_.file.string() + ": " + std::to_string(equal_) +
                                " line(s) have the time of the line before and are not used"});
    return std::move(result_);
  }

 private:
  // A comment of free text is not read, but a user who wrote a unit or an order there expects that it is.
  void note_convention(const std::string& where, const Words& words) {
    constexpr std::array<std::string_view, 9> kConventions = {"mm",           "millimetres", "millimeters",
                                                              "millimetre",   "millimeter",  "ms",
                                                              "milliseconds", "wxyz",        "w-first"};
    for (const std::string_view word : words)
      for (const std::string_view convention : kConventions)
        if (in_small_letters(word.substr(0, word.find_last_not_of(".,;:)]") + 1)) == convention)
          result_.notes.push_back(
              {"unusual poses", where + ": the comment says '" + std::string(convention) +
                                    "', which is not read: a comment that names the columns "
                                    "states units and order, such as # t_ms tx_mm ty_mm tz_mm "
                                    "qw qx qy qz"});
  }

  void add_pose(const std::string& where, const Words& words) {
    constexpr std::size_t kStampedWords = 8;
    const bool may_be_stamped = expected_ != PoseLines::of_frames;
    if (!is_named_ && columns_.count() == 0 && may_be_stamped &&
        (expected_ == PoseLines::stamped || words.size() == kStampedWords))
      columns_ = NumberColumns(where, {"t", "tx", "ty", "tz", "qx", "qy", "qz", "qw"}, quantities());
    if (columns_.count() == 0) {
      result_.poses.push_back(pose_of_matrix(where, sixteen_numbers(where, words)));
      return;
    }
    if (words.size() != columns_.count())
      refuse(where, "has ", words.size(), " words: ",
             is_named_ ? "expected " + std::to_string(columns_.count()) + ", as the names of the columns say"
                       : kStamped);
    const bool is_stamped = columns_.has(kTime) && !columns_.has(kFrame);
    if (is_stamped && !may_be_stamped)
      refuse(where, "has a time: expected one pose for each frame, without times");
    if (!is_stamped && expected_ == PoseLines::stamped) refuse(where, "has no time: ", kStamped);
    if (is_stamped && !add_stamp(where, words)) return;
    if (columns_.has(kFrame)) require_frame(where, words);
    result_.poses.push_back(named_pose(where, words, !is_stamped));
  }

  // Returns false for a time that is that of the line before.
  bool add_stamp(const std::string& where, const Words& words) {
    constexpr double kMaxStamp_s = 1e12;  // the limit of image_folders.cpp
    std::vector<double>& stamps_s = result_.stamps_s;
    const double stamp_s = columns_.value(where, words, kTime);
    if (is_not_finite(stamp_s)) refuse(where, "has a number that is not finite: ", kStamped);
    if (std::abs(stamp_s) > kMaxStamp_s) refuse(where, "its time is above 1e12: expected seconds");
    if (!stamps_s.empty() && stamp_s == stamps_s.back()) {
      ++equal_;
      return false;
    }
    if (!stamps_s.empty() && !(stamp_s > stamps_s.back()))
      refuse(where, "its time is below that of the line before: expected increasing times");
    stamps_s.push_back(stamp_s);
    return true;
  }

  void require_frame(const std::string& where, const Words& words) const {
    const double frame = columns_.value(where, words, kFrame);
    if (frame != static_cast<double>(result_.poses.size()))
      refuse(where, formatted("is for frame %g: ", frame), "expected frame ", result_.poses.size(),
             ", one line for each frame in order");
  }

  std::optional<RigidTransform> named_pose(const std::string& where, const Words& words,
                                           bool may_be_unknown) {
    const auto at = [&](std::size_t quantity) { return columns_.value(where, words, quantity); };
    if (has_all(columns_, kRotation, 9)) {
      std::array<double, 12> rows{};
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
          rows[4 * row + column] = at(kRotation + 3 * row + column);
        rows[4 * row + 3] = at(kPosition + row);
      }
      std::optional<RigidTransform> X = pose_of_rows(where, rows);
      if (!X && !may_be_unknown) refuse(where, "has a number that is not finite: ", kStamped);
      return X;
    }
    result_.has_unnamed_quaternions = !is_named_;
    std::array<double, 7> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = at(kPosition + i);
    return pose_of_quaternion(where, values, may_be_unknown);
  }

  const PoseLines expected_;
  NumberColumns columns_;
  bool is_named_ = false;
  std::size_t equal_ = 0;
  std::string empty_line_;  // "file:line" of the first one
  PoseFile result_;
};

// The largest speed between two poses, and the pose at its end.
struct Fastest {
  double speed_m_per_s = 0;
  std::size_t pose = 0;
};

Fastest fastest(std::span<const StampedPose> poses) {
  Fastest result;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double way_m = (poses[i].X.translation() - poses[i - 1].X.translation()).norm();
    const double speed = way_m / (poses[i].time_s - poses[i - 1].time_s);
    if (speed > result.speed_m_per_s) result = {speed, i};
  }
  return result;
}

double rate_hz(std::span<const StampedPose> poses) {
  return static_cast<double>(poses.size() - 1) / (poses.back().time_s - poses.front().time_s);
}

RigidTransform with_rotation(const RigidTransform& X, const Eigen::Matrix3d& R) {
  RigidTransform changed = X;
  changed.linear() = R;
  return changed;
}

}  // namespace

std::optional<RigidTransform> pose_of_rows(const std::string& where, const std::array<double, 12>& rows) {
  if (std::ranges::all_of(rows, is_not_finite)) return {};
  if (std::ranges::any_of(rows, [](double x) { return std::isnan(x); }))
    refuse(where, "has nan beside numbers: ", kMatrix);
  if (std::ranges::any_of(rows, is_not_finite)) refuse(where, "has a number that is not finite: ", kMatrix);
  using Matrix = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  const Matrix matrix = Eigen::Map<const Matrix>(rows.data());
  RigidTransform X = RigidTransform::Identity();
  X.linear() = rotation_in(where, matrix.leftCols<3>());
  X.translation() = matrix.col(3);
  require_near_origin(where, X.translation());
  return X;
}

PoseFile read_poses(const fs::path& file, PoseLines expected) {
  const std::string text = read_input_text(file, expected == PoseLines::stamped ? kStamped : kMatrix);
  PoseReader reader(file, expected);
  for_each_line(without_byte_order_mark(text),
                [&](std::size_t number, std::string_view line) { reader.add(number, line); });
  return reader.take();
}

PoseFile read_pose_folder(const fs::path& folder, const std::vector<fs::path>& files) {
  PoseFile poses;
  poses.file = folder;
  for (const fs::path& file : files) {
    const std::string text = file.empty() ? "" : read_input_text(file, kMatrix);
    const std::string where = file.string();
    Words words;
    for_each_line(without_byte_order_mark(text), [&](std::size_t, std::string_view line) {
      for (const std::string_view word : words_of_line(line)) words.push_back(word);
    });
    poses.poses.push_back(file.empty() ? std::nullopt : pose_of_matrix(where, sixteen_numbers(where, words)));
  }
  return poses;
}

PosePath path_of(const PoseFile& poses, double origin_s) {
  std::vector<StampedPose> stamped;
  for (std::size_t i = 0; i < poses.poses.size(); ++i)
    stamped.push_back({poses.stamps_s[i] - origin_s, *poses.poses[i]});
  return PosePath(std::move(stamped));
}

std::vector<double> origins_of_clocks(std::span<const PoseFile* const> files, std::vector<Note>& notes) {
  std::vector<double> origins;
  std::vector<std::pair<double, double>> ranges;  // first and last stamp of each file that moves
  for (const PoseFile* poses : files) {
    origins.push_back(poses->stamps_s.front());
    if (poses->stamps_s.size() > 1) ranges.emplace_back(poses->stamps_s.front(), poses->stamps_s.back());
  }
  if (ranges.size() < 2) return origins;
  std::ranges::sort(ranges);
  double end_s = ranges.front().second;
  for (const auto& [first_s, last_s] : ranges) {
    if (first_s > end_s) {
      notes.push_back(
          {"unusual poses", "the times of the files of poses do not overlap: " +
                                formatted("one begins at %.6g s, another at %.6g s, after the end "
                                          "at %.6g s, so that each file counts from its own first line",
                                          ranges.front().first, first_s, end_s)});
      return origins;
    }
    end_s = std::max(end_s, last_s);
  }
  std::ranges::fill(origins, ranges.front().first);
  return origins;
}

std::string motion_text(std::span<const StampedPose> poses) {
  if (poses.size() == 1) return "1 pose";
  double way_m = 0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    way_m += (poses[i].X.translation() - poses[i - 1].X.translation()).norm();
  return formatted("%zu poses over %.3g s at %.3g Hz, %.3g m long, at most %.3g m/s", poses.size(),
                   poses.back().time_s - poses.front().time_s, rate_hz(poses), way_m,
                   fastest(poses).speed_m_per_s);
}

std::vector<Note> unusual_poses(const std::string& subject, std::span<const StampedPose> poses,
                                bool has_unnamed_quaternions) {
  constexpr double kFastest_m_per_s = 10, kFarthest_m = 10, kSlowest_hz = 1, kMostPoses_hz = 1000;
  constexpr double kHalfTurn = 0.9;   // least |qx| of a turn by 180 degrees about x, within 52 degrees
  constexpr std::size_t kSeries = 3;  // two poses far apart are a slow motion
  std::vector<Note> notes;
  const auto add = [&](const std::string& text) {
    notes.push_back({"unusual poses", subject + ": " + text});
  };
  if (const Fastest most = fastest(poses); most.speed_m_per_s > kFastest_m_per_s)
    add("pose " + std::to_string(most.pose) + formatted(" is reached at %.3g m/s: ", most.speed_m_per_s) +
        "positions may be millimetres instead of metres, or the poses in another order");
  const auto far = std::ranges::find_if(
      poses, [&](const StampedPose& pose) { return pose.X.translation().norm() > kFarthest_m; });
  if (far != poses.end())
    add("pose " + std::to_string(far - poses.begin()) +
        formatted(" is %.4g m from the origin: ", far->X.translation().norm()) +
        "positions may be millimetres instead of metres");
  if (poses.size() >= kSeries && !(rate_hz(poses) >= kSlowest_hz && rate_hz(poses) <= kMostPoses_hz))
    add("its poses have a rate of" + formatted(" %.3g Hz: ", rate_hz(poses)) +
        "times are read as seconds, these may be milliseconds");
  const auto is_half_turn = [&](const StampedPose& pose) {
    return std::abs(Eigen::Quaterniond(pose.X.linear()).x()) > kHalfTurn;
  };
  if (has_unnamed_quaternions && std::ranges::all_of(poses, is_half_turn))
    add("every pose is turned by about 180 degrees around x: the order of a quaternion is qx qy qz qw; if qw "
        "comes first, a first line must name the columns: # t tx ty tz qw qx qy qz");
  return notes;
}

std::span<const OtherMeaning> other_meanings() {
  using Pose = const RigidTransform&;
  static constexpr OtherMeaning kMeanings[] = {
      {"the inverse poses", [](Pose X) -> RigidTransform { return X.inverse(); }},
      {"positions in millimetres",
       [](Pose X) {
         RigidTransform changed = X;
         changed.translation() /= 1000;
         return changed;
       }},
      {"transposed rotations", [](Pose X) { return with_rotation(X, X.linear().transpose()); }},
      {"y and z of the body reversed (as in OpenGL)",
       [](Pose X) { return with_rotation(X, X.linear() * Vec3(1, -1, -1).asDiagonal()); }},
      {"y and z of the parent frame reversed (as in OpenGL)",
       [](Pose X) {
         RigidTransform flip = RigidTransform::Identity();
         flip.linear().diagonal() = Vec3(1, -1, -1);
         return flip * X;
       }},
      {"quaternions with qw first",
       [](Pose X) {
         const Eigen::Quaterniond q(X.linear());
         return with_rotation(X, Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix());
       }},
  };
  return kMeanings;
}

}  // namespace remote_touch
