#include "runners/live/view/view_messages.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/geometry/colour.h"
#include "core/geometry/vector.h"

namespace remote_touch {

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
  const double step_m = points.empty() ? 1 : std::max(box.sizes().maxCoeff(), 1e-6) / kMaxNumber;
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

}  // namespace remote_touch
