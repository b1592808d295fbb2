// The figures that can be reproduced: each runs experiments and hands their traces to analyses.
#pragma once

#include <span>

#include "runners/evaluation/figures/parts/figure_context.h"

namespace remote_touch {

struct FigureEntry {
  const char* name;
  const char* summary;
  MakeFigure* make;
  double expected_s;     // time on one thread, for the order of figures and the time left
  bool has_map = false;  // the map needs most of that time
  int quick_coarse = 1;  // value of coarse for a quick figure
};
std::span<const FigureEntry> figures();

}  // namespace remote_touch
