// The largest stable stiffness of a sampled wall: the law where it holds, and the simulated device beyond it.
#include "analysis/theory/sampled_wall.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remote_touch::sampled_wall_test {
namespace {

// The correction of the law to first order, see wall_law_N_per_m().
double corrected_law(const SampledWall& w) {
  const double t = (0.5 + w.delay_ticks) * w.tick_s, t_B = t + 0.5 * w.velocity_ticks * w.tick_s;
  const double law = wall_law_N_per_m(w);
  return law *
         (1 + law * t * t / (6 * w.mass_kg) - w.wall_damping_Ns_per_m * t_B * t_B / (2 * w.mass_kg * t));
}

TEST(SampledWall, TheLawAndItsCorrectionHoldForAHeavyHand) {
  for (const double mass_kg : {1.0, 3.0, 10.0})
    for (const double b : {0.1, 0.5, 2.0})
      for (const double B : {0.0, 0.5, 10.0})
        for (const int delay : {0, 1, 5})
          for (const int ticks : {1, 5}) {
            const SampledWall wall{mass_kg, b, B, 0, delay, ticks};
            const double correction = std::abs(corrected_law(wall) / wall_law_N_per_m(wall) - 1);
            if (correction > 0.1) continue;
            EXPECT_NEAR(exact_wall_limit_N_per_m(wall) / corrected_law(wall), 1,
                        8 * correction * correction + 0.002)
                << mass_kg << " " << b << " " << B << " " << delay << " " << ticks;
          }
}

// A spring of the hand makes the oscillation faster, which a wall without a damper hardly notices.
TEST(SampledWall, ASpringOfTheHandHardlyMatters) {
  const SampledWall without{0.3, 1, 0, 0, 5};
  SampledWall with = without;
  with.spring_share = 0.25;
  EXPECT_NEAR(exact_wall_limit_N_per_m(with) / exact_wall_limit_N_per_m(without), 1, 0.01);
}

// The law promises 3429 N/m here.
TEST(SampledWall, TheLawIsTooHighForALightHandWithALateDamper) {
  const SampledWall wall{.mass_kg = 0.1,
                         .damping_Ns_per_m = 2,
                         .wall_damping_Ns_per_m = 10,
                         .delay_ticks = 3,
                         .velocity_ticks = 5};
  EXPECT_NEAR(wall_law_N_per_m(wall), 3428.6, 0.1);
  EXPECT_NEAR(exact_wall_limit_N_per_m(wall), 2000, 50);
}

// Masses, dampers and stiffnesses have a common factor: it has no meaning.
TEST(SampledWall, ScalesWithTheMass) {
  for (const double factor : {0.001, 7.0}) {
    const SampledWall a{0.2, 1, 3, 0.25, 2, 4};
    const SampledWall b{factor * 0.2, factor * 1, factor * 3, 0.25, 2, 4};
    EXPECT_NEAR(exact_wall_limit_N_per_m(b) / exact_wall_limit_N_per_m(a), factor, 1e-6 * factor);
  }
}

TEST(SampledWall, ADamperThatIsTooLateMakesEveryWallUnstable) {
  EXPECT_EQ(exact_wall_limit_N_per_m(
                {.mass_kg = 0.01, .damping_Ns_per_m = 0.1, .wall_damping_Ns_per_m = 10, .delay_ticks = 5}),
            0);
}

}  // namespace
}  // namespace remote_touch::sampled_wall_test
