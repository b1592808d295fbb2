#include "runners/presentation/pages/trace_event.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace remote_touch::trace_event_test {
namespace {

Column column(const char* name, Values values, int width = 1) {
  return {name, "1", "", std::move(values), width, {}};
}

std::vector<std::string> found(std::vector<Column> columns) {
  std::vector<std::string> list;
  for (const TraceEvent& event : trace_events(ColumnsInMemory(std::move(columns))))
    list.push_back(std::to_string(event.tick) + " " + event.kind);
  return list;
}

using Doubles = std::vector<double>;
using Integers = std::vector<std::int32_t>;
using Texts = std::vector<std::string>;

TEST(TraceEvents, APopThroughIsWhereTheProxyGetsBelowTheTrueSurface) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(found({column("signed_distance", Doubles{0.1, 0, -0.1, -0.2, 0.1, -0.1, unknown, -0.1})}),
            (Texts{"2 pop-through", "5 pop-through"}));
}

TEST(TraceEvents, AProxyThatRestsOnTheSurfaceDoesNotPopThroughIt) {
  const ColumnsInMemory resting(
      std::vector<Column>{column("signed_distance", Doubles{0.01, -1e-9, 1e-9, -1e-4, -0.003})});
  EXPECT_EQ(trace_events(resting).size(), 2u);
  ASSERT_EQ(trace_events(resting, {}, 0.0025).size(), 1u);
  EXPECT_EQ(trace_events(resting, {}, 0.0025)[0].tick, 4u);
}

TEST(TraceEvents, HaveTheLargestForceAndTheLargestJump) {
  EXPECT_EQ(found({column("force", Doubles{0, 0, 0, 0, 1, 0, 0, 1, 0, 3, 4, 0, 3, 4, 1}, 3)}),
            (Texts{"3 force jump", "4 largest force"}));
  EXPECT_EQ(found({column("force", Doubles{0, 1, 0, 0, 1, 0}, 3)}), Texts{"0 largest force"})
      << "it never changes";
  EXPECT_EQ(found({column("force", Doubles{0, 0, 0, 0, 0, 0}, 3)}), Texts{});
}

TEST(TraceEvents, HaveTheFirstAndTheHardestContactOfASlave) {
  EXPECT_EQ(found({column("slave_peak_force", Doubles{NAN, 0, 2, 7, 7, 3})}),
            (Texts{"2 slave contact", "3 hardest hit"}));
  EXPECT_EQ(found({column("slave_peak_force", Doubles{NAN, 0, 0})}), Texts{});
  const auto events = trace_events(ColumnsInMemory(
      {column("slave_peak_force", Doubles{0, 12.34}), column("force", Doubles{0, 2, 0, 0, 2, 0}, 3)}));
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].text, "The largest force of the renderer, 2 N.");
  EXPECT_EQ(events[2].text, "The largest force of the scene on the slave, 12.3 N.");
}

TEST(TraceEvents, HaveTheFirstContact) {
  EXPECT_EQ(found({column("contact_count", Integers{0, 0, 2, 0, 1})}), Texts{"2 first contact"});
  EXPECT_EQ(found({column("contact_count", Integers{0, 0})}), Texts{});
}

TEST(TraceEvents, HaveTheTicksThatDidNotConverge) {
  EXPECT_EQ(found({column("converged", Integers{1, 0, 0, 1, 0})}),
            (Texts{"1 not converged", "4 not converged"}));
  EXPECT_EQ(found({column("converged", Integers{0, 0, 1, 0})}), (Texts{"0 not converged", "3 not converged"}))
      << "a spell that begins the run";
  EXPECT_EQ(found({column("converged", Integers{0, 0, 0}), column("budget_exhausted", Integers{0, 0, 1})}),
            (Texts{"2 not converged"}))
      << "a tool says it in another column";
  Integers often;
  for (int i = 0; i < 400; ++i) often.push_back(i % 2);
  EXPECT_EQ(found({column("converged", often)}).size(), 50u);
}

TEST(TraceEvents, StepsOfATaskHaveTheirResult) {
  const auto events =
      trace_events(ColumnsInMemory({column("sequence_step", Integers{0, 0, 1, 1, 2}),
                                    column("sequence_running", Integers{0, 1, 1, 1, 0}),
                                    column("sequence_missed", Integers{0, 0, 0, 0, 1}),
                                    column("sequence_distance", Doubles{NAN, NAN, NAN, NAN, 0.0005}),
                                    column("sequence_angle", Doubles{NAN, NAN, NAN, NAN, M_PI / 2})}),
                   {"activate right"});
  Texts texts;
  for (const TraceEvent& event : events) texts.push_back(std::to_string(event.tick) + " " + event.text);
  EXPECT_EQ(texts, (Texts{"1 Step 0 of the task (activate right) begins.",
                          "2 Step 0 of the task (activate right) is done.", "2 Step 1 of the task begins.",
                          "4 Step 1 of the task is missed, 0.5 mm and 90 deg from its goal."}));
}

TEST(TraceEvents, AStepOfATaskCanBeginOrEndInTheFirstTick) {
  EXPECT_EQ(found({column("sequence_step", Integers{0, 0}), column("sequence_running", Integers{1, 1})}),
            (Texts{"0 task"}));
  EXPECT_EQ(found({column("sequence_step", Integers{1, 1}), column("sequence_running", Integers{1, 1})}),
            (Texts{"0 task", "0 task"}))
      << "step 0 is done, step 1 begins";
}

TEST(TraceEvents, HaveTheStepsOfATaskInOrder) {
  EXPECT_EQ(found({column("sequence_step", Integers{0, 0, 1, 1, 2}),
                   column("signed_distance", Doubles{1, 1, 1, -1, -1})}),
            (Texts{"2 task", "3 pop-through", "4 task"}));
}

}  // namespace
}  // namespace remote_touch::trace_event_test
