// Tasks, played tick by tick: which step is the current one, when it begins, and when it ends.
#include "core/dissertation/guidance/fixture_sequence.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace remote_touch::fixture_sequence_test {
namespace {

SequenceStep step(StepStart start, StepEnd end, int button = 0) {
  SequenceStep s;
  s.start = start, s.end = end, s.button = button;
  return s;
}

SequenceStep with_deadline(SequenceStep s, double deadline_s) {
  s.deadline_s = deadline_s;
  return s;
}

SequenceStep not_before(SequenceStep s, double time_s) {
  s.not_before_s = time_s;
  return s;
}

const SequenceStep kAtOnce = step(StepStart::previous, StepEnd::immediately);
const SequenceStep kReach = step(StepStart::previous, StepEnd::reached);

// Input of one tick, and the state expected after it.
struct Tick {
  double time_s;
  std::uint32_t buttons;  // one bit per button
  bool reached;
  int current;
  bool running;
  int missed;
  std::vector<int> begun = {};  // the steps that begin in this tick
};

void play(std::vector<SequenceStep> steps, const std::vector<Tick>& ticks) {
  FixtureSequence sequence(std::move(steps));
  for (const Tick& tick : ticks) {
    SCOPED_TRACE("at " + std::to_string(tick.time_s) + " s");
    std::vector<int> begun;
    sequence.set_buttons(tick.buttons);
    while (true) {
      if (sequence.begins(tick.time_s)) begun.push_back(sequence.current());
      if (!sequence.ends(tick.time_s, tick.reached)) break;
    }
    EXPECT_EQ(sequence.current(), tick.current);
    EXPECT_EQ(sequence.is_running(), tick.running);
    EXPECT_EQ(sequence.missed(), tick.missed);
    EXPECT_EQ(begun, tick.begun);
  }
}

TEST(FixtureSequence, IsOverIfItHasNoSteps) {
  FixtureSequence sequence({});
  EXPECT_TRUE(sequence.is_over());
  play({}, {{0, 1, true, 0, false, 0}});
}

TEST(FixtureSequence, StepsThatEndAtOnceAllRunInOneTick) {
  play({kAtOnce, kAtOnce, kAtOnce}, {{0, 0, false, 3, false, 0, {0, 1, 2}}, {0.001, 0, false, 3, false, 0}});
  play(
      {kAtOnce, kReach, kAtOnce},
      {{0, 0, false, 1, true, 0, {0, 1}}, {0.001, 0, false, 1, true, 0}, {0.002, 0, true, 3, false, 0, {2}}});
}

TEST(FixtureSequence, AStepCanBeDoneInTheTickThatItBeginsIn) {
  play({kReach, kReach}, {{0, 0, true, 2, false, 0, {0, 1}}});
}

TEST(FixtureSequence, BeginsWithAPressOfItsButtonAlone) {
  play({step(StepStart::button, StepEnd::immediately, 3)}, {{0, 0, false, 0, false, 0},
                                                            {0.001, 0b0111, false, 0, false, 0},
                                                            {0.002, 0b1111, false, 1, false, 0, {0}}});
  play({step(StepStart::button, StepEnd::immediately, 31)},
       {{0, 0, false, 0, false, 0}, {0.001, 0x80000000, false, 1, false, 0, {0}}});
}

TEST(FixtureSequence, OnePressIsTakenByOneStep) {
  const SequenceStep press = step(StepStart::button, StepEnd::immediately);
  play({press, press, press}, {{0, 1, false, 1, false, 0, {0}},
                               {0.001, 1, false, 1, false, 0},  // still down
                               {0.002, 0, false, 1, false, 0},
                               {0.003, 1, false, 2, false, 0, {1}},
                               {0.004, 0, false, 2, false, 0},
                               {0.005, 1, false, 3, false, 0, {2}}});
}

TEST(FixtureSequence, OnePressDoesNotBeginAndEndAStep) {
  play({step(StepStart::button, StepEnd::button)}, {{0, 1, false, 0, true, 0, {0}},
                                                    {0.001, 1, false, 0, true, 0},
                                                    {0.002, 0, false, 0, true, 0},
                                                    {0.003, 1, false, 1, false, 0}});
}

TEST(FixtureSequence, TwoButtonsThatGoDownTogetherAreTwoPresses) {
  play({step(StepStart::button, StepEnd::immediately, 0), step(StepStart::button, StepEnd::immediately, 5)},
       {{0, 0b100001, false, 2, false, 0, {0, 1}}});
}

TEST(FixtureSequence, APressBeforeItsStepIsUpDoesNotCount) {
  play({kReach, step(StepStart::button, StepEnd::immediately)}, {{0, 0, false, 0, true, 0, {0}},
                                                                 {0.001, 1, false, 0, true, 0},
                                                                 {0.002, 1, true, 1, false, 0},  // only held
                                                                 {0.003, 0, false, 1, false, 0},
                                                                 {0.004, 1, false, 2, false, 0, {1}}});
  // A press counts if it comes in the tick that ends the previous step.
  play({kReach, step(StepStart::button, StepEnd::immediately)},
       {{0, 0, false, 0, true, 0, {0}}, {0.001, 1, true, 2, false, 0, {1}}});
}

TEST(FixtureSequence, APressBeforeTheTimeOfItsStepDoesNotCount) {
  play({not_before(step(StepStart::button, StepEnd::immediately), 0.002)},
       {{0, 0, false, 0, false, 0},
        {0.001, 1, false, 0, false, 0},
        {0.002, 1, false, 0, false, 0},
        {0.003, 0, false, 0, false, 0},
        {0.004, 1, false, 1, false, 0, {0}}});
}

TEST(FixtureSequence, BeginsAtItsTimeAndNotBefore) {
  play({not_before(kAtOnce, 0.7)}, {{0, 0, false, 0, false, 0},
                                    {0.699, 0, true, 0, false, 0},
                                    {700 / 1000.0, 0, false, 1, false, 0, {0}}});
  // A start time that has already passed does not delay a step.
  play({not_before(kReach, 0.002), not_before(kAtOnce, 0.001)},
       {{0, 0, true, 0, false, 0}, {0.002, 0, true, 2, false, 0, {0, 1}}});
}

TEST(FixtureSequence, ADeadlineCountsFromTheBeginningOfItsStep) {
  const SequenceStep s = with_deadline(step(StepStart::button, StepEnd::reached), 0.3);
  play({s, kAtOnce}, {{0, 0, false, 0, false, 0},
                      {0.9, 1, false, 0, true, 0, {0}},
                      {1.199, 0, false, 0, true, 0},
                      {1.2, 0, false, 2, false, 1, {1}}});  // 1.2 - 0.9 is less than 0.3 in doubles
}

TEST(FixtureSequence, EveryTickThatIsADeadlineMissesExactlyThen) {
  for (int begun = 0; begun < 2000; begun += 7) {
    FixtureSequence sequence({not_before(with_deadline(kReach, 0.1), begun / 1000.0)});
    int tick = 0;
    while (!sequence.is_over()) {
      sequence.set_buttons(0), sequence.begins(tick / 1000.0), sequence.ends(tick / 1000.0, false);
      ASSERT_LE(++tick, begun + 101);
    }
    EXPECT_EQ(tick - 1, begun + 100);
  }
}

TEST(FixtureSequence, ReachedAtTheDeadlineIsDone) {
  play({with_deadline(kReach, 0.5)}, {{0, 0, false, 0, true, 0, {0}}, {0.5, 0, true, 1, false, 0}});
  play({with_deadline(kReach, 0.5)}, {{0, 0, false, 0, true, 0, {0}}, {0.5, 0, false, 1, false, 1}});
  play({with_deadline(step(StepStart::previous, StepEnd::button), 0.5)},
       {{0, 0, false, 0, true, 0, {0}}, {0.5, 1, false, 1, false, 0}});
}

TEST(FixtureSequence, AMissedDeadlineBeginsTheNextStepWithItsOwnDeadline) {
  const SequenceStep s = with_deadline(kReach, 0.5);
  play({s, s, s}, {{0, 0, false, 0, true, 0, {0}},
                   {0.5, 0, false, 1, true, 1, {1}},
                   {0.999, 0, false, 1, true, 1},
                   {1.0, 0, false, 2, true, 2, {2}},
                   {1.25, 0, true, 3, false, 2}});
}

TEST(FixtureSequence, WaitsForEverIfThereIsNoDeadline) {
  play({kReach}, {{0, 0, false, 0, true, 0, {0}}, {86400, 0, false, 0, true, 0}});
}

TEST(FixtureSequence, AStepThatHasNotBegunIsNotMissed) {
  play({with_deadline(step(StepStart::button, StepEnd::reached), 0.5)},
       {{0, 0, false, 0, false, 0}, {10, 0, true, 0, false, 0}});
}

// --- what a step may state ---

TEST(FixtureSequence, AStepNamesAFixtureWhereItNeedsOne) {
  SequenceStep s;
  EXPECT_EQ(validate(s), "");
  s.fixture = "valve";
  EXPECT_EQ(validate(s), "fixture = \"valve\": expected none for wait, unless done = reached");
  s.end = StepEnd::reached;
  EXPECT_EQ(validate(s), "");
  s.fixture = "";
  EXPECT_EQ(validate(s), "fixture = \"\": expected the label of a fixture");
  s.action = FixtureAction::lock, s.fixture = "valve";
  EXPECT_EQ(validate(s), "done = reached: expected only with action = activate or wait");
  s.action = FixtureAction::activate;
  EXPECT_EQ(validate(s), "");
}

}  // namespace
}  // namespace remote_touch::fixture_sequence_test
