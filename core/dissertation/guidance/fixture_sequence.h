// A task as a sequence of steps, the sequential tasks of 8.2. A step locks or unlocks a forbidden region, or
// activates or releases a guidance fixture.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"

namespace remote_touch {

// lock enables a forbidden region, and unlock disables it. activate starts a guidance fixture and stops all
// others. release stops a guidance fixture. wait does nothing.
enum class FixtureAction { lock, unlock, activate, release, wait };
enum class StepStart { previous, button };
enum class StepEnd { immediately, reached, button };

// A step begins when the previous one has ended and not_before_s has passed. If its start is
// StepStart::button, it then also waits for a press of the button. It performs its action when it begins. It
// ends immediately, when the tool has reached the fixture's goal, or when the button is pressed. A step that
// is not done at its deadline ends and counts as missed.
struct SequenceStep {
  FixtureAction action = FixtureAction::wait;
  std::string fixture;  // label of the fixture; wait has one only with StepEnd::reached
  StepStart start = StepStart::previous;
  double not_before_s = 0;
  StepEnd end = StepEnd::immediately;
  int button = 0;
  double deadline_s = 0;  // time limit from the beginning of the step; 0: none
  Vec3 offset_m{0, 0, 0};
};

Parameters parameters(SequenceStep& s);
std::string validate(const SequenceStep& s);
// Returns the action and the fixture as text for people, such as "activate right".
std::string name_of(const SequenceStep& s);

class FixtureSequence {
 public:
  explicit FixtureSequence(std::vector<SequenceStep> steps) : steps_(std::move(steps)) {}

  // Sets the buttons that are down in this tick, one bit each. Call it once a tick, before begins() and
  // ends().
  void set_buttons(std::uint32_t buttons);
  // Begins the current step if its conditions hold. Returns true if it begins now.
  bool begins(double time_s);
  // Ends the current step if it is done or missed. Returns true if it ends now; the next step is then the
  // current one. reached: the tool is at the step's goal.
  bool ends(double time_s, bool reached);

  // Number of the current step, from 0; the number of steps once the last has ended.
  int current() const { return current_; }
  bool is_over() const { return current_ == static_cast<int>(steps_.size()); }
  const SequenceStep& step() const { return steps_[static_cast<std::size_t>(current_)]; }  // pre: not over
  bool is_running() const { return running_; }  // the current step has begun
  int missed() const { return missed_; }        // number of missed steps so far
  const std::vector<SequenceStep>& steps() const { return steps_; }

 private:
  bool takes_press(int button);

  std::vector<SequenceStep> steps_;
  int current_ = 0, missed_ = 0;
  bool running_ = false;
  double began_s_ = 0;
  std::uint32_t down_ = 0, pressed_ = 0;  // pressed_: went down in this tick, not yet used by a step
};

}  // namespace remote_touch
