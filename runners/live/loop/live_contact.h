// Watches the first contact of a live session, for a note on points that are too far apart.
#pragma once

#include <array>
#include <mutex>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/contact_watch.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

class LiveContact {
 public:
  // Watches nothing if the renderer is not a ball that single points hold (RenderedContact), or if the
  // experiment has fixtures, because their regions may be larger than the ball.
  explicit LiveContact(const Experiment& experiment);

  // The camera's thread calls it with each frame that is sent to the renderer.
  void add(const Frame& frame);
  // Another thread calls it with each tick, in order. A tick whose frame is no longer kept is skipped.
  void add(const LiveTick& tick, double time_s);
  // See ContactWatch::spacing_notes(). pre: no thread calls add() any more.
  std::vector<Note> notes(const Kernels& kernels) const;

 private:
  // The number is large enough, because a tick is read within about one period of the logger after it was
  // made, and few frames come meanwhile.
  static constexpr std::size_t kKeptFrames = 8;
  struct KeptFrame {
    int index = -1;
    ContactWatch::Points points;
  };

  const double ball_radius_m_;  // 0: watches nothing
  std::mutex mutex_;            // guards the frames
  std::array<KeptFrame, kKeptFrames> frames_;
  std::size_t next_ = 0;
  bool is_over_ = false;  // the first contact is known: frames are no longer kept
  ContactWatch watch_;
};

}  // namespace remote_touch
