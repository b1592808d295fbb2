// A task as a sequence of fixtures: regions that are locked and unlocked, guidance that is activated, step
// after step.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"

namespace remote_touch {

// lock: a forbidden region counts; activate: a guidance fixture pulls, and any other lets go.
enum class FixtureAction { lock, unlock, activate, release, wait };
enum class StepStart { previous, button };
enum class StepEnd { immediately, reached, button };

// A step begins when the one before has ended, no earlier than not_before_s, and then where it asks for it
// with the next press of a button. It does its action, and ends at once, when the tool has reached the
// fixture's goal, or with a press of the button; or it is missed after its deadline.
struct SequenceStep {
  FixtureAction action = FixtureAction::wait;
  std::string fixture;  // its label; none for wait, unless its goal is to be reached
  StepStart start = StepStart::previous;
  double not_before_s = 0;
  StepEnd done = StepEnd::immediately;
  int button = 0;
  double deadline_s = 0;  // after the beginning; 0: none
  Vec3 offset_m{0, 0, 0};
};

Parameters parameters(SequenceStep& s);
std::string validate(const SequenceStep& s);

class FixtureSequence {
 public:
  explicit FixtureSequence(std::vector<SequenceStep> steps) : steps_(std::move(steps)) {}

  // The buttons that are down in this tick, one bit each. Once a tick, before the others.
  void set_buttons(std::uint32_t buttons);
  // Whether the current step begins now.
  bool begins(double time_s);
  // Whether it ends now, done or missed; the next is then the current one. reached: the tool is at its goal.
  bool ends(double time_s, bool reached);

  // Its number; as many as there are steps after the last.
  int current() const { return current_; }
  bool is_over() const { return current_ == static_cast<int>(steps_.size()); }
  const SequenceStep& step() const { return steps_[static_cast<std::size_t>(current_)]; }  // pre: not over
  bool is_running() const { return running_; }  // the current step has begun
  int missed() const { return missed_; }        // steps so far
  const std::vector<SequenceStep>& steps() const { return steps_; }

 private:
  bool takes_press(int button);

  std::vector<SequenceStep> steps_;
  int current_ = 0, missed_ = 0;
  bool running_ = false;
  double began_s_ = 0;
  std::uint32_t down_ = 0, pressed_ = 0;  // pressed: went down in this tick, and no step has taken it
};

}  // namespace remote_touch
