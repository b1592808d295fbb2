#include "runners/scorecard/noise_plot.h"

#include <cmath>

#include "runners/scorecard/contest.h"
#include "runners/scorecard/formed.h"

namespace remote_touch {

namespace {

constexpr double kWidth = 420, kHeight = 190, kLeft = 34, kRight = 8, kTop = 8, kBottom = 26;

struct Axes {
  std::size_t levels, contenders;
  double x(std::size_t level, std::size_t contender) const {
    const double step = (kWidth - kLeft - kRight) / static_cast<double>(levels);
    const double beside =
        (static_cast<double>(contender) + 0.5) / static_cast<double>(contenders) - 0.5;  // -0.5 .. 0.5
    return kLeft + step * (static_cast<double>(level) + 0.5 + 0.6 * beside);
  }
  double y(double share) const { return kTop + (kHeight - kTop - kBottom) * (1 - share); }
};

std::string frame(const SceneScore& scene, const Axes& axes) {
  std::string svg;
  for (const double share : {0.0, 0.5, 1.0}) {
    svg += formed(R"(<path class="grid" d="M%.1f %.1fH%.1f"/>)", kLeft, axes.y(share), kWidth - kRight);
    svg +=
        formed(R"(<text x="%.1f" y="%.1f" text-anchor="end">%g</text>)", kLeft - 4, axes.y(share) + 4, share);
  }
  const double step = (kWidth - kLeft - kRight) / static_cast<double>(axes.levels);
  for (std::size_t i = 0; i < axes.levels; ++i)
    svg += formed(R"(<text x="%.1f" y="%.1f" text-anchor="middle">%s</text>)",
                  kLeft + step * (static_cast<double>(i) + 0.5), kHeight - 8,
                  level_text(scene.noise_m[i]).c_str());
  return svg;
}

std::string line_of(const std::vector<Share>& levels, const Axes& axes, std::size_t contender) {
  std::string line, bars, dots;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double x = axes.x(i, contender), y = axes.y(levels[i].share);
    line += formed("%s%.1f %.1f", i == 0 ? "M" : "L", x, y);
    bars += formed("M%.1f %.1fV%.1f", x, axes.y(levels[i].low), axes.y(levels[i].high));
    dots += formed(R"(<circle cx="%.1f" cy="%.1f" r="2.6"/>)", x, y);
  }
  return formed(R"(<g class="c%zu"><path class="line" d=")", contender) + line +
         R"("/><path class="bar" d=")" + bars + R"("/>)" + dots + "</g>";
}

}  // namespace

const char* contender_colour(std::size_t contender) {
  // Okabe and Ito's colours, which the colour-blind tell apart.
  static constexpr const char* kColours[] = {"#d55e00", "#0072b2", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000", "#999999"};
  return kColours[contender % std::size(kColours)];
}

std::string level_text(double noise_m) {
  return std::isnan(noise_m) ? "own" : formed("%g", std::round(1000 * noise_m / kScorecardRadius_m) / 1000);
}

std::string noise_plot(const SceneScore& scene, const std::vector<std::string>& contenders) {
  const Axes axes{scene.noise_m.size(), contenders.size()};
  std::string svg = formed(
      R"(<svg viewBox="0 0 %g %g" role="img" aria-label="share of successes over noise in units of r_c">)",
      kWidth, kHeight);
  svg += frame(scene, axes);
  for (std::size_t c = 0; c < contenders.size(); ++c) svg += line_of(scene.success[c], axes, c);
  return svg + "</svg>";
}

}  // namespace remote_touch
