#include "runners/experiment/sessions/session_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/storage/hdf5_file.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"

namespace remote_touch {

Parameters parameters(LiveSettings& s) {
  return {
      {"device_position_m", &s.device_position_m, -100, 100,
       "position of the centre of the device's workspace, world frame"},
      {"device_rotation_deg", &s.device_rotation_deg, -360, 360,
       "rotation vector (axis times angle) of the device, world frame; zero: x right, y up, z towards the user"},
      {"device_scale", &s.device_scale, 0.01, 100,
       "motion scale: displacement in the world per displacement of the hand"},
      {"camera_position_m", &s.camera_position_m, -100, 100,
       "position of the camera, added to the one that its source reports"},
      {"camera_rotation_deg", &s.camera_rotation_deg, -360, 360,
       "rotation vector (axis times angle) of the camera, added in the same way"},
  };
}

RigidTransform camera_registration(const LiveSettings& s) {
  return RigidTransform(Eigen::Translation3d(s.camera_position_m) *
                        rotation(kRadiansPerDegree * s.camera_rotation_deg));
}

namespace {

// Longest time in which the slew rate must bring the largest force to zero.
constexpr double kMaxRampDown_s = 0.01;

std::string too_slow(const char* slew, const char* max, double value, double min) {
  if (value >= min) return {};
  return std::string(slew) + " = " + std::to_string(value) + ": expected " + max +
         " / 0.01 s = " + std::to_string(min) + " or more, so that the maximum can fall to 0 in that time";
}

constexpr std::size_t kTicksAtOnce = 1000;
// Largest number of a tick: 24 days at 1 kHz. A run needs memory for every tick, including missed ticks.
constexpr std::uint64_t kMaxTick = std::numeric_limits<std::int32_t>::max();
constexpr double kMaxSide_px = 65535;

std::string view_text(const SensorView& view, const RigidTransform& X_WC) {
  const CameraIntrinsics& c = view.camera;
  nlohmann::json json = {{"width", c.width},
                         {"height", c.height},
                         {"fx", c.fx},
                         {"fy", c.fy},
                         {"cx", c.cx},
                         {"cy", c.cy},
                         {"metres_per_unit", view.metres_per_unit},
                         {"frame_rate_hz", view.frame_rate_hz},
                         {"has_colour", view.has_colour}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) json["X_WC"].push_back(X_WC(row, column));
  if (view.cloud)
    json["cloud"] = {{"has_normals", view.cloud->has_normals}, {"grid_columns", view.cloud->grid_columns}};
  return json.dump();
}

}  // namespace

Parameters parameters(SafetyLimits& s) {
  return {
      {"max_force_N", &s.max_force_N, 0, 100,
       "maximum force; also limited to 0.9 of the maximum force of the device"},
      {"max_torque_Nm", &s.max_torque_Nm, 0, 10,
       "maximum torque; also limited to 0.9 of the maximum torque of the device"},
      {"force_slew_N_per_s", &s.force_slew_N_per_s, 1, 1e5, "maximum rate of change of the force"},
      {"torque_slew_Nm_per_s", &s.torque_slew_Nm_per_s, 0.01, 1e4, "maximum rate of change of the torque"},
      {"max_speed_m_per_s", &s.max_speed_m_per_s, 0.01, 100,
       "maximum speed of the hand; above it the force is switched off until the safety gate is re-armed"},
      {"max_angular_speed_rad_per_s", &s.max_angular_speed_rad_per_s, 0.1, 1000,
       "maximum angular speed of the handle; above it the force is switched off until the safety gate is re-armed"},
      {"engage_force_N", &s.engage_force_N, 1e-3, 10,
       "force starts only when the commanded force is below this"},
      {"ramp_s", &s.ramp_s, 0, 10,
       "after it starts, the force rises linearly to its full value over this time"},
      {"max_command_age_s", &s.max_command_age_s, 0.002, 1, "commands older than this are ignored"},
      {"max_frame_age_s", &s.max_frame_age_s, 0, 100,
       "there is no force while the newest frame was taken longer ago than this, such as after a camera has stopped; 0: no limit, and none with frame_link.least_motion_m, which sends frames only when something moves"},
  };
}

std::string validate(const SafetyLimits& s) {
  const std::string force =
      too_slow("force_slew_N_per_s", "max_force_N", s.force_slew_N_per_s, s.max_force_N / kMaxRampDown_s);
  if (!force.empty()) return force;
  return too_slow("torque_slew_Nm_per_s", "max_torque_Nm", s.torque_slew_Nm_per_s,
                  s.max_torque_Nm / kMaxRampDown_s);
}

SessionLayout layout_of(const SensorView& view) {
  SessionLayout layout;
  layout.has_colour = view.has_colour;
  if (view.cloud) {
    layout.numbers_per_point = static_cast<std::uint32_t>(view.cloud->numbers_per_point());
  } else {
    layout.width = static_cast<std::uint32_t>(view.camera.width);
    layout.height = static_cast<std::uint32_t>(view.camera.height);
  }
  return layout;
}

StoredFrame stored_frame(const SessionLayout& layout, const SensorFrame& frame, double captured_s,
                         std::uint64_t fixtures_off) {
  StoredFrame stored{frame.number, captured_s, fixtures_off, 0, {}, {}};
  const auto bytes = [](const auto& values) {
    return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]);
  };
  if (layout.has_clouds()) {
    stored.point_count = static_cast<std::uint32_t>(frame.points.size() / layout.numbers_per_point);
    stored.depth = bytes(frame.points);
    if (layout.has_colour) stored.colour = bytes(frame.colour);
    return stored;
  }
  stored.depth = deflated_row(frame.depth.data(), layout.pixels(), sizeof frame.depth[0]);
  if (layout.has_colour)
    stored.colour = deflated_row(frame.colour.data(), layout.pixels(), sizeof frame.colour[0]);
  return stored;
}

TextAttributes session_attributes(const SensorView& view, const RigidTransform& registered,
                                  const TextAttributes& provenance,
                                  const std::vector<std::string>& live_parameters) {
  TextAttributes all{{"schema", schema_name("session")}, {"view", view_text(view, registered)}};
  all.insert(all.end(), provenance.begin(), provenance.end());
  all.emplace_back("live_parameters", nlohmann::json(live_parameters).dump());
  return all;
}

SessionWriter::SessionWriter(const std::filesystem::path& target, const SessionLayout& layout,
                             const TextAttributes& attributes)
    : file_(target), layout_(layout) {
  using Number = Hdf5Appender::Number;
  file_.attributes("/", attributes);
  file_.group("/ticks"), file_.group("/frames"), file_.group("/changes");
  file_.dataset({"/ticks/number", "1", "number of the tick: its time times the haptic rate", Number::u64});
  file_.dataset({"/ticks/position", "m", "position of the device, world frame", Number::f64, {3}});
  file_.dataset(
      {"/ticks/orientation", "1", "orientation of the device, quaternion w x y z", Number::f64, {4}});
  file_.dataset({"/ticks/buttons", "1", "buttons that are down, one bit each", Number::u32});
  file_.dataset(
      {"/ticks/taken", "1", "frame that the renderer received before the tick; -1: none", Number::i32});
  file_.dataset({"/ticks/written_force", "N", "force written to the device, in its axes", Number::f64, {3}});
  file_.dataset(
      {"/ticks/written_torque", "N m", "torque written to the device, in its axes", Number::f64, {3}});
  file_.dataset({"/ticks/gate", "1", "0 waiting, 1 ramping, 2 engaged, 3 latched", Number::i32});
  file_.dataset({"/frames/number", "1", "number of the frame, as the sensor counts", Number::i32});
  file_.dataset({"/frames/captured", "s", "time since the start, by the sensor's time stamp", Number::f64});
  file_.dataset({"/frames/fixtures_off", "1", "fixtures that were off, one bit each", Number::u64});
  file_.dataset({"/changes/tick", "1", "number of the first tick with the new value", Number::u64});
  file_.dataset({"/changes/parameter", "1", "index in live_parameters, from 0", Number::i32});
  file_.dataset(
      {"/changes/value", "1", "value in the parameter's own unit; 0 or 1 for a switch", Number::f64});
  if (layout.has_clouds()) {
    add_cloud_datasets();
    return;
  }
  const unsigned long long height = layout.height, width = layout.width;
  file_.dataset({"/frames/depth", "1", "units of metres_per_unit, 0: none", Number::u16, {height, width}, 1});
  if (layout.has_colour) file_.dataset({"/frames/colour", "1", "0xRRGGBB", Number::u32, {height, width}, 1});
}

// The points of all frames, one after the other.
void SessionWriter::add_cloud_datasets() {
  using Number = Hdf5Appender::Number;
  file_.dataset({"/frames/point_count", "1", "number of points of the frame", Number::u32});
  file_.dataset({"/frames/points",
                 "m",
                 "x y z, and the normal if there are normals, camera frame",
                 Number::f32,
                 {layout_.numbers_per_point}});
  if (layout_.has_colour) file_.dataset({"/frames/colour", "1", "0xRRGGBB of each point", Number::u32});
}

void SessionWriter::append(const SessionChange& change) {
  file_.append("/changes/tick", &change.tick, 1);
  file_.append("/changes/parameter", &change.parameter, 1);
  file_.append("/changes/value", &change.value, 1);
}

void SessionWriter::append(const SessionTick& tick) {
  const DeviceState& device = tick.device;
  const auto push = [](std::vector<double>& column, const Vec3& v) {
    column.insert(column.end(), v.data(), v.data() + 3);
  };
  ticks_.number.push_back(static_cast<std::uint64_t>(tick.number));
  push(ticks_.position, device.position_W);
  const Eigen::Quaterniond& q = device.orientation_W;
  ticks_.orientation.insert(ticks_.orientation.end(), {q.w(), q.x(), q.y(), q.z()});
  ticks_.buttons.push_back(device.buttons);
  ticks_.taken.push_back(tick.taken);
  push(ticks_.force, tick.written.force_N), push(ticks_.torque, tick.written.torque_Nm);
  ticks_.gate.push_back(tick.gate);
  if (ticks_.number.size() >= kTicksAtOnce) flush_ticks();
}

void SessionWriter::flush_ticks() {
  const std::size_t count = ticks_.number.size();
  file_.append("/ticks/number", ticks_.number.data(), count);
  file_.append("/ticks/position", ticks_.position.data(), count);
  file_.append("/ticks/orientation", ticks_.orientation.data(), count);
  file_.append("/ticks/buttons", ticks_.buttons.data(), count);
  file_.append("/ticks/taken", ticks_.taken.data(), count);
  file_.append("/ticks/written_force", ticks_.force.data(), count);
  file_.append("/ticks/written_torque", ticks_.torque.data(), count);
  file_.append("/ticks/gate", ticks_.gate.data(), count);
  ticks_ = {};
}

void SessionWriter::append(const StoredFrame& frame) {
  file_.append("/frames/number", &frame.number, 1);
  file_.append("/frames/captured", &frame.captured_s, 1);
  file_.append("/frames/fixtures_off", &frame.fixtures_off, 1);
  if (!layout_.has_clouds()) {
    file_.append_deflated("/frames/depth", frame.depth);
    if (layout_.has_colour) file_.append_deflated("/frames/colour", frame.colour);
    return;
  }
  file_.append("/frames/point_count", &frame.point_count, 1);
  file_.append("/frames/points", frame.depth.data(), frame.point_count);
  if (layout_.has_colour) file_.append("/frames/colour", frame.colour.data(), frame.point_count);
}

void SessionWriter::finish(const TextAttributes& attributes) {
  flush_ticks();
  file_.attributes("/", attributes);
  file_.finish();
}

SessionReader::SessionReader(Hdf5Reader file) : file_(std::move(file)) {
  file_.require_kind("session", "which remote-touch live --record makes");
  read_view();
  captured_s_ = file_.values<double>("/frames/captured");
  fixtures_off_ = file_.values<std::uint64_t>("/frames/fixtures_off");
  frame_number_ = file_.values<std::int32_t>("/frames/number");
  number_ = file_.values<std::uint64_t>("/ticks/number");
  position_ = file_.values<double>("/ticks/position", 3);
  orientation_ = file_.values<double>("/ticks/orientation", 4);
  buttons_ = file_.values<double>("/ticks/buttons");
  taken_ = file_.values<std::int32_t>("/ticks/taken");
  const std::size_t ticks = number_.size(), frames = captured_s_.size();
  if (view_.cloud) read_point_counts();
  if (position_.size() != 3 * ticks || orientation_.size() != 4 * ticks || buttons_.size() != ticks ||
      taken_.size() != ticks || fixtures_off_.size() != frames || frame_number_.size() != frames)
    file_.damaged("its columns differ in length");
  require_order();
  if (file_.has("/changes/tick")) read_changes();  // older recordings have none
}

void SessionReader::read_changes() try {
  live_parameters_ = nlohmann::json::parse(attribute(file_.attributes(), "live_parameters"));
  const auto tick = file_.values<std::uint64_t>("/changes/tick");
  const auto parameter = file_.values<std::int32_t>("/changes/parameter");
  const auto value = file_.values<double>("/changes/value");
  if (parameter.size() != tick.size() || value.size() != tick.size())
    file_.damaged("its columns differ in length");
  for (std::size_t i = 0; i < tick.size(); ++i) {
    if (tick[i] > kMaxTick || (i > 0 && tick[i] < tick[i - 1]) || parameter[i] < 0 ||
        static_cast<std::size_t>(parameter[i]) >= live_parameters_.size() || !std::isfinite(value[i]))
      file_.damaged("its changes of parameters are not possible");
    changes_.push_back({tick[i], parameter[i], value[i]});
  }
} catch (const nlohmann::json::exception&) {
  file_.damaged("its attribute live_parameters cannot be read");
}

// Throws InputError for an impossible recording: numbers and times of frames and ticks must increase, and the
// renderer receives each frame once at most.
void SessionReader::require_order() const {
  const auto frames = static_cast<std::int32_t>(frame_count());
  std::int32_t last_taken = -1;
  for (std::size_t i = 0; i < tick_count(); ++i) {
    const bool is_taken = taken_[i] != -1;
    if (number_[i] > kMaxTick || (i > 0 && number_[i] <= number_[i - 1]) ||
        (is_taken && (taken_[i] <= last_taken || taken_[i] >= frames)))
      file_.damaged("its ticks are out of order");
    if (!(buttons_[i] >= 0 && buttons_[i] <= std::numeric_limits<std::uint32_t>::max()))
      file_.damaged("/ticks/buttons has values that are not button states");
    if (is_taken) last_taken = taken_[i];
  }
  for (std::size_t i = 0; i < frame_count(); ++i)
    if (!std::isfinite(captured_s_[i]) ||
        (i > 0 && (captured_s_[i] <= captured_s_[i - 1] || frame_number_[i] <= frame_number_[i - 1])))
      file_.damaged("its frames are out of order");
}

void SessionReader::read_view() try {
  const nlohmann::json json = nlohmann::json::parse(attribute(file_.attributes(), "view"));
  const auto number = [this](const nlohmann::json& from, const char* key, double low, double high) {
    const double value = from.at(key);
    if (!(value >= low && value <= high)) file_.damaged(std::string(key) + " = " + from.at(key).dump());
    return value;
  };
  constexpr double kAboveZero = std::numeric_limits<double>::min(), kMax = 1e9;
  if (json.contains("cloud")) {
    const nlohmann::json& cloud = json.at("cloud");
    view_.cloud = {cloud.at("has_normals"), static_cast<int>(number(cloud, "grid_columns", 0, kMaxSide_px)),
                   0};
  }
  const double min_side = view_.cloud ? 0 : 1, min_focal = view_.cloud ? 0 : kAboveZero;
  CameraIntrinsics& c = view_.camera;
  c.width = static_cast<int>(number(json, "width", min_side, kMaxSide_px));
  c.height = static_cast<int>(number(json, "height", min_side, kMaxSide_px));
  c.fx = number(json, "fx", min_focal, kMax), c.fy = number(json, "fy", min_focal, kMax);
  c.cx = number(json, "cx", -kMax, kMax), c.cy = number(json, "cy", -kMax, kMax);
  view_.metres_per_unit = number(json, "metres_per_unit", kAboveZero, kMax);
  view_.frame_rate_hz = number(json, "frame_rate_hz", kAboveZero, kMax);
  haptic_rate_hz_ = number(nlohmann::json::parse(config()), "haptic_rate_hz", kAboveZero, kMax);
  view_.has_colour = json.at("has_colour");
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      view_.X_WC.matrix()(row, column) = json.at("X_WC").at(static_cast<std::size_t>(4 * row + column));
  if (!view_.X_WC.matrix().allFinite() || !view_.X_WC.linear().isUnitary(1e-6) ||
      view_.X_WC.linear().determinant() < 0)
    file_.damaged("X_WC is not a pose");
} catch (const nlohmann::json::exception&) {
  file_.damaged("its attributes view and config cannot be read");
}

std::string SessionReader::config() const {
  return attribute(file_.attributes(), "config");
}

std::string SessionReader::ended() const {
  return attribute(file_.attributes(), "ended");
}

std::string SessionReader::depth() const {
  return attribute(file_.attributes(), "depth");
}

DeviceState SessionReader::device(std::size_t i) const {
  return {Vec3(position_[3 * i], position_[3 * i + 1], position_[3 * i + 2]),
          {orientation_[4 * i], orientation_[4 * i + 1], orientation_[4 * i + 2], orientation_[4 * i + 3]},
          static_cast<std::uint32_t>(buttons_[i])};
}

template <class Stored, class Number>
void SessionReader::read_numbers(const char* dataset, Rows rows, std::size_t expected,
                                 std::vector<Number>& numbers) const {
  const Column column = file_.rows(dataset, rows.first, rows.count);
  const auto* stored = std::get_if<std::vector<Stored>>(&column.values);
  if (!stored || stored->size() != expected) file_.damaged(std::string(dataset) + " is of another size");
  const auto fits = [](Stored value) { return value >= 0 && value <= std::numeric_limits<Number>::max(); };
  if (std::is_integral_v<Number> && !std::all_of(stored->begin(), stored->end(), fits))
    file_.damaged(std::string(dataset) + " has values that no pixel has");
  numbers.resize(expected);
  std::transform(stored->begin(), stored->end(), numbers.begin(),
                 [](Stored value) { return static_cast<Number>(value); });
}

void SessionReader::read_point_counts() {
  std::size_t sum = 0;
  for (const double count : file_.values<double>("/frames/point_count")) {
    if (!(count >= 0 && count <= std::numeric_limits<std::uint32_t>::max()))
      file_.damaged("the number of points of a frame is not possible");
    first_point_.push_back(sum);
    sum += static_cast<std::size_t>(count);
  }
  if (first_point_.size() != captured_s_.size()) file_.damaged("its columns differ in length");
  first_point_.push_back(sum);
}

void SessionReader::read_points(std::size_t i, SensorFrame& frame) const {
  const Rows rows{first_point_[i], first_point_[i + 1] - first_point_[i]};
  if (rows.count == 0) return;
  read_numbers<double>("/frames/points", rows, rows.count * view_.cloud->numbers_per_point(), frame.points);
  if (view_.has_colour) read_numbers<double>("/frames/colour", rows, rows.count, frame.colour);
}

SensorFrame SessionReader::frame(std::size_t i) const {
  SensorFrame frame;
  frame.number = frame_number_[i];
  frame.captured_s = captured_s_[i];
  if (view_.cloud) {
    read_points(i, frame);
  } else {
    const auto pixels = view_.camera.pixels();
    read_numbers<std::int32_t>("/frames/depth", {i, 1}, pixels, frame.depth);
    if (view_.has_colour) read_numbers<double>("/frames/colour", {i, 1}, pixels, frame.colour);
  }
  return frame;
}

}  // namespace remote_touch
