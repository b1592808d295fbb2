// Events of a run: on which side of the true surface the proxy is, pop-through, and when something happens
// first.
#pragma once

#include <vector>

#include "analysis/measures/interval_estimates.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// The first tick of a run in which an event happens, and its time.

// Returns the first tick i for which happens(i) is true; NaN if there is none. happens() is called for each
// tick up to it.
template <class Happens>
double first_tick(const Trace& trace, Happens&& happens) {
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (happens(i)) return static_cast<double>(i);
  return kNoValue;
}

// Returns the time of a tick, s; NaN for NaN.
inline double time_of(const Trace& trace, double tick) {
  return tick >= 0 ? trace.time_s[static_cast<std::size_t>(tick)] : kNoValue;
}

// The side of the true surface on which a proxy is, tick after tick, and how it got there: the definition of
// pop-through.
//
// The proxy is behind the surface if its signed distance d is less than -held_depth_m, and else in front of
// it. The held depth (see held_depth_m() in renderer.h) is 0 for a ball, whose centre stays in front.
// A proxy that rests on the surface itself is slightly behind it as often as in front of it.
//
// A proxy pops through if it moves from the front to the back while d is known in every tick.
// A proxy that begins behind the surface has not passed through it. If d was unknown in between, the proxy
// may have gone round a border of the surface, through a hole in the measurement, or through the surface:
// then it is not known how it came to the back.

class SurfaceSide {
 public:
  explicit SurfaceSide(double held_depth_m) : held_depth_m_(held_depth_m) {}

  // Adds the next tick; NaN: the distance is unknown. Returns true if the proxy pops through in this tick.
  bool add(double signed_distance_m);
  // The result after the last tick: 1 if the proxy is behind the surface and popped through it, 0 if it is in
  // front or has been behind since the first tick. NaN if its distance is unknown, if it is unknown how it
  // got to the back, or if there were no ticks.
  double popped_through() const;

 private:
  enum class Side { unseen, front, back };

  double held_depth_m_;
  Side side_ = Side::unseen;     // side in the last tick with a known distance
  bool is_known_ = false;        // true if the distance in the last tick is known
  bool was_unknown_ = false;     // true: it was unknown since the proxy was last in front, or since the start
  double result_if_behind_ = 0;  // 1, 0 or NaN as above
};

// The outcome of a run: popped_through() after its last tick, and the first tick in which the proxy pops
// through (NaN: none). Ticks before the first frame do not count, because no renderer can hold a surface that
// it has not received: the proxy begins where it is when the first frame comes.
struct SideOfRun {
  double popped_through = 0, first_pop_through_tick = 0;
};
// distance_m: distance of the proxy from a surface in each tick of the trace.
SideOfRun side_of_run(const Trace& trace, const std::vector<double>& distance_m);

// The distances by which a run is judged: from the true surface or, in a run that has one beside it, from the
// surface that the camera measured. What lies between the two is the error of the camera, which no renderer
// can know.
const std::vector<double>& judged_distance_m(const Trace& trace);

// Time, s, and tick of events in a run; NaN if the event did not happen.

// The first tick in which the proxy or tool touches a point or a region (contact_count).
double first_contact_tick(const Trace& trace);
double first_contact_time_s(const Trace& trace);
// The first tick in which the proxy's centre (with a tool its centre of mass) passes to the back of the
// surface by which the run is judged, see SurfaceSide. It may come back later; popped_through() considers
// only the last tick.
double first_pop_through_tick(const Trace& trace);
double first_pop_through_time_s(const Trace& trace);
// The time of max_force_jump_tick(), see force_measures.h.
double max_force_jump_time_s(const Trace& trace);

}  // namespace remote_touch
