#include "runners/live/loop/jitter.h"

#include <algorithm>
#include <cstdio>

#include "runners/interfaces/cli/commands.h"
#include "runners/live/devices/steady_clock.h"
#include "runners/live/loop/live_report.h"

namespace remote_touch {

int command_jitter(const CommandLine& line, const JitterRequest& request) {
  Jitter jitter = measure_jitter(request.duration_s, request.rate_hz, line.stop, steady_clock());
  std::printf("%zu ticks at %g Hz: %s\n", jitter.late_s.size(), request.rate_hz, jitter.real_time.c_str());
  std::fputs(histogram(jitter.late_s).c_str(), stdout);
  std::sort(jitter.late_s.begin(), jitter.late_s.end());
  const auto us = [&](double fraction) { return 1e6 * quantile(jitter.late_s, fraction); };
  std::printf("  late by p50 %.1f, p99 %.1f, p99.9 %.1f, at most %.1f us; missed %lld\n", us(0.5), us(0.99),
              us(0.999), us(1), jitter.missed);
  return kDone;
}

}  // namespace remote_touch
