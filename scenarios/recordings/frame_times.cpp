#include "scenarios/recordings/frame_times.h"

#include <algorithm>
#include <cstdio>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {

namespace {

// A time between two frames that is longer than 1.5 periods is nearer to two periods than to one: a frame is
// missing.
constexpr double kPausePeriods = 1.5;

std::vector<double> periods_s(const std::vector<double>& times_s) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < times_s.size(); ++i) periods.push_back(times_s[i] - times_s[i - 1]);
  return periods;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

FrameTimes::FrameTimes(const RecordingIndex& recording, const RecordingPart& part, Playback playback,
                       double chosen_hz)
    : playback_(playback),
      is_stamped_(recording.is_stamped),
      chosen_hz_(chosen_hz),
      recorded_hz_(recording.frame_rate_hz) {
  const FrameRange frames = frames_of(part, recording);
  first_ = frames.first, count_ = frames.last - frames.first + 1;
  const double first_s = recording.frames[static_cast<std::size_t>(first_)].captured_s;
  for (int i = first_; i <= frames.last; ++i)
    since_first_s_.push_back(recording.frames[static_cast<std::size_t>(i)].captured_s - first_s);
  if (is_stamped_ && count_ > 1) recorded_hz_ = (count_ - 1) / since_first_s_.back();
  rate_hz_ = chosen_hz > 0 ? chosen_hz : recorded_hz_;
  if (!(rate_hz_ <= kMaxFrameRate_hz))
    refuse(part.path, "frames ", first_, " to ", frames.last, " have timestamps of more than ",
           number(kMaxFrameRate_hz), " frames a second: expected seconds");
}

int FrameTimes::index_in_part(int frame) const {
  switch (playback_) {
    case Playback::hold:
      return std::min(frame, count_ - 1);
    case Playback::loop:
      return frame % count_;
    case Playback::ping_pong:
      break;
  }
  const int cycle = std::max(1, 2 * count_ - 2), index = frame % cycle;
  return index >= count_ ? cycle - index : index;
}

std::size_t FrameTimes::source(int frame) const {
  return static_cast<std::size_t>(first_ + index_in_part(frame));
}

double FrameTimes::captured_s(int frame) const {
  if (chosen_hz_ > 0) return frame / rate_hz_;
  const double since_first_s = since_first_s_[static_cast<std::size_t>(index_in_part(frame))];
  if (playback_ == Playback::hold) return since_first_s;
  if (!follows_stamps()) return frame / rate_hz_;  // a steady rate, without the rounding of sums
  const double length_s = since_first_s_.back();
  const int rounds = frame / count_;
  if (playback_ == Playback::loop) return rounds * (length_s + 1 / rate_hz_) + since_first_s;
  const int turns = frame / (count_ - 1);
  return turns * length_s + (turns % 2 == 0 ? since_first_s : length_s - since_first_s);
}

double FrameTimes::usual_rate_hz() const {
  std::vector<double> periods = periods_s(since_first_s_);
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return 1 / *middle;
}

std::string FrameTimes::text() const {
  if (chosen_hz_ > 0) {
    const std::string recorded = number(recorded_hz_), played = number(chosen_hz_);
    return played + " Hz" + (played == recorded ? "" : " (recorded at " + recorded + " Hz)");
  }
  if (!follows_stamps()) return number(rate_hz_) + " Hz";
  const std::vector<double> periods = periods_s(since_first_s_);
  const double longest_s = *std::max_element(periods.begin(), periods.end()), usual_hz = usual_rate_hz();
  if (longest_s * usual_hz <= kPausePeriods) return number(rate_hz_) + " Hz";
  return number(usual_hz) + " Hz with pauses of up to " + number(longest_s) + " s (" + number(rate_hz_) +
         " Hz on average)";
}

}  // namespace remote_touch
