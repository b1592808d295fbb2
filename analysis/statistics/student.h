// Student's t: intervals and a test of the mean of a few numbers.
#pragma once

#include <vector>

#include "analysis/statistics/paired_test.h"

namespace remote_touch {

// Probability that |t| is at least so large, with so many degrees of freedom (Abramowitz and Stegun, 26.7.3
// and 26.7.4). pre: degrees >= 1.
double student_two_sided(double t, int degrees);
// The t that is exceeded, on either side, with this probability in (0, 1].
double student_quantile(double probability, int degrees);

// Mean over all numbers and its 95 % interval, from the scatter within each group, such as a noise level: the
// means of groups may differ. Degrees of freedom by F. Satterthwaite (Biometrics Bulletin 2 (1946), 110-114),
// rounded down. A number that is alone in its group shows no scatter: all those are one group, except where
// certain[i] says that group i has none (empty: nowhere). NaNs are skipped; NaN with too few.
MeanDifference student_mean(const std::vector<std::vector<double>>& groups,
                            const std::vector<bool>& certain = {});

// Test that the mean of paired differences is 0: the two-sided p of Student's t, of Student's t corrected for
// skewness (P. Hall, J. R. Stat. Soc. B 54 (1992), 221-228), and the smallest p that an exact sign-flip test
// could give for so many pairs, 2^(1 - n): the largest of the three. 1 for fewer than two numbers, and where
// both forms of t disagree about the sign. NaNs are skipped.
//
// The probability of p < 0.05 without a true difference is at most 0.05 where a difference is as likely as
// its opposite, as of two equal methods, however skewed their values are. Of differences that are skewed
// themselves around a mean of 0 it is 0.06 at 12 pairs and 0.05 at 20 if they are exponential, and 0.09 and
// 0.07 if they are lognormal (sigma 1), where t alone gives 0.10 and 0.08, 0.15 and 0.13; no test of a mean
// is exact for all of them.
double mean_test(const std::vector<double>& differences);

}  // namespace remote_touch
