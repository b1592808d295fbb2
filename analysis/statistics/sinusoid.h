// The part of a signal that has a given frequency.
#pragma once

#include <vector>

namespace remote_touch {

struct Sinusoid {
  double amplitude = 0;
  double phase_rad = 0;  // phi in amplitude * cos(2 pi f t + phi), from -pi to pi
};

// Returns the sinusoid of frequency hz that is nearest to the values by least squares, beside their mean:
// the Fourier coefficient at that frequency. NaN if there are no values. Pre: as many times as values, which
// are evenly spaced and cover whole periods.
Sinusoid sinusoid_in(const std::vector<double>& time_s, const std::vector<double>& values, double hz);

// Returns by how much the second sinusoid lags behind the first, from -1 / (2 hz) to 1 / (2 hz).
double lag_s(const Sinusoid& first, const Sinusoid& second, double hz);

}  // namespace remote_touch
