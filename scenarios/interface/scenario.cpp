#include "scenarios/interface/scenario.h"

#include <algorithm>

namespace remote_touch {

int Scenario::newest_frame(double time_s) const {
  const int last = frame_count() - 1;
  const double guess = std::max(0.0, time_s) * frame_rate_hz();  // exact for a steady stream
  int frame = static_cast<int>(std::min(guess, static_cast<double>(last)));
  while (frame > 0 && captured_s(frame) > time_s + kSameTime_s) --frame;
  while (frame < last && captured_s(frame + 1) <= time_s + kSameTime_s) ++frame;
  return frame;
}

}  // namespace remote_touch
