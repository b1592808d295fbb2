#include "runners/live/live_log.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace remote_touch {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

void LiveLog::append(const LiveTick& tick, double haptic_rate_hz) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  trace.append(static_cast<double>(tick.number) / haptic_rate_hz, tick.device, tick.out,
               {kUnknown, kUnknown, tick.hash});
  step_s.push_back(tick.step_s);
  if (last_number_ >= 0) {
    interval_s.push_back(tick.since_last_tick_s);
    missed_ticks += tick.number - last_number_ - 1;
  }
  last_number_ = tick.number;
  if (tick.taken >= 0) {
    latency_s.push_back(tick.latency_s);
    waited_s.push_back(tick.waited_s);
    reversed_frames += tick.taken <= last_taken_ ? 1 : 0;
    last_taken_ = tick.taken, taken_at_ = tick.number;
  }
  exhausted_ticks += tick.out.tool && tick.out.tool->budget_exhausted ? 1 : 0;
  limp_ticks += tick.gate == GateState::waiting || tick.gate == GateState::latched ? 1 : 0;
  stale_ticks += static_cast<double>(tick.number - taken_at_) > kStaleFrame_s * haptic_rate_hz ? 1 : 0;
  largest_force_N = std::max(largest_force_N, tick.written.force_N.norm());
}

namespace {

std::string times_row(const char* what, const std::vector<double>& times_s) {
  char row[160];
  const auto us = [&](double share) { return 1e6 * quantile(times_s, share); };
  std::snprintf(row, sizeof row, "  %-34s %9zu %9.1f %9.1f %9.1f %9.1f %9.1f\n", what, times_s.size(), us(0),
                us(0.5), us(0.99), us(0.999), us(1));
  return row;
}

std::string count_row(const char* what, std::int64_t count, const std::string& of = {}) {
  char row[160];
  std::snprintf(row, sizeof row, "  %-50s %12lld%s\n", what, static_cast<long long>(count), of.c_str());
  return row;
}

}  // namespace

std::string live_report(const LiveLog& log, const CameraCounts& camera, int stalls, std::int64_t rows_lost) {
  const auto ticks = static_cast<std::int64_t>(log.trace.length());
  char share[64];
  std::snprintf(share, sizeof share, "  (%.3g %%)",
                ticks > 0 ? 100.0 * static_cast<double>(log.missed_ticks) /
                                static_cast<double>(ticks + log.missed_ticks)
                          : 0.0);
  std::string text =
      "  times in us                            count     least       p50       p99     p99.9   largest\n";
  text += times_row("step, the frame taken included", log.step_s);
  text += times_row("from tick to tick", log.interval_s);
  text += times_row("frame: sensor's stamp to force", log.latency_s);
  text += times_row("frame: ready to taken", log.waited_s);
  text += count_row("ticks", ticks);
  text += count_row("missed deadlines", log.missed_ticks, share);
  text += count_row("ticks that ended before the tool came to rest", log.exhausted_ticks);
  text += count_row("ticks without force: gate waiting or latched", log.limp_ticks);
  text += count_row("ticks on a cloud older than 0.2 s", log.stale_ticks);
  text += count_row("stalls, the device let go", stalls);
  text += count_row("rows lost", rows_lost);
  text += count_row("frames received", camera.received);
  const double handled =
      std::max(1, camera.received - camera.reversed - camera.incomplete - camera.unrecorded);
  text += count_row("processing of a frame, mean us", std::llround(1e6 * camera.processing_s / handled));
  text += count_row("longest pause between frames, ms", std::llround(1e3 * camera.longest_pause_s));
  text += count_row("frames that the sensor counted and never sent", camera.passed_over);
  text += count_row("frames reversed or repeated by the sensor, dropped", camera.reversed);
  text += count_row("frames without all their pixels or colours, dropped", camera.incomplete);
  text += count_row("frames overtaken before the haptic loop took them", camera.overtaken);
  text += count_row("frames dropped for the recorder", camera.unrecorded);
  text += count_row("frames taken in the wrong order", log.reversed_frames);
  return text;
}

}  // namespace remote_touch
