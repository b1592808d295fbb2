#include "analysis/trace/trace.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace remote_touch {

namespace {

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
