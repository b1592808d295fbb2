#include "analysis/statistics/student.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remote_touch::student_test {
namespace {

// The distribution of 1 degree of freedom is Cauchy's, and that of 2 is t / sqrt(2 + t^2). Quantiles are
// those of printed tables.
TEST(Student, TheDistributionIsThatOfTheTables) {
  for (const double t : {0.0, 0.3, 1.0, 7.0, 500.0}) {
    EXPECT_NEAR(student_two_sided(t, 1), 1 - 2 / M_PI * std::atan(t), 1e-14) << t;
    EXPECT_NEAR(student_two_sided(t, 2), 1 - t / std::sqrt(2 + t * t), 1e-14) << t;
    EXPECT_EQ(student_two_sided(-t, 5), student_two_sided(t, 5));
  }
  EXPECT_NEAR(student_quantile(0.05, 1), 12.7062, 5e-5);
  EXPECT_NEAR(student_quantile(0.05, 4), 2.7764, 5e-5);
  EXPECT_NEAR(student_quantile(0.05, 5), 2.5706, 5e-5);
  EXPECT_NEAR(student_quantile(0.05, 11), 2.2010, 5e-5);
  EXPECT_NEAR(student_quantile(0.01, 30), 2.7500, 5e-5);
  EXPECT_NEAR(student_quantile(0.05, 100000), 1.95999, 5e-5);
}

}  // namespace
}  // namespace remote_touch::student_test
