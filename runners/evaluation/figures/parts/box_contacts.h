// Fig 6.3: the number of points that touch the tool at once, over the spacing of the points.
#pragma once

#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// Adds a table for each contact rule, the claims, and two panels in a row of their own. sweep: the result of
// fig6.3-spacings. The dissertation counts "as many as 6 contact points" (6.3.1) and prints no spacing.
void add_contacts_over_spacing(Figure& figure, const SweepResult& sweep, int row);

}  // namespace remote_touch
