// Arrays for NumPy: one .npz archive.
#pragma once

#include "runners/presentation/export/export_job.h"

namespace remote_touch {

// Writes a member for each column: COLUMN, or TABLE/COLUMN if there are several tables. Numbers are as they
// are stored, vectors have shape (n, 3), enumerations are numbers. Before them are `format`, and `about`, a
// text of JSON: `attributes` of the result, and for each member `unit`, `meaning` and `names` of the values
// of an enumeration. Throws InputError beyond 4 GiB or 65534 arrays.
void write_npz(const ExportJob& job);

}  // namespace remote_touch
