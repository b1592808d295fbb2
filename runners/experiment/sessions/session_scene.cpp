#include "runners/experiment/sessions/session_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/frame_statistics.h"

namespace remote_touch {

Parameters parameters(SessionSettings& s) {
  return {{"path", &s.path, 0, 0, "file of remote-touch live --record"}};
}

std::string validate(const SessionSettings& s) {
  return s.path.empty() ? "path = \"\": expected a file of remote-touch live --record" : "";
}

InputPart input_files(const SessionSettings& s) {
  return {s.path};
}

SessionScene::SessionScene(const Settings& settings, const NoiseKey&, const Kernels&)
    : path_(settings.path),
      session_(find_input(settings.path)),
      arrives_s_(session_.frame_count(), std::numeric_limits<double>::infinity()),
      is_read_(session_.frame_count(), false) {
  for (std::size_t i = 0; i < session_.tick_count(); ++i)
    if (session_.taken(i) >= 0)
      arrives_s_[static_cast<std::size_t>(session_.taken(i))] =
          static_cast<double>(session_.tick_number(i)) / session_.haptic_rate_hz();
  if (arrives_s_.empty()) throw InputError(settings.path, "has no frames: expected a session with some");
}

SensorFrame SessionScene::read(std::size_t frame) const {
  SensorFrame sensed = session_.frame(frame);
  if (!is_read_[frame]) sensed_.add(sensed, session_.view());
  is_read_[frame] = true;
  return sensed;
}

PointCloud SessionScene::cloud(int frame) const {
  return cloud_of(read(static_cast<std::size_t>(frame)), session_.view(), session_.view().X_WC);
}

std::string SessionScene::input() const {
  return path_ + ": " + std::to_string(session_.frame_count()) + " frame(s) of a live session, " +
         layout_text(session_.view()) + "; " + std::to_string(sensed_.frames()) + " read: " + sensed_.text();
}

std::vector<Note> SessionScene::input_notes() const {
  std::vector<bool> is_used;
  for (std::size_t frame = 0; frame < arrives_s_.size(); ++frame)
    if (std::isfinite(arrives_s_[frame])) is_used.push_back(is_read_[frame]);
  std::vector<Note> notes = unused_frames(is_used);
  for (Note& note : notes) note.text = path_ + ": " + note.text;
  if (session_.ended() == kInterruptedRecording)
    notes.push_back({"recording incomplete", path_ + ": the recording was interrupted"});
  return notes;
}

double SessionScene::signed_distance(const Vec3&, double) const {
  return std::numeric_limits<double>::quiet_NaN();
}

SessionHand::SessionHand(const Settings& settings, const Scenario&) : session_(find_input(settings.path)) {
  if (session_.tick_count() == 0)
    throw InputError(settings.path, "has no ticks: expected a session with some");
}

// Returns the last tick that is not later than the time; the first tick if all are later.
std::size_t SessionHand::tick_at(double time_s) const {
  const auto number =
      static_cast<std::uint64_t>(std::max(0.0, std::floor(time_s * session_.haptic_rate_hz() + 0.5)));
  std::size_t first = 0, last = session_.tick_count();
  while (last - first > 1) {
    const std::size_t middle = first + (last - first) / 2;
    (session_.tick_number(middle) <= number ? first : last) = middle;
  }
  return first;
}

DeviceState SessionHand::at(double time_s) const {
  return session_.device(tick_at(time_s));
}

bool SessionHand::is_missed(double time_s) const {
  const double number = std::floor(time_s * session_.haptic_rate_hz() + 0.5);
  return static_cast<double>(session_.tick_number(tick_at(time_s))) != number;
}

double SessionHand::duration_s() const {
  return static_cast<double>(session_.tick_number(session_.tick_count() - 1) + 1) / session_.haptic_rate_hz();
}

namespace {

// Adds the recorded changes of the renderer's parameters. Changes of the scenario are in the recorded frames.
void add_changes(const SessionReader& session, Json& experiment) {
  Json changes = experiment.contains("changes") ? experiment["changes"] : Json::array();
  if (!changes.is_array()) return;  // the reader of the experiment reports this error
  for (const SessionChange& change : session.changes())
    if (const std::string& parameter = session.live_parameter(change); parameter.starts_with("renderer."))
      changes.push_back({{"time_s", static_cast<double>(change.tick) / session.haptic_rate_hz()},
                         {"parameter", parameter},
                         {"value", change.value}});
  const auto time_s = [](const Json& change) {
    return change.is_object() && change.contains("time_s") && change["time_s"].is_number()
               ? change["time_s"].get<double>()
               : 0;
  };
  std::stable_sort(changes.begin(), changes.end(),
                   [&](const Json& a, const Json& b) { return time_s(a) < time_s(b); });
  if (!changes.empty()) experiment["changes"] = std::move(changes);
}

}  // namespace

std::string session_experiment(const SessionReader& session, const std::string& path) {
  Json json = parse_json(session.config(), path + " config");
  if (!json.is_object())
    throw InputError(path, "damaged (its configuration): expected a file of remote-touch live --record");
  for (const char* part : {"scenario", "trajectory"}) json[part] = {{"name", "live-session"}, {"path", path}};
  // The hand is the recorded one. The frames that come are those that came to the renderer, at the recorded
  // times.
  for (const char* section : {"faults", "operator", "device", "live", "safety", "frame_link"})
    json.erase(section);
  for (const char* setting : {"duration_s", "frame_latency_s", "frame_jitter_s", "frame_drop_probability"})
    json[setting] = 0;
  add_changes(session, json);
  return json.dump();
}

std::string session_experiment(const std::string& path) {
  return session_experiment(SessionReader(find_input(path)), path);
}

}  // namespace remote_touch
