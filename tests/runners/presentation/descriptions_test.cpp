#include "runners/presentation/descriptions.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/test_files.h"

namespace remote_touch::descriptions_test {
namespace {

std::string refused(const std::string& name) {
  return refusal([&] { described(name); });
}
auto line_count(const std::string& text) {
  return std::ranges::count(text, '\n');
}

TEST(ParameterDescription, IsThatOfOneEntry) {
  const std::string text = described("proxy.r1_m");
  EXPECT_TRUE(text.starts_with("proxy.r1_m: a parameter of \"renderer\": ")) << text;
  EXPECT_HAS(text, "\n  unit m; default 0.00499; allowed ");
  EXPECT_HAS(text, "; live\n");
  EXPECT_EQ(line_count(text), 2);
  EXPECT_HAS(described("flat-grid.noise_sigma_m"), "flat-grid.noise_sigma_m: a parameter of \"scenario\": ");
}

TEST(ParameterDescription, OfASectionIsThatOfEveryEntryThatHasIt) {
  const std::string text = described("renderer.r1_m");
  EXPECT_HAS(text, "proxy.r1_m: ");
  EXPECT_HAS(text, "tracked-sheet.r1_m: ");
  EXPECT_EQ(text.find("tool.r1_m"), std::string::npos);
  EXPECT_HAS(described("run.seed"), "run.seed: a parameter of \"run\": ");
  EXPECT_EQ(described("fixtures.0.radius_m"), described("fixtures.radius_m"));
}

TEST(ParameterDescription, OfATraceIsThatOfAColumn) {
  EXPECT_EQ(described("trace.force"),
            "trace.force: a column of a trace: force of the renderer, world frame\n"
            "  unit N; 3 in each row; in every run\n");
  EXPECT_HAS(described("trace.state"), "0 free, 1 contact, 2 entrenched\n  with a tool: ");
}

TEST(ParameterDescription, RefusesAnUnknownParameterWithTheNearestOne) {
  EXPECT_EQ(refused("proxy.r1"), "proxy.r1: unknown; did you mean proxy.r1_m");
  EXPECT_EQ(refused("renderer.stifness_N_per_m"),
            "renderer.stifness_N_per_m: unknown; did you mean renderer.stiffness_N_per_m");
  EXPECT_EQ(refused("trace.forces"), "trace.forces: unknown; did you mean trace.force");
}

TEST(ParameterDescription, RefusesAnUnknownOwner) {
  for (const char* name : {"absent.r1_m", "fig4.12.seed", "proxy.0.1.r1_m", "proxy.", ".seed", ".", ""})
    EXPECT_HAS(refused(name), "expected a name from `remote-touch list`, or NAME.PARAMETER") << name;
}

// A sweep that keeps a tally, for example, has no plan of its runs.
TEST(Descriptions, AreThereOfEverySweepAndFigure) {
  for (const char* kind : {"sweeps", "figures"})
    for (const auto& row : named_kind(kind).rows) EXPECT_HAS(described(row.name), row.name + ": a ");
}

TEST(NamedKind, HasTheRowsOfTheList) {
  const NamedKind rules = named_kind("fixture rules");
  ASSERT_FALSE(rules.rows.empty());
  EXPECT_EQ(rules.rows.front().name, "everywhere");
}

TEST(NamedKind, IsRefusedWithAllKinds) {
  const std::string message = refusal([] { named_kind("robots"); });
  EXPECT_HAS(message, "robots: is not a kind: expected sections, scenarios, fixture rules, ");
  for (const NamedKind& kind : named_kinds()) EXPECT_HAS(message, kind.kind);
}

}  // namespace
}  // namespace remote_touch::descriptions_test
