// Times at which the frames of a recording are shown, and their rate.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/recordings/recording.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

// The frames of a part of a recording in the order in which they are played. Frame 0 is shown at 0 s. Without
// a chosen rate the time between two successive frames is that of the recording, also when the part is played
// again: from the last frame of a loop to the first it takes one mean period, and ping-pong plays the stamps
// backwards.
class FrameTimes {
 public:
  enum class Playback { hold, loop, ping_pong };

  // chosen_hz: 0, as recorded, or the rate at which all frames are played, whatever their stamps. Throws
  // InputError about the part if it has stamps of more than kMaxFrameRate_hz.
  FrameTimes(const RecordingIndex& recording, const RecordingPart& part, Playback playback, double chosen_hz);

  // The rate at which the frames are played; the mean rate of the part where that is uneven.
  double rate_hz() const { return rate_hz_; }
  // Number of frames in the part.
  int count() const { return count_; }
  // The number, in the recording, of the part's first frame.
  int first() const { return first_; }
  // The number, in the recording, of a frame of the playback. Ping-pong turns round at both ends without
  // repeating them: 0 1 2 3 2 1 0 1 ...
  std::size_t source(int frame) const;
  double captured_s(int frame) const;

  // "30 Hz", "30 Hz with pauses of up to 1 s (5.83 Hz on average)", "30 Hz (recorded at 0.987 Hz)".
  std::string text() const;
  // True if the stamps of the frames say when these are shown.
  bool follows_stamps() const { return is_stamped_ && chosen_hz_ == 0 && count_ > 1; }
  // The rate without the pauses: one frame in the median of the times between successive frames.
  // Pre: follows_stamps().
  double usual_rate_hz() const;

 private:
  int place(int frame) const;  // index in the part

  Playback playback_;
  bool is_stamped_;
  double chosen_hz_, recorded_hz_, rate_hz_;
  int first_ = 0, count_ = 0;
  std::vector<double> since_first_s_;  // one for each frame of the part
};

}  // namespace remote_touch
