#include "core/dissertation/guidance/fixture_sequence.h"

namespace remote_touch {

namespace {
constexpr double kRounding_s = 1e-9;  // rounding error of a time difference
}

Parameters parameters(SequenceStep& s) {
  return {
      {"action", choice(s.action, {"lock", "unlock", "activate", "release", "wait"}), 0, 0,
       "lock: enable a forbidden region; unlock: disable it; activate: start a guidance fixture and stop any other; release: stop it; wait: do nothing"},
      {"fixture", &s.fixture, 0, 0, "label of the fixture on which the step acts"},
      {"start", choice(s.start, {"previous", "button"}), 0, 0,
       "previous: start when the previous step has ended; button: then wait for the button"},
      {"not_before_s", &s.not_before_s, 0, 86400, "earliest start time"},
      {"done", choice(s.end, {"immediately", "reached", "button"}), 0, 0,
       "when the step ends: immediately, when the tool has reached the goal, or when the button is pressed"},
      {"button", &s.button, 0, 31, "number of the button"},
      {"deadline_s", &s.deadline_s, 0, 86400,
       "maximum duration; a longer step counts as missed and the next one starts; 0: no limit"},
      {"offset_m", &s.offset_m, -1, 1, "for activate: offset added to the goal, base frame"},
  };
}

std::string name_of(const SequenceStep& s) {
  SequenceStep step = s;
  const auto action = std::get<Choice>(parameters(step).front().value);
  return action.names[static_cast<std::size_t>(action.get())] + (s.fixture.empty() ? "" : " ") + s.fixture;
}

std::string validate(const SequenceStep& s) {
  const bool needs_fixture = s.action != FixtureAction::wait || s.end == StepEnd::reached;
  if (needs_fixture && s.fixture.empty()) return "fixture = \"\": expected the label of a fixture";
  if (!needs_fixture && !s.fixture.empty())
    return "fixture = \"" + s.fixture + "\": expected none for wait, unless done = reached";
  if (s.action != FixtureAction::activate && !s.offset_m.isZero(0))
    return "offset_m: expected 0 unless action = activate";
  if (s.end == StepEnd::immediately && s.deadline_s > 0)
    return "deadline_s = " + std::to_string(s.deadline_s) + ": expected 0 for done = immediately";
  const bool guided = s.action == FixtureAction::activate || s.action == FixtureAction::wait;
  if (s.end == StepEnd::reached && !guided)
    return "done = reached: expected only with action = activate or wait";
  return {};
}

void FixtureSequence::set_buttons(std::uint32_t buttons) {
  pressed_ = buttons & ~down_;
  down_ = buttons;
}

// Returns true if the button was pressed in this tick and no step has used that press yet. The press counts
// as used then.
bool FixtureSequence::takes_press(int button) {
  const std::uint32_t bit = std::uint32_t{1} << button;
  const bool pressed = (pressed_ & bit) != 0;
  pressed_ &= ~bit;
  return pressed;
}

bool FixtureSequence::begins(double time_s) {
  if (is_over() || running_ || time_s < step().not_before_s) return false;
  if (step().start == StepStart::button && !takes_press(step().button)) return false;
  running_ = true, began_s_ = time_s;
  return true;
}

bool FixtureSequence::ends(double time_s, bool reached) {
  if (!running_) return false;
  const SequenceStep& s = step();
  const bool done = s.end == StepEnd::immediately || (s.end == StepEnd::reached && reached) ||
                    (s.end == StepEnd::button && takes_press(s.button));
  const bool missed = !done && s.deadline_s > 0 && time_s - began_s_ >= s.deadline_s - kRounding_s;
  if (!done && !missed) return false;
  missed_ += missed ? 1 : 0;
  running_ = false;
  ++current_;
  return true;
}

}  // namespace remote_touch
