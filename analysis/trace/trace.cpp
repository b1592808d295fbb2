#include "analysis/trace/trace.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

namespace remote_touch {

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::string joined(const std::vector<std::string>& names, const char* separator) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : separator) + name;
  return all;
}

std::vector<std::string> split_names(const std::string& joined) {
  std::vector<std::string> list;
  std::istringstream text(joined);
  text.exceptions(std::ios::badbit);  // throws if memory runs out, instead of ending the list early
  for (std::string name; std::getline(text, name, ',');) list.push_back(name);
  return list;
}

const std::vector<double>& numbers(const Table& table, const std::string& column) {
  for (const Column& candidate : table.columns)
    if (candidate.name == column) return std::get<std::vector<double>>(candidate.values);
  throw std::out_of_range(table.name + " has no column " + column);
}

Tolerance tolerance_of(const Tolerances& tolerances, const std::string& name) {
  for (const std::string& key : {name, std::string("*")})
    if (const auto found = tolerances.find(key); found != tolerances.end()) return found->second;
  return {};
}

bool within(const Tolerance& tolerance, double baseline, double candidate) {
  if (std::isnan(baseline) || std::isnan(candidate)) return std::isnan(baseline) && std::isnan(candidate);
  if (baseline == candidate) return true;
  if (!std::isfinite(baseline) || !std::isfinite(candidate)) return false;
  return std::abs(candidate - baseline) <= tolerance.absolute + tolerance.relative * std::abs(baseline);
}

namespace {

template <class Number>
std::uint64_t word(Number value) {
  if constexpr (std::is_same_v<Number, double>)
    return std::isnan(value) ? 0x7ff8000000000000u
                             : std::bit_cast<std::uint64_t>(value + 0.0);  // -0 + 0 is 0
  else
    return static_cast<std::uint64_t>(value);
}

template <class Number>
void mix_rows(const std::vector<Number>& values, std::size_t width, std::vector<std::uint64_t>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < width; ++k) rows[i] = mixed(rows[i], word(values[i * width + k]));
}

void mix_rows(const std::vector<std::string>&, std::size_t, std::vector<std::uint64_t>&) {}

void end(SequenceEntry& entry, const Trace& t, std::size_t tick, bool missed) {
  entry.ended_s = t.time_s[tick];
  entry.missed = missed;
  entry.distance_m = t.sequence_distance_m[tick], entry.angle_rad = t.sequence_angle_rad[tick];
}

// The data of a tick that the expressions in trace_columns.h may use.
struct TraceTick {
  double time_s;
  const DeviceState& device;
  const RenderOutput& out;
  const Trace::Truth& truth;
  const std::optional<HandState>& hand;
  const std::optional<SlaveState>& slave;
};

bool has(const TraceTick& tick, TracePart part) {
  return part == TracePart::always || (part == TracePart::tool && tick.out.tool) ||
         (part == TracePart::guidance && tick.out.guidance) || (part == TracePart::hand && tick.hand) ||
         (part == TracePart::replay && tick.truth.expected_force_N) ||
         (part == TracePart::measured_surface && tick.truth.measured_distance_m) ||
         (part == TracePart::rounded_hand && tick.hand && tick.hand->true_pose) ||
         (part == TracePart::slave && tick.slave) ||
         (part == TracePart::channel_energy && tick.slave && tick.slave->energy) ||
         (part == TracePart::slave_tool && tick.slave && tick.slave->tool);
}

bool has(const Trace& trace, TracePart part) {
  return part == TracePart::always || (part == TracePart::tool && trace.has_tool()) ||
         (part == TracePart::guidance && trace.has_guidance()) ||
         (part == TracePart::hand && trace.has_hand()) || (part == TracePart::replay && trace.has_replay()) ||
         (part == TracePart::measured_surface && trace.has_measured_surface()) ||
         (part == TracePart::rounded_hand && trace.has_rounded_hand()) ||
         (part == TracePart::slave && trace.has_slave()) ||
         (part == TracePart::channel_energy && trace.has_channel_energy()) ||
         (part == TracePart::slave_tool && trace.has_slave_tool());
}

template <class Number>
Values flat(const std::vector<Number>& rows) {
  return rows;
}
Values flat(const std::vector<Vec3>& rows) {
  std::vector<double> numbers;
  numbers.reserve(3 * rows.size());
  for (const Vec3& row : rows) numbers.insert(numbers.end(), {row.x(), row.y(), row.z()});
  return numbers;
}
Values flat(const std::vector<Eigen::Quaterniond>& rows) {
  std::vector<double> numbers;
  numbers.reserve(4 * rows.size());
  for (const auto& row : rows) numbers.insert(numbers.end(), {row.w(), row.x(), row.y(), row.z()});
  return numbers;
}

// The inverse of flat(). Returns false if the column has another type or width. A missing column has no rows.
template <class Number>
bool read_rows(std::optional<Column> column, std::vector<Number>& rows) {
  if (!column) return true;
  auto* numbers = std::get_if<std::vector<Number>>(&column->values);
  if (numbers == nullptr || column->width != 1) return false;
  rows = std::move(*numbers);
  return true;
}
template <class Row>
bool read_rows(const std::optional<Column>& column, int width, std::vector<Row>& rows,
               Row (*row)(const double*)) {
  if (!column) return true;
  const auto* numbers = std::get_if<std::vector<double>>(&column->values);
  if (numbers == nullptr || column->width != width) return false;
  rows.reserve(column->length());
  for (std::size_t i = 0; i < column->length(); ++i)
    rows.push_back(row(numbers->data() + i * static_cast<std::size_t>(width)));
  return true;
}
bool read_rows(const std::optional<Column>& column, std::vector<Vec3>& rows) {
  return read_rows<Vec3>(column, 3, rows, [](const double* at) { return Vec3(at[0], at[1], at[2]); });
}
bool read_rows(const std::optional<Column>& column, std::vector<Eigen::Quaterniond>& rows) {
  return read_rows<Eigen::Quaterniond>(
      column, 4, rows, [](const double* at) { return Eigen::Quaterniond(at[0], at[1], at[2], at[3]); });
}

// Meaning of a column in the table, for runs without and with a tool.
struct Meaning {
  Meaning(const char* of_every_run) : without_tool(of_every_run), with_tool(of_every_run) {}
  Meaning(const char* of_proxy, const char* of_tool) : without_tool(of_proxy), with_tool(of_tool) {}
  const char *without_tool, *with_tool;
};

Meaning proxy_or_tool(const char* of_proxy, const char* of_tool) {
  return {of_proxy, of_tool};
}

template <class... Texts>
std::vector<std::string> names(Texts... texts) {
  return {texts...};
}

std::vector<TraceColumn> make_table() {
  std::vector<TraceColumn> table;
  const auto add = [&table](const char* name, const char* unit, TracePart part, std::size_t row_bytes,
                            Values (*values)(const Trace&), const Meaning& meaning,
                            std::vector<std::string> value_names = {}) {
    const int width = std::max(1, static_cast<int>(row_bytes / 8));
    table.push_back(
        {name, unit, meaning.without_tool, meaning.with_tool, part, width, std::move(value_names), values});
  };
#define TRACE_COLUMN(member, Row, name, unit, part, value, ...)                                        \
  add(                                                                                                 \
      name, unit, TracePart::part, sizeof(Row), [](const Trace& trace) { return flat(trace.member); }, \
      __VA_ARGS__);
#include "analysis/trace/trace_columns.h"
#undef TRACE_COLUMN
  add(kRunningHash, "1", TracePart::always, 8, nullptr, "64-bit hash of all columns up to this tick");
  return table;
}

}  // namespace

std::uint64_t points_hash(const PointCloud& cloud) {
  std::uint64_t sum = cloud.size();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::uint64_t point = mixed(mixed(mixed(1, word(cloud.x[i])), word(cloud.y[i])), word(cloud.z[i]));
    if (!cloud.fixture_radius_m.empty()) point = mixed(point, word(cloud.fixture_radius_m[i]));
    if (!cloud.stiffness_N_per_m.empty()) point = mixed(point, word(cloud.stiffness_N_per_m[i]));
    if (cloud.has_normals())
      point = mixed(mixed(mixed(point, word(cloud.nx[i])), word(cloud.ny[i])), word(cloud.nz[i]));
    sum += mixed(point, point >> 29);  // terms of a sum have to look random in every bit
  }
  return sum;
}

std::vector<std::uint64_t> running_hash(const std::vector<Column>& columns) {
  std::vector<std::uint64_t> hashes(columns.empty() ? 0 : columns.front().length(), 0);
  for (const Column& column : columns)
    std::visit([&](const auto& v) { mix_rows(v, static_cast<std::size_t>(column.width), hashes); },
               column.values);
  std::uint64_t chain = 0;
  for (std::uint64_t& hash : hashes) hash = chain = mixed(chain, hash);
  return hashes;
}

std::vector<SequenceEntry> sequence_log(const Trace& t) {
  std::vector<SequenceEntry> log;
  if (!t.has_guidance()) return log;
  int step = 0, missed = 0;
  bool running = false;
  for (std::size_t i = 0; i < t.length(); ++i) {
    // Only the step that was running before this tick can have reached its deadline: the others began in this
    // tick.
    bool late = t.sequence_missed[i] > missed;
    for (; step < t.sequence_step[i]; ++step) {
      if (!running) log.push_back({step, t.time_s[i]});
      end(log.back(), t, i, late);
      running = late = false;
    }
    if (!running && t.sequence_running[i]) log.push_back({step, t.time_s[i]}), running = true;
    missed = t.sequence_missed[i];
  }
  return log;
}

const std::vector<TraceColumn>& trace_columns() {
  static const std::vector<TraceColumn> table = make_table();
  return table;
}

void Trace::reserve(std::size_t ticks) {
#define TRACE_COLUMN(member, Row, name, unit, part, ...) \
  if (TracePart::part == TracePart::always) member.reserve(ticks);
#include "analysis/trace/trace_columns.h"
#undef TRACE_COLUMN
}

void Trace::append(double time, const DeviceState& device, const RenderOutput& out, const Truth& truth,
                   const std::optional<HandState>& hand, const std::optional<SlaveState>& slave) {
  const TraceTick t{time, device, out, truth, hand, slave};
#define TRACE_COLUMN(member, Row, name, unit, part, value, ...) \
  if (has(t, TracePart::part)) member.push_back(static_cast<Row>(value));
#include "analysis/trace/trace_columns.h"
#undef TRACE_COLUMN
  if (truth.contact) contact.push_back(*truth.contact);
  if (truth.normal) true_normal.push_back(*truth.normal);
}

std::optional<Trace> trace_of(const std::function<std::optional<Column>(const std::string&)>& column) {
  Trace trace;
#define TRACE_COLUMN(member, Row, name, ...) \
  if (!read_rows(column(name), trace.member)) return std::nullopt;
#include "analysis/trace/trace_columns.h"
#undef TRACE_COLUMN
#define TRACE_COLUMN(member, Row, name, unit, part, ...) \
  if (trace.member.size() != (has(trace, TracePart::part) ? trace.length() : 0)) return std::nullopt;
#include "analysis/trace/trace_columns.h"
#undef TRACE_COLUMN
  return trace;
}

std::vector<Column> Trace::columns() const {
  std::vector<Column> list;
  for (const TraceColumn& column : trace_columns()) {
    if (!has(*this, column.part)) continue;
    list.push_back({column.name, column.unit, has_tool() ? column.meaning_with_tool : column.meaning,
                    column.values ? column.values(*this) : running_hash(list), column.width,
                    column.value_names});
  }
  return list;
}

}  // namespace remote_touch
