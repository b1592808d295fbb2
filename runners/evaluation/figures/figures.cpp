#include "runners/evaluation/figures/figures.h"

namespace remote_touch {

#define FIGURE(name, summary, make, ...) MakeFigure make;
#include "runners/evaluation/figures/figure_table.h"
#undef FIGURE

std::span<const FigureEntry> figures() {
  static constexpr FigureEntry kFigures[] = {
#define FIGURE(...) {__VA_ARGS__},
#include "runners/evaluation/figures/figure_table.h"
#undef FIGURE
  };
  return kFigures;
}

}  // namespace remote_touch
