// Student's t: intervals of the mean of a few numbers.
#pragma once

#include <vector>

#include "analysis/statistics/estimate.h"
#include "analysis/statistics/mean.h"

namespace remote_touch {

// Two-sided p value: the probability of a |t| at least as large, with this number of degrees of freedom. pre:
// degrees >= 1.
double student_two_sided(double t, double degrees);
// Two-sided critical value: |t| is larger than this with the given probability in (0, 1]. pre: degrees >= 1.
double student_quantile(double probability, double degrees);

// The numbers of a stratum, such as the runs of a cell: strata may have different means.
struct Stratum {
  std::vector<double> numbers;  // NaNs are skipped and count as unknown
  bool is_fixed = false;        // the numbers are equal by construction: they count as one without scatter
};

// Mean of all numbers. The interval is Student's, from the scatter within the strata, with the degrees of
// freedom of F. Satterthwaite (Biometrics Bulletin 2 (1946), 110-114), rounded down. From 6 numbers and 5
// degrees on, it is the hull of that and of the interval corrected for skewness by P. Hall (J. R. Stat. Soc.
// B 54 (1992), 221-228); with fewer a note says that it assumes a normal distribution. It is NaN, with a
// note, if nothing scatters. Numbers that are alone in a stratum which is not fixed form one stratum
// together. If all strata are fixed, the value is exact, and the method is kExactMethod.
Estimate estimated_mean(const std::vector<Stratum>& strata);
// The same for one stratum.
Estimate estimated_mean(const std::vector<double>& numbers);

// The moments of a stratum of which the numbers are not known.
struct StratumMoments {
  Moments moments;
  bool is_fixed = false;
  std::int64_t unknown = 0;
};
// The same; without the correction for skewness unless has_third, which says that Moments::third is set.
Estimate estimated_mean(const std::vector<StratumMoments>& strata, bool has_third);

}  // namespace remote_touch
