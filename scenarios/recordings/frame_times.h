// Times at which the frames of a recording are shown, and their rate.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/recordings/recording.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

// The frames of a part of a recording in the order in which they are played. Frame 0 is shown at 0 s. Without
// a chosen rate, successive frames are as far apart in time as in the recording, also if the part is played
// again. A loop adds one mean period from the last frame to the first. Ping-pong plays the stamps forwards
// and backwards in turn.
class FrameTimes {
 public:
  enum class Playback { hold, loop, ping_pong };

  // chosen_hz: the rate at which all frames are played, regardless of their stamps; 0: as recorded. Throws
  // InputError about the part if the resulting mean rate is above kMaxFrameRate_hz.
  FrameTimes(const RecordingIndex& recording, const RecordingPart& part, Playback playback, double chosen_hz);

  // The rate at which the frames are played. If the period varies, it is the mean rate of the part.
  double rate_hz() const { return rate_hz_; }
  // Number of frames in the part.
  int count() const { return count_; }
  // Number of the part's first frame within the recording.
  int first() const { return first_; }
  // Returns the number, within the recording, of a frame of the playback. Ping-pong turns round at both ends
  // without repeating the frame there: 0 1 2 3 2 1 0 1 ...
  std::size_t source(int frame) const;
  double captured_s(int frame) const;

  // "30 Hz", "30 Hz with pauses of up to 1 s (5.83 Hz on average)", "30 Hz (recorded at 0.987 Hz)".
  std::string text() const;
  // Returns true if the frames are shown at the times of their stamps.
  bool follows_stamps() const { return is_stamped_ && chosen_hz_ == 0 && count_ > 1; }
  // Returns the rate without the pauses: the inverse of the median time between successive frames. Pre:
  // follows_stamps().
  double usual_rate_hz() const;

 private:
  int index_in_part(int frame) const;

  Playback playback_;
  bool is_stamped_;
  double chosen_hz_, recorded_hz_, rate_hz_;
  int first_ = 0, count_ = 0;
  std::vector<double> since_first_s_;  // one for each frame of the part
};

}  // namespace remote_touch
