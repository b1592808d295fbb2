#include "core/guidance/fixture_sequence.h"

namespace remote_touch {

namespace {
constexpr double kRounding_s = 1e-9;  // of differences of times
}

Parameters parameters(SequenceStep& s) {
  return {
      {"action", choice(s.action, {"lock", "unlock", "activate", "release", "wait"}), 0, 0,
       "lock: a forbidden region counts; unlock: it does not; activate: a guidance fixture pulls, and any other "
       "lets go; release: it lets go"},
      {"fixture", &s.fixture, 0, 0, "label of the fixture"},
      {"start", choice(s.start, {"previous", "button"}), 0, 0,
       "when the step before has ended, or after that when a button is pressed"},
      {"not_before_s", &s.not_before_s, 0, 86400, "but not before this time"},
      {"done", choice(s.done, {"immediately", "reached", "button"}), 0, 0,
       "the step ends at once, when the tool is within the fixture's radius_m of its goal, or with a press"},
      {"button", &s.button, 0, 31, "of the device"},
      {"deadline_s", &s.deadline_s, 0, 86400,
       "a step that is not done so long after its beginning is missed, and the next one comes; 0: none"},
      {"offset_m", &s.offset_m, -1, 1, "activate: added to the goal's place, base frame"},
  };
}

std::string validate(const SequenceStep& s) {
  const bool needs_fixture = s.action != FixtureAction::wait || s.done == StepEnd::reached;
  if (needs_fixture && s.fixture.empty()) return "fixture = \"\": allowed the label of a fixture";
  if (!needs_fixture && !s.fixture.empty())
    return "fixture = \"" + s.fixture + "\": allowed none for wait, unless done = reached";
  if (s.action != FixtureAction::activate && !s.offset_m.isZero(0))
    return "offset_m: allowed other than 0 for action = activate only";
  if (s.done == StepEnd::immediately && s.deadline_s > 0)
    return "deadline_s = " + std::to_string(s.deadline_s) + ": allowed 0 for done = immediately";
  const bool guided = s.action == FixtureAction::activate || s.action == FixtureAction::wait;
  if (s.done == StepEnd::reached && !guided) return "done = reached: allowed for activate and wait";
  return {};
}

void FixtureSequence::set_buttons(std::uint32_t buttons) {
  pressed_ = buttons & ~down_;
  down_ = buttons;
}

// One press is taken by one step.
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
  const bool done = s.done == StepEnd::immediately || (s.done == StepEnd::reached && reached) ||
                    (s.done == StepEnd::button && takes_press(s.button));
  const bool missed = !done && s.deadline_s > 0 && time_s - began_s_ >= s.deadline_s - kRounding_s;
  if (!done && !missed) return false;
  missed_ += missed ? 1 : 0;
  running_ = false;
  ++current_;
  return true;
}

}  // namespace remote_touch
