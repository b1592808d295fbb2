// Student's t: intervals and a test of the mean of a few numbers.
#pragma once

#include <vector>

#include "analysis/statistics/mean.h"
#include "analysis/statistics/paired_test.h"

namespace remote_touch {

// Two-sided p value: the probability of a |t| at least as large, with this number of degrees of freedom
// (Abramowitz and Stegun, 26.7.3 and 26.7.4). pre: degrees >= 1.
double student_two_sided(double t, int degrees);
// Two-sided critical value: |t| is larger than this with the given probability in (0, 1].
double student_quantile(double probability, int degrees);

// Mean over all numbers and its 95 % interval, from the scatter within each group, such as a noise level: the
// means of groups may differ. Degrees of freedom by F. Satterthwaite (Biometrics Bulletin 2 (1946), 110-114),
// rounded down. A number that is alone in its group shows no scatter of its own. All such numbers together
// form one group (one number alone adds no scatter), except those of a group i with without_scatter[i], whose
// scatter is known to be 0 (an empty list: false for all groups). NaNs are skipped. The mean is NaN without
// numbers; the interval is NaN if no group then has two numbers.
MeanDifference student_mean(const std::vector<std::vector<double>>& groups,
                            const std::vector<bool>& without_scatter = {});
// The same for groups of which only the moments are known; `third` is not used.
MeanDifference student_mean_of_moments(const std::vector<Moments>& groups,
                                       const std::vector<bool>& without_scatter = {});

// Tests that the mean of n paired differences is 0. Returns the largest of three p values: the two-sided p of
// Student's t, that of Student's t corrected for skewness (P. Hall, J. R. Stat. Soc. B 54 (1992), 221-228),
// and 2^(1 - n), the smallest p that an exact sign-flip test of n pairs can give. Returns 1 if there are
// fewer than two numbers, if their mean is 0, or if the two forms of t have different signs. NaNs are
// skipped.
//
// Probability of a false p < 0.05 (no true difference): at most 0.05 if a difference is as likely as its
// opposite, as for two equal methods, however skewed their values are. If the differences themselves are
// skewed around a mean of 0, it is larger. The table has this probability, and in brackets that of t alone:
//
//                          12 pairs      20 pairs
//   exponential            0.06 (0.10)   0.05 (0.08)
//   lognormal (sigma 1)    0.09 (0.15)   0.07 (0.13)
//
// No test of a mean is exact for all distributions.
double mean_test(const std::vector<double>& differences);

}  // namespace remote_touch
