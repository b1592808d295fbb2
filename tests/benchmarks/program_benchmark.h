#pragma once

namespace remote_touch::benchmarks {

// Adds quadratic programs of six variables, and the same by NLopt. The answers are first compared with those
// of least distance programming.
void add_programs();

}  // namespace remote_touch::benchmarks
