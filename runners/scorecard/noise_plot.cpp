#include "runners/scorecard/noise_plot.h"

#include <cmath>

#include "runners/scorecard/benchmark.h"
#include "runners/scorecard/formatted.h"

namespace remote_touch {

namespace {

constexpr double kWidth = 420, kHeight = 190, kLeft = 34, kRight = 8, kTop = 8, kBottom = 26;

struct Axes {
  std::size_t levels, methods;
  double x(std::size_t level, std::size_t method) const {
    const double step = (kWidth - kLeft - kRight) / static_cast<double>(levels);
    const double beside =
        (static_cast<double>(method) + 0.5) / static_cast<double>(methods) - 0.5;  // -0.5 .. 0.5
    return kLeft + step * (static_cast<double>(level) + 0.5 + 0.6 * beside);
  }
  double y(double fraction) const { return kTop + (kHeight - kTop - kBottom) * (1 - fraction); }
};

std::string frame(const SceneScore& scene, const Axes& axes) {
  std::string svg;
  for (const double fraction : {0.0, 0.5, 1.0}) {
    svg += formatted(R"(<path class="grid" d="M%.1f %.1fH%.1f"/>)", kLeft, axes.y(fraction), kWidth - kRight);
    svg += formatted(R"(<text x="%.1f" y="%.1f" text-anchor="end">%g</text>)", kLeft - 4,
                     axes.y(fraction) + 4, fraction);
  }
  const double step = (kWidth - kLeft - kRight) / static_cast<double>(axes.levels);
  for (std::size_t i = 0; i < axes.levels; ++i)
    svg += formatted(R"(<text x="%.1f" y="%.1f" text-anchor="middle">%s</text>)",
                     kLeft + step * (static_cast<double>(i) + 0.5), kHeight - 8,
                     level_text(scene.noise_m[i]).c_str());
  return svg;
}

std::string line_of(const std::vector<Proportion>& levels, const Axes& axes, std::size_t method) {
  std::string line, bars, dots;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double x = axes.x(i, method), y = axes.y(levels[i].fraction);
    line += formatted("%s%.1f %.1f", i == 0 ? "M" : "L", x, y);
    bars += formatted("M%.1f %.1fV%.1f", x, axes.y(levels[i].low), axes.y(levels[i].high));
    dots += formatted(R"(<circle cx="%.1f" cy="%.1f" r="2.6"/>)", x, y);
  }
  return formatted(R"(<g class="c%zu"><path class="line" d=")", method) + line +
         R"("/><path class="bar" d=")" + bars + R"("/>)" + dots + "</g>";
}

}  // namespace

const char* method_colour(std::size_t method) {
  // Okabe and Ito's colours, which the colour-blind tell apart.
  static constexpr const char* kColours[] = {"#d55e00", "#0072b2", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000", "#999999"};
  return kColours[method % std::size(kColours)];
}

std::string level_text(double noise_m) {
  return std::isnan(noise_m) ? "own"
                             : formatted("%g", std::round(1000 * noise_m / kScorecardRadius_m) / 1000);
}

std::string noise_plot(const SceneScore& scene, const std::vector<std::string>& methods) {
  const Axes axes{scene.noise_m.size(), methods.size()};
  std::string svg = formatted(
      R"(<svg viewBox="0 0 %g %g" role="img" aria-label="share of successes over noise in units of r_c">)",
      kWidth, kHeight);
  svg += frame(scene, axes);
  for (std::size_t c = 0; c < methods.size(); ++c) svg += line_of(scene.success[c], axes, c);
  return svg + "</svg>";
}

}  // namespace remote_touch
