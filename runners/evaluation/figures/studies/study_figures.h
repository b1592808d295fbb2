// The figures of studies that take hours: they are drawn from their stored tallies, and a few cells are made
// again.
#pragma once

#include "runners/evaluation/figures/context/figure_context.h"

namespace remote_touch {

MakeFigure figure_pop_through_law;

}  // namespace remote_touch
