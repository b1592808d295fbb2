#include "analysis/trace/sequence_log.h"

#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

void end(SequenceEntry& entry, const Trace& t, std::size_t tick, bool missed) {
  entry.ended_s = t.time_s[tick];
  entry.missed = missed;
  entry.distance_m = t.sequence_distance_m[tick], entry.angle_rad = t.sequence_angle_rad[tick];
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

}  // namespace remote_touch
