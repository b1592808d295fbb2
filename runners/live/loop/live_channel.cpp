#include "runners/live/loop/live_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

void PageHand::publish() {
  poses_->back() = motion_;
  poses_->publish();
}

void PageHand::pass_on() {
  page_start_.reset();
  motion_ = {{}, {}, motion_.stops + 1};
  publish();
}

void PageHand::move(const DeviceState& of_page) {
  if (!page_start_) page_start_ = of_page;
  motion_.from = *page_start_;
  motion_.to = of_page;
  publish();
}

void PageHand::release_buttons() {
  if (motion_.to.buttons == 0) return;
  motion_.to.buttons = 0;
  publish();
}

namespace {

constexpr std::uint32_t kTicks = 1, kFrame = 2, kColours = 1, kRadii = 2;
constexpr double kMaxNumber = 65535;

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Replaces invalid bytes, because a text of a device or a sensor may not be UTF-8.
std::string message_text(const nlohmann::ordered_json& message) {
  return message.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void pad(std::string& bytes) {
  bytes.resize((bytes.size() + 7) / 8 * 8);
}

bool is_hash(const Column& column) {
  return std::holds_alternative<std::vector<std::uint64_t>>(column.values);
}

std::vector<std::uint32_t> shown_of(const PointCloud& cloud, const PointLimit& limit, std::size_t& measured) {
  std::vector<std::uint32_t> all;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.is_measured(i)) all.push_back(static_cast<std::uint32_t>(i));
  measured = all.size();
  const std::size_t every = (all.size() + limit.max_points - 1) / std::max<std::size_t>(limit.max_points, 1);
  if (every <= 1) return all;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i % every == 0 || limit.near.contains(cloud.point(all[i]))) all[kept++] = all[i];
  all.resize(kept);
  return all;
}

void append_positions(std::string& bytes, const PointCloud& cloud, const std::vector<std::uint32_t>& points,
                      const Vec3& corner_W, double step_m) {
  for (const std::uint32_t i : points) {
    const Vec3 number = (cloud.point(i) - corner_W) / step_m;
    for (int axis = 0; axis < 3; ++axis)
      append(bytes, static_cast<std::uint16_t>(std::clamp(number[axis] + 0.5, 0.0, kMaxNumber)));
  }
  pad(bytes);
}

}  // namespace

bool NearHand::contains(const Vec3& p_W) const {
  const double squared = reach_m * reach_m;
  return (p_W - hip_W).squaredNorm() <= squared || (p_W - proxy_W).squaredNorm() <= squared;
}

std::string columns_message(const std::vector<Column>& columns) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Column& column : columns)
    if (!is_hash(column))
      list.push_back({{"name", column.name},
                      {"unit", column.units},
                      {"meaning", column.long_name},
                      {"width", column.width},
                      {"names", column.value_names}});
  return nlohmann::ordered_json{{"columns", std::move(list)}}.dump();
}

std::string parameters_message(const LiveControls& controls, const std::string& refused) {
  return nlohmann::ordered_json{{"values", controls.values()}, {"refused", refused}}.dump();
}

std::string role_message(PageRole role) {
  return message_text({{"hand", role == PageRole::hand}});
}

std::string trouble_message(const LiveTrouble& trouble) {
  return message_text({{"trouble", {{"camera", trouble.camera}, {"force", trouble.force}}}});
}

std::string ended_message(const std::string& why) {
  return message_text({{"ended", why}});
}

std::string alive_message() {
  return message_text({{"alive", true}});
}

std::string state_message(const std::string& ended, bool is_full) {
  return message_text({{"protocol", kViewProtocol}, {"ended", ended}, {"full", is_full}});
}

std::string ticks_message(const std::vector<Column>& columns, std::uint32_t number) {
  std::string bytes;
  for (const std::uint32_t head : {kTicks, number, static_cast<std::uint32_t>(columns.front().length()), 0u})
    append(bytes, head);
  for (const Column& column : columns) {
    if (const auto* doubles = std::get_if<std::vector<double>>(&column.values))
      bytes.append(reinterpret_cast<const char*>(doubles->data()), 8 * doubles->size());
    else if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values))
      for (const std::int32_t value : *integers) append(bytes, static_cast<double>(value));
  }
  return bytes;
}

std::string frame_message(const PointCloud& cloud, std::int32_t index, const PointLimit& limit,
                          std::uint32_t number) {
  std::size_t measured = 0;
  const std::vector<std::uint32_t> points = shown_of(cloud, limit, measured);
  BoundingBox box;
  for (const std::uint32_t i : points) box.extend(cloud.point(i));
  const Vec3 corner_W = points.empty() ? Vec3(Vec3::Zero()) : Vec3(box.min());
  const double step_m =
      points.empty() ? 1 : std::max(box.sizes().maxCoeff(), 1e-6) / kMaxNumber;  // no NaN: measured points
  const bool colours = !cloud.colour.empty(), radii = !cloud.fixture_radius_m.empty();
  std::string bytes;
  bytes.reserve(64 + 16 * points.size());
  append(bytes, kFrame), append(bytes, number), append(bytes, index);
  append(bytes, static_cast<std::uint32_t>(points.size()));
  append(bytes, (colours ? kColours : 0u) | (radii ? kRadii : 0u));
  append(bytes, static_cast<std::uint32_t>(measured));
  append(bytes, step_m);
  for (int axis = 0; axis < 3; ++axis) append(bytes, corner_W[axis]);
  append_positions(bytes, cloud, points, corner_W, step_m);
  if (colours)
    for (const std::uint32_t i : points)
      for (const int shift : {16, 8, 0})
        bytes.push_back(static_cast<char>(shown_colour(cloud.colour[i]) >> shift));
  pad(bytes);
  if (radii)
    for (const std::uint32_t i : points) append(bytes, static_cast<float>(cloud.fixture_radius_m[i]));
  return bytes;
}

std::vector<Column> live_columns(const std::vector<LiveTick>& ticks, double haptic_rate_hz,
                                 const DevicePlacement& placement) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Trace trace;
  std::vector<double> force_N, torque_Nm, commanded_N, interval_s;  // world frame, three numbers a tick
  std::vector<std::int32_t> gate;
  const auto push = [](std::vector<double>& column, const Vec3& v) {
    column.insert(column.end(), v.begin(), v.end());
  };
  for (const LiveTick& tick : ticks) {
    trace.append(static_cast<double>(tick.number) / haptic_rate_hz, tick.device, tick.out,
                 {kUnknown, kUnknown, tick.hash}, {}, tick.slave);
    const Wrench written_W = placement.in_world(tick.written);
    push(force_N, written_W.force_N), push(torque_Nm, written_W.torque_Nm);
    push(commanded_N, tick.command.force_N);
    interval_s.push_back(tick.since_last_tick_s);
    gate.push_back(static_cast<std::int32_t>(tick.gate));
  }
  std::vector<Column> list = trace.columns();
  const auto add = [&](const char* name, const char* unit, const char* meaning, Values values, int width,
                       std::vector<std::string> names = {}) {
    list.push_back({name, unit, meaning, std::move(values), width, std::move(names)});
  };
  add("device_force", "N", "force that is sent to the device, world frame", force_N, 3);
  if (trace.has_slave())
    add("commanded_force", "N", "force that the device is to exert, before the safety gate, world frame",
        commanded_N, 3);
  if (trace.has_tool())
    add("device_torque", "N m", "torque that is sent to the device, world frame", torque_Nm, 3);
  add("tick_interval", "s", "time since the start of the tick before", interval_s, 1);
  add("gate", "1", "state of the safety gate", gate, 1, {"waiting", "ramping", "engaged", "latched"});
  return list;
}

LiveChannel::LiveChannel(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
                         std::shared_ptr<PageHand> hand, std::shared_ptr<LiveControls> controls,
                         double near_m)
    : rate_hz_(haptic_rate_hz),
      placement_(placement),
      kernels_(kernels),
      hand_(std::move(hand)),
      controls_(std::move(controls)),
      near_m_(near_m) {}

// Drops the waiting ticks if there is no memory: a page that lacks some ticks is better than a run that ends.
void LiveChannel::take(const LiveTick& tick) noexcept {
  if (!is_open_.load(std::memory_order_relaxed)) return;
  const std::lock_guard lock(mutex_);
  hip_W_ = tick.device.position_W, proxy_W_ = tick.out.proxy_W;
  try {
    if (ticks_.size() >= kMaxRows) ticks_ = {};
    ticks_.push_back(tick);
  } catch (const std::bad_alloc&) {
    ticks_ = {};
  }
}

void LiveChannel::take(const Frame& frame) noexcept {
  const std::lock_guard lock(mutex_);
  points_ = frame.points;
  index_ = frame.index;
  frame_is_new_ = true;
}

void LiveChannel::open(PageRole role, const std::string& trouble) {
  const std::lock_guard lock(mutex_);
  ticks_ = {};
  frame_is_new_ = points_ != nullptr;
  sent_columns_ = was_frame_ = false;
  sent_ = acknowledged_ = 0;
  role_ = role;
  texts_ = {role_message(role)};
  if (!trouble.empty()) texts_.push_back(trouble);
  if (controls_->has_changed()) texts_.push_back(values_text_ = parameters_message(*controls_, {}));
  is_ended_ = false;
  is_open_ = true;
}

// Only the first call releases buttons: another page may have the hand at the next one.
void LiveChannel::close() {
  if (is_open_.exchange(false) && role_ == PageRole::hand) hand_->release_buttons();
}

// A role that still waits to be sent is dropped, so that pages which take the hand from each other cannot
// fill the queue of a slow page.
void LiveChannel::set_role(PageRole role) {
  role_ = role;
  const std::lock_guard lock(mutex_);
  for (const PageRole any : {PageRole::hand, PageRole::watches}) std::erase(texts_, role_message(any));
  texts_.push_back(role_message(role));
}

// A waiting text has older values. Without this, changes of one page would fill the queue of a slow one.
void LiveChannel::tell_parameters(const std::string& refused) {
  std::string text = parameters_message(*controls_, refused);
  const std::lock_guard lock(mutex_);
  std::erase(texts_, values_text_);
  if (refused.empty()) values_text_ = text;
  texts_.push_back(std::move(text));
}

void LiveChannel::tell(std::string text) {
  const std::lock_guard lock(mutex_);
  texts_.push_back(std::move(text));
}

void LiveChannel::end(std::string last) {
  const std::lock_guard lock(mutex_);
  if (is_ended_) return;
  is_ended_ = true;
  last_ = std::move(last);
}

bool LiveChannel::is_over() {
  const std::lock_guard lock(mutex_);
  return is_ended_ && last_.empty();
}

bool LiveChannel::receive(std::string_view bytes) {
  const auto message = page_message(bytes);
  const auto* acknowledged = message ? std::get_if<PageAcknowledgement>(&*message) : nullptr;
  const bool is_allowed =
      message && (acknowledged ? acknowledged->number - acknowledged_ <= sent_ - acknowledged_ : has_hand());
  if (!is_allowed) return false;
  if (acknowledged) {
    acknowledged_ = acknowledged->number;
  } else if (const auto* changes = std::get_if<ParameterChanges>(&*message)) {
    tell_parameters(controls_->change(*changes));
  } else if (const auto* pose = std::get_if<DeviceState>(&*message)) {
    hand_->move(*pose);
  } else {
    return false;  // LivePages handles requests for the hand
  }
  return true;
}

bool LiveChannel::next_text(Message& message) {
  const std::lock_guard lock(mutex_);
  if (is_ended_ && !last_.empty()) {
    message = {std::exchange(last_, {}), true};
    return true;
  }
  if (!sent_columns_ || texts_.empty()) return false;
  message = {std::move(texts_.front()), true};
  texts_.erase(texts_.begin());
  return true;
}

bool LiveChannel::next(Message& message) {
  if (next_text(message)) return true;
  if (sent_ - acknowledged_ >= kMaxInFlight) return false;
  std::shared_ptr<const NeighbourSearch> points;
  std::int32_t index = 0;
  {
    const std::lock_guard lock(mutex_);
    if (ticks_.empty()) return false;
    // Ticks and frames alternate. Otherwise a page that is slower than the camera would receive frames only,
    // because a new frame is always ready.
    was_frame_ = sent_columns_ && frame_is_new_ && !was_frame_;
    if (was_frame_) points = points_, index = index_, frame_is_new_ = false;
  }
  message = points ? frame_message_of(*points, index) : tick_message();
  return true;
}

LiveChannel::Message LiveChannel::tick_message() {
  std::vector<LiveTick> ticks;
  {
    const std::lock_guard lock(mutex_);
    if (!sent_columns_) {
      sent_columns_ = true;
      return {columns_message(live_columns(ticks_, rate_hz_, placement_)), true};
    }
    std::swap(ticks, ticks_);
  }
  return {ticks_message(live_columns(ticks, rate_hz_, placement_), ++sent_), false};
}

LiveChannel::Message LiveChannel::frame_message_of(const NeighbourSearch& points, std::int32_t index) {
  PointCloud buffer;
  return {frame_message(points.every_point(kernels_, buffer), index, {kMaxPoints, near_hand()}, ++sent_),
          false};
}

NearHand LiveChannel::near_hand() {
  double reach_m = near_m_;
  for (std::size_t i = 0; i < controls_->parameters().size(); ++i)
    if (const LiveParameter& p = controls_->parameters()[i]; p.name == "renderer.r1_m" && p.value > 0)
      reach_m *= controls_->values()[i] / p.value;
  const std::lock_guard lock(mutex_);
  return {hip_W_, proxy_W_, reach_m};
}

}  // namespace remote_touch
