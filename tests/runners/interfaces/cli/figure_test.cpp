// The output and the exit code of the command `figure` for figures that are made side by side.
#include "runners/interfaces/cli/figure.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "core/kernels/kernels.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "tests/support/test_files.h"

namespace remote_touch::figure_test {
namespace {

Figure nothing(FigureContext&) {
  return {};
}

// They have the names of real figures, because claims.json has an order of figures.
const FigureEntry kFirst{"4.11", "the first", nothing, 1}, kSecond{"4.12", "the second", nothing, 2};
const std::vector<FigureRun> kRuns = {{&kFirst}, {&kSecond}};

Claim claim(const std::string& figure, bool holds) {
  return claim_at_most(figure, "a claim of " + figure, "-", holds ? 1 : 3, 2, "m");
}

using Claims = std::map<std::string, std::vector<Claim>>;

struct Told {
  std::string out, err;
  int code = -1;
};

// Makes the figures as command_figure() does.
Told told(const std::filesystem::path& folder, const Claims& claims) {
  CommandLine line;
  line.quiet = true;
  line.kernels = &kernels_for(best_isa());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Told result;
  {
    FigureFolder made(line, folder, kRuns);
    Progress shown("figures", line.quiet);
    make_figures(
        line, kRuns,
        [&](const FigureEntry& entry, FigureContext&) {
          Figure figure{entry.name, entry.summary, "caption"};
          figure.claims = claims.at(entry.name);
          return figure;
        },
        [&](std::size_t run, const FigureContext& context, Figure figure) {
          made.finish(run, context, std::move(figure));
        },
        [&](const FigureProgress& progress) { made.report(progress, shown); });
    result.code = made.exit_code();
  }
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result;
}

TEST(FigureFolder, EveryLineOfEveryFigureIsPrintedInTheirOrder) {
  const TestFolder folder("figure_folder_test");
  const Told all = told(folder.path(), {{"4.11", {claim("4.11", true)}}, {"4.12", {claim("4.12", true)}}});
  EXPECT_EQ(all.out, "figure 4.11 -> " + (folder / "fig4.11.h5").string() +
                         "\n  pass    a claim of 4.11: 1 m (at most 2)\n" + "figure 4.12 -> " +
                         (folder / "fig4.12.h5").string() + "\n  pass    a claim of 4.12: 1 m (at most 2)\n");
  EXPECT_EQ(all.err, "");
  EXPECT_EQ(all.code, kDone);
}

TEST(FigureFolder, AFileThatIsNoResultIsNotOverwritten) {
  const TestFolder folder("figure_folder_test");
  const std::filesystem::path file = folder.write("fig4.12.h5", "of someone else");
  const CommandLine line;
  EXPECT_EQ(refusal([&] { FigureFolder(line, folder.path(), kRuns); }),
            file.string() +
                ": exists already and is not a result of this program: expected another file, or --force");
  EXPECT_EQ(bytes_of(file), "of someone else");
}

TEST(FigureFolder, ALongClaimKeepsTheEndOfItsLine) {
  const TestFolder folder("figure_folder_test");
  Claim is_long = claim("4.11", true);
  is_long.claim = std::string(3000, 'x');
  const Told all = told(folder.path(), {{"4.11", {is_long}}, {"4.12", {claim("4.12", true)}}});
  EXPECT_HAS(all.out, std::string(3000, 'x') + ": 1 m (at most 2)\nfigure 4.12 -> ");
}

TEST(FigureFolder, AClaimThatDiffersNamesItsSource) {
  const TestFolder folder("figure_folder_test");
  Figure models{"4.12", "", ""};
  models.source = "the published models";
  remote_touch::Claims(models).differs("width: ratio", 1.5, 1, 2, "1", "1 (equal)");
  const Told all = told(folder.path(), {{"4.11", {claim_differs("4.11", "speed", "16", 29, 28, 30, "m/s")}},
                                        {"4.12", models.claims}});
  EXPECT_HAS(all.out, "speed: 29 m/s (expected here: from 28 to 30, the dissertation: 16)\n");
  EXPECT_HAS(all.out, "width: ratio: 1.5 1 (expected here: from 1 to 2, the published models: 1 (equal))\n");
  const std::string claims = bytes_of(folder / "claims.json");
  EXPECT_HAS(claims, "\"source\": \"the dissertation\"");
  EXPECT_HAS(claims, "\"source\": \"the published models\"");
}

// The exit code reports a failed claim, whatever else is claimed before or after it.
TEST(FigureFolder, AFailedClaimIsTheExitCode) {
  const Claim none = claim_not_run("4.11", "needs a recording", "it is not there");
  const Claim open = [] {
    Claim one = claim("4.11", true);
    one.verdict = Verdict::open;
    return one;
  }();
  const std::vector<Claims> all = {
      {{"4.11", {claim("4.11", false)}}, {"4.12", {claim("4.12", true)}}},
      {{"4.11", {claim("4.11", true)}}, {"4.12", {claim("4.12", false)}}},
      {{"4.11", {claim("4.11", false), claim("4.11", true)}}, {"4.12", {claim("4.12", true)}}},
      {{"4.11", {set_up(claim("4.11", false))}}, {"4.12", {claim("4.12", true)}}},
      {{"4.11", {claim("4.11", true)}},
       {"4.12", {claim_at_most("4.12", "no number", "-", std::numeric_limits<double>::quiet_NaN(), 2, "m")}}},
      {{"4.11", {open}}, {"4.12", {claim_differs("4.12", "outside", "4", 3, 1, 2, "m")}}},
      {{"4.11", {none}}, {"4.12", {claim("4.12", false)}}},
      {{"4.11", {none, claim("4.11", false)}}, {"4.12", {none}}},
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TestFolder folder("figure_folder_test");
    const Told one = told(folder.path(), all[i]);
    EXPECT_EQ(one.code, kCheckFailed) << i;
    EXPECT_HAS(one.out, "  FAIL    ") << i;
    EXPECT_HAS(bytes_of(folder / "claims.json"), "\"verdict\": \"fail\"") << i;
  }
}

TEST(FigureFolder, ExitCodeIsBadInputIfNoFigureWasMade) {
  const TestFolder folder("figure_folder_test");
  const Claim none = claim_not_run("4.11", "needs a recording", "it is not there");
  EXPECT_EQ(told(folder.path(), {{"4.11", {none}}, {"4.12", {none}}}).code, kBadInput);
  EXPECT_EQ(told(folder.path(), {{"4.11", {none}}, {"4.12", {claim("4.12", true)}}}).code, kDone);
}

}  // namespace
}  // namespace remote_touch::figure_test
