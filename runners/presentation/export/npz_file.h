// Arrays for NumPy: one .npz archive.
#pragma once

#include "runners/presentation/export/export_job.h"

namespace remote_touch {

// A member for each column, TABLE/COLUMN of a figure: numbers as they are stored, vectors of shape (n, 3),
// enumerations as numbers. Before them `format`, and `about`, a text of JSON: `attributes` of the result, and
// of each member `unit`, `meaning` and `names` of the values of an enumeration. Throws InputError beyond 4
// GiB.
void write_npz(const ExportJob& job);

}  // namespace remote_touch
