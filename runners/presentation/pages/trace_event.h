// Events of a run that are worth looking at.
#pragma once

#include <string>
#include <vector>

#include "analysis/comparison/compared_columns.h"

namespace remote_touch {

struct TraceEvent {
  std::size_t tick;
  const char* kind;  // one of the kinds below, or "divergence", see ShownRun
  std::string text;  // sentence for the reader
};

// Returns the events in the order of their ticks:
//   pop-through    the proxy's centre passes through the true surface to its back, see run_events.h
//   first contact  the first tick with a contact
//   slave contact  the first tick with a force of the scene on the slave
//   hardest hit    the first tick with the largest force of the scene on the slave
//   force jump     the largest change of the force from one tick to the next
//   largest force  the first tick with the largest force
//   not converged  the first tick of each spell in which a tick ended before the proxy or tool had converged,
//                  at most 50
//   task           a step of the task began or ended
// steps: what the steps of the task do, for the text; may be fewer than there are. held_depth_m: see
// renderer.h.
std::vector<TraceEvent> trace_events(const ColumnSource& trace, const std::vector<std::string>& steps = {},
                                     double held_depth_m = 0);

}  // namespace remote_touch
