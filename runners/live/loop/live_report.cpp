#include "runners/live/loop/live_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>
#include <utility>

#include "analysis/report/report.h"
#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/sensor_table.h"

namespace remote_touch {

std::vector<InputPart> live_inputs(const Experiment& experiment, const std::string& device,
                                   const std::string& depth, bool has_view) {
  const Uri hand = parse_uri("--device", device);
  const std::string scheme = find_scheme(devices(), "--device", hand).scheme;
  const std::vector<InputPart> sensed = sensor_inputs(depth);
  const bool is_replayed = scheme == "replay";
  const bool reads_trajectory = has_view || scheme == "sim" || scheme == "browser";
  std::vector<std::string> except;
  if (!reads_trajectory) except.emplace_back("trajectory");
  if (!reads_trajectory && !is_replayed && !depth.starts_with("sim:")) except.emplace_back("scenario");
  std::vector<InputPart> inputs = experiment.inputs(except);
  if (is_replayed && !hand.address.empty()) inputs.push_back({hand.address});
  inputs.insert(inputs.end(), sensed.begin(), sensed.end());
  return inputs;
}

namespace {

// A live session loses single frames without harm: the next one comes a thirtieth of a second later.
constexpr double kUnusedShare = 0.1;

std::string frames_line(const LiveFacts& facts) {
  return std::to_string(facts.camera.received) + " frame(s) from " + facts.depth + ", " +
         layout_text(facts.view) + formatted(" at %.4g Hz; ", facts.view.frame_rate_hz) +
         std::to_string(facts.sensed.frames()) + " processed: " + facts.sensed.text();
}

void add_unused_frames(const CameraCounts& camera, std::vector<Note>& notes) {
  const std::pair<int, const char*> parts[] = {
      {camera.skipped, "not sent, or replaced before they were processed"},
      {camera.reversed, "reversed or repeated"},
      {camera.incomplete, "without all pixels or colours"},
      {camera.unrecorded, "dropped for the recorder"},
      {camera.overtaken, "replaced before the haptic loop used them"}};
  const int all = camera.received + camera.skipped;
  int unused = 0;
  std::string reasons;
  for (const auto& [count, reason] : parts) {
    unused += count;
    if (count > 0) reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  }
  if (unused > kUnusedShare * all)
    notes.push_back({"frames unused", std::to_string(unused) + " of " + std::to_string(all) +
                                          " frames were not used: " + reasons});
}

LiveReport::Times times_of(const char* name, const char* key, const Samples& samples) {
  LiveReport::Times times{name, key, samples.kept(), samples.size(), samples.least(), samples.greatest()};
  std::sort(times.sorted.begin(), times.sorted.end());
  return times;
}

// Fractions 0 and 1 return the least and the greatest of all samples. Others are of the samples that were
// kept.
double quantile_of(const LiveReport::Times& times, double fraction) {
  return fraction <= 0 ? times.least : fraction >= 1 ? times.greatest : quantile(times.sorted, fraction);
}

double missed_percent(const LiveLog& log, double ticks) {
  const auto missed = static_cast<double>(log.missed_ticks);
  return ticks > 0 ? 100 * missed / (ticks + missed) : kNoValue;
}

double mean_processing_us(const CameraCounts& camera) {
  const int handled = camera.received - camera.reversed - camera.incomplete - camera.unrecorded;
  return handled > 0 ? 1e6 * camera.processing_s / handled : kNoValue;
}

double longest_pause_ms(const CameraCounts& camera) {
  return camera.received - camera.reversed > 1 ? 1e3 * camera.max_pause_s : kNoValue;
}

std::string text_or_none(const char* format, double value) {
  return std::isnan(value) ? "none" : formatted(format, value);
}

// Returns at most kSamples + 1 points of a curve: the share of times that were as long or longer, over the
// time. The points are closer where the share is small.
Table longer_than(const LiveReport::Times& times) {
  constexpr double kSamples = 400;
  const auto count = static_cast<double>(times.sorted.size());
  std::vector<double> log_us, log_fraction;
  std::size_t last = times.sorted.size();
  for (double sample = 0; sample <= kSamples; ++sample) {
    const double fraction = std::pow(count, -sample / kSamples);  // 1 to 1 / count
    const auto at = static_cast<std::size_t>(std::lround(count * (1 - fraction)));
    if (at >= times.sorted.size() || at == last) continue;
    last = at;
    log_us.push_back(std::log10(std::max(1e6 * times.sorted[at], 1e-2)));  // no NaN
    log_fraction.push_back(std::log10((count - static_cast<double>(at)) / count));
  }
  Table table{times.key, times.name};
  table.add("time", "1", "log10 of the time in us", std::move(log_us));
  table.add("fraction", "1", "log10 of the share that took as long or longer", std::move(log_fraction));
  return table;
}

// Returns a table with the names of what was measured or counted.
template <class Row>
Table table_of(const char* name, const char* title, const char* meaning, const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (const Row& row : rows) names.emplace_back(row.name);
  Table table{name, title};
  table.columns.push_back({"what", "1", meaning, std::move(names), 1, {}});
  return table;
}

Table times_table(const LiveReport& report) {
  Table table = table_of("times", "Times of the run", "what was measured", report.times);
  const auto add = [&](const std::string& name, const char* unit, const std::string& meaning,
                       auto&& value_of) {
    std::vector<double> values;
    for (const auto& times : report.times) values.push_back(value_of(times));
    table.add(name, unit, meaning, std::move(values));
  };
  add("count", "1", "how many there were",
      [](const auto& times) { return static_cast<double>(times.count); });
  const std::pair<const char*, double> fractions[] = {
      {"least", 0}, {"p50", 0.5}, {"p99", 0.99}, {"p99_9", 0.999}, {"largest", 1}};
  for (const auto& [name, fraction] : fractions)
    add(name, "s", std::string(name) + " of the times",
        [fraction = fraction](const auto& times) { return quantile_of(times, fraction); });
  return table;
}

Table counts_table(const LiveReport& report) {
  Table table = table_of("counts", "What was counted", "what was counted", report.counts);
  std::vector<double> values;
  for (const auto& count : report.counts) values.push_back(count.value);
  table.add("value", "1", "how many, or in the unit that is named", std::move(values));
  return table;
}

class NoDevice final : public HapticDevice {
 public:
  NoDevice(double rate_hz, Clock& clock)
      : HapticDevice(clock, {.name = "no device", .tick_rate_hz = rate_hz}) {}
  DeviceFault read(DeviceReading&) noexcept override { return {}; }
  DeviceFault write(const Wrench&) noexcept override { return {}; }
  void release() noexcept override {}
};

}  // namespace

std::vector<Phase> simulated_phases(const Experiment& experiment, const std::string& device,
                                    const std::string& depth, const Kernels& kernels) {
  const auto is_simulated = [](const std::string& address) { return address.starts_with("sim:"); };
  std::vector<Phase> phases = experiment.phases();
  const auto add = [&](std::vector<Phase> more) {
    for (Phase& phase : more) phases.push_back(std::move(phase));
  };
  if (!is_simulated(device) && !is_simulated(depth)) return phases;
  const auto scenario = experiment.build_scenario(kernels);
  if (is_simulated(depth)) add(scenario->phases());
  if (is_simulated(device)) {
    add(experiment.build_trajectory(*scenario)->phases());
    add(experiment.operator_phases());
  }
  return phases;
}

RunReport report_of(const LiveFacts& facts) {
  RunReport report;
  report.inputs.push_back(frames_line(facts));
  if (facts.log.latency_s.size() == 0)
    report.notes.push_back({"no frame", "no frame arrived before the session ended"});
  else if (facts.log.contact_ticks == 0)
    report.notes.push_back(no_contact_note());
  add_unused_frames(facts.camera, report.notes);
  add_missed_phases(facts.phases, static_cast<double>(facts.log.end_tick()) / facts.haptic_rate_hz,
                    report.notes);
  return report;
}

double quantile(const std::vector<double>& sorted, double fraction) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  return sorted[static_cast<std::size_t>(std::lround(fraction * static_cast<double>(sorted.size() - 1)))];
}

LiveReport live_report(const LiveLog& log, const LiveCounts& counts) {
  const CameraCounts& camera = counts.camera;
  const auto number = [](auto count) { return static_cast<double>(count); };
  const double ticks = number(log.ticks);
  LiveReport report;
  report.times = {times_of("step, including the new frame", "step", log.step_s),
                  times_of("from tick to tick", "interval", log.interval_s),
                  times_of("frame: sensor's stamp to force", "latency", log.latency_s),
                  times_of("frame: from ready to used", "waited", log.waited_s)};
  report.counts = {{"ticks", ticks},
                   {"missed deadlines", number(log.missed_ticks)},
                   {"missed deadlines, percent", missed_percent(log, ticks)},
                   {"ticks that ended before the tool came to rest", number(log.exhausted_ticks)},
                   {"ticks without force: gate waiting or latched", number(log.zero_force_ticks)},
                   {"ticks with a force or torque limited for safety", number(log.limited_ticks)},
                   {"ticks on a cloud older than 0.2 s and 2.5 frames", number(log.stale_ticks)},
                   {"stalls, device released", number(counts.stalls)},
                   {"rows lost", number(counts.rows_lost)},
                   {"frames received", number(camera.received)},
                   {"processing of a frame, mean us", mean_processing_us(camera)},
                   {"longest pause between frames, ms", longest_pause_ms(camera)},
                   {"frames skipped: not sent, or replaced unprocessed", number(camera.skipped)},
                   {"frames reversed or repeated by the sensor, dropped", number(camera.reversed)},
                   {"frames without all their pixels or colours, dropped", number(camera.incomplete)},
                   {"frames not sent, within the dead-band", number(camera.held_back)},
                   {"frames replaced before the haptic loop used them", number(camera.overtaken)},
                   {"frames dropped for the recorder", number(camera.unrecorded)},
                   {"frames used in the wrong order", number(log.reversed_frames)},
                   {"largest force written, N", log.ticks > 0 ? log.max_force_N : kNoValue}};
  report.piece_s = log.pieces.begin_s(), report.max_interval_s = log.pieces.greatest();
  return report;
}

std::string text(const LiveReport& report) {
  ReportTable times, counts{.has_headings = false};
  for (const LiveReport::Times& each : report.times) {
    ReportRow& row = times.rows.emplace_back();
    row.show("times in us", each.name).add("", "count", each.count);
    for (const auto& [heading, fraction] :
         {std::pair("least", 0.0), {"p50", 0.5}, {"p99", 0.99}, {"p99.9", 0.999}, {"largest", 1.0}}) {
      const double time_us = 1e6 * quantile_of(each, fraction);
      row.show(heading, text_or_none("%.1f", time_us), time_us);
    }
  }
  for (const auto& [name, value] : report.counts)
    counts.rows.emplace_back()
        .show("what", name)
        .show("value", text_or_none(value == std::floor(value) ? "%.0f" : "%.3g", value), value);
  return times.text() + counts.text();
}

Figure live_figure(const LiveReport& report) {
  Figure figure{
      "live", "Times of a live run",
      "Above: the share of ticks or frames that took as long or longer. Below: the longest time from "
      "one tick to the next, over the run."};
  figure.tables = {times_table(report), counts_table(report)};
  Panel fractions{"How often", "log10 of the time in us", "log10 of the share that took as long or longer"};
  for (const auto& times : report.times) {
    if (times.sorted.empty()) continue;
    figure.tables.push_back(longer_than(times));
    fractions.curves.push_back({times.key, "time", "fraction", CurveStyle::steps, times.name});
  }
  Table pieces{"late", "Longest time from tick to tick"};
  pieces.add("time", "s", "beginning of the piece of the run", report.piece_s);
  std::vector<double> log_us;
  for (const double max_length : report.max_interval_s) log_us.push_back(std::log10(1e6 * max_length));
  pieces.add("longest", "1", "log10 of the longest time from tick to tick in us", std::move(log_us));
  Panel when{"When", "time (s)", "log10 of the longest time from tick to tick in us"};
  if (!report.piece_s.empty()) when.curves.push_back({"late", "time", "longest", CurveStyle::line});
  figure.tables.push_back(std::move(pieces));
  figure.panels = {std::move(fractions), std::move(when)};
  return figure;
}

// Lateness is measured against the grid of the loop: it starts when the loop does, and its period is a whole
// number of nanoseconds, see HapticDevice::run(). On another grid a punctual tick could get the number of the
// tick before.
Jitter measure_jitter(double duration_s, double rate_hz, const std::atomic<bool>* stop, Clock& clock) {
  Jitter jitter;
  const double max = duration_s * rate_hz;
  jitter.late_s.reserve(static_cast<std::size_t>(max) + 1);
  const std::int64_t period_ns = std::llround(1e9 / rate_hz);
  NoDevice device(rate_hz, clock);
  std::thread loop([&] {
    jitter.real_time = become_real_time();
    long long last = -1;
    const std::int64_t start_ns = clock.now_ns();
    device.run([&] {
      const std::int64_t since_ns = clock.now_ns() - start_ns;
      const long long number = since_ns / period_ns;
      if (static_cast<double>(number) >= max || (stop && *stop)) return false;
      jitter.missed += std::max(0LL, number - last - 1);
      last = number;
      jitter.late_s.push_back(1e-9 * static_cast<double>(since_ns - number * period_ns));
      return true;
    });
  });
  loop.join();
  return jitter;
}

std::string histogram(const std::vector<double>& late_s) {
  constexpr int kRows = 16, kBar = 50;
  constexpr double kFirst_us = 4;
  std::array<long long, kRows> counts{};
  for (const double late : late_s) {
    const double doubled = std::log2(std::max(1e6 * late, 1e-3) / kFirst_us);  // no NaN
    ++counts[static_cast<std::size_t>(std::clamp(static_cast<int>(std::ceil(doubled)), 0, kRows - 1))];
  }
  const long long max = *std::max_element(counts.begin(), counts.end());  // no NaN
  std::string text;
  for (int i = 0; i < kRows; ++i) {
    const long long count = counts[static_cast<std::size_t>(i)];
    if (count == 0) continue;
    const std::string row =
        formatted("  %8.0f to %8.0f us %10lld %s\n", i == 0 ? 0 : std::ldexp(kFirst_us, i - 1),
                  std::ldexp(kFirst_us, i), count,
                  std::string(static_cast<std::size_t>((kBar * count + max - 1) / max), '#').c_str());
    text += row;
  }
  return text;
}

}  // namespace remote_touch
