// Cells of a sweep as the user writes them.
#pragma once

#include <string>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// Returns the index on each axis, from 0: "3,4".
std::string cell_text(const SweepResult& result, std::size_t cell);

// text: the indices as cell_text() writes them, or a value of each axis, "noise_sigma_m=0.003,rule=none". A
// number names the value that is equal to it or, if there is none, the only value of the axis that has the
// same text with six digits.
struct NamedCell {
  std::string option;  // option with which the user named it, for errors: "--cell"
  std::string text;
};

// Throws InputError.
std::size_t cell_of(const NamedCell& cell, const SweepResult& result);

}  // namespace remote_touch
