// The tallies of data/studies, which are compiled into the program: studies that take hours.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/sweeps/event_limits.h"
#include "analysis/sweeps/tally_file.h"
#include "analysis/theory/surface_contacts.h"

namespace remote_touch {

struct EmbeddedFile {
  const char* name;  // name of the file without its ending
  std::string_view bytes;
};
std::span<const EmbeddedFile> embedded_studies();

// Returns the tally of data/studies/NAME.h5. Throws InputError if there is none of this name.
StoredTally stored_study(const std::string& name);

// The limits of pop-through in the tally of the sweep pop-through-law, as pure numbers.

// r_c and f_c of the study. Lengths are in r_c, speeds in r_c f_c, accelerations in r_c f_c^2.
inline constexpr double kLawRadius_m = 0.005, kLawRate_hz = 30;

// Pure numbers of the axes, in the order of the sweep.
struct LawAxes {
  std::vector<double> spacing, speed, noise, acceleration;
};
// Throws InputError unless the axes are spacing_m, start_velocity_m_per_s, noise_sigma_m and
// acceleration_m_per_s2.
LawAxes law_axes(const SweepGrid& grid);

// The acceleration at which a share of the lifts has popped through, for each spacing, speed and noise; the
// ends of its 95 % interval. NaN if it is outside the axis. See event_limits.h.
struct LawLimit {
  std::size_t spacing = 0, speed = 0, noise = 0;  // indices of the values
  double limit = 0, low = 0, high = 0;            // r_c f_c^2
};
// The limits of all combinations, the noise running fastest. events: the count of lifts that popped through.
std::vector<LawLimit> law_limits(const SweepGrid& grid, const CellCounts& events, double level);

// Returns the known limits at one speed, of the chosen spacings.
std::vector<LimitPoint> points_at(const LawAxes& axes, const std::vector<LawLimit>& limits, std::size_t speed,
                                  const std::vector<std::size_t>& spacings);

}  // namespace remote_touch
