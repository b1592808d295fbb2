#include "runners/view/true_heights.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remote_touch::true_heights_test {
namespace {

// A plane that is inclined, known where x >= 0 only, and rises.
class RisingPlane final : public Scenario {
 public:
  explicit RisingPlane(double velocity_m_per_s) : velocity_(velocity_m_per_s) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  std::shared_ptr<const NeighbourSearch> points(int) const override { return nullptr; }
  PointCloud cloud(int) const override { return {}; }
  double signed_distance(const Vec3&, double) const override { return 0; }
  double surface_height(double x, double z, double time_s) const override {
    return x < -1e-9 ? std::nan("") : 0.5 * x - 0.25 * z + velocity_ * time_s;
  }

 private:
  double velocity_;
};

const BoundingBox kBox(Vec3(-0.1, -1, -0.2), Vec3(0.1, 1, 0.2));

TEST(TrueHeights, AreThoseOfTheSceneOverItsGridAndTimes) {
  const RisingPlane scene(0.3);
  const TrueHeights all = true_heights(scene, kBox, 1, 3);
  constexpr int n = TrueHeights::kColumns;
  ASSERT_EQ(all.height_m.size(), all.time_s.size() * n * n);
  EXPECT_EQ(all.time_s.front(), 1);
  EXPECT_EQ(all.time_s.back(), 3);
  ASSERT_GT(all.time_s.size(), 60u);
  ASSERT_LE(all.time_s.size(), 200u);
  for (std::size_t t = 0; t < all.time_s.size(); t += 7)
    for (int k = 0; k < n; k += 5)
      for (int i = 0; i < n; i += 4) {
        const double x = -0.1 + 0.2 * i / (n - 1), z = -0.2 + 0.4 * k / (n - 1);
        const double height =
            all.height_m[(t * n + static_cast<std::size_t>(k)) * n + static_cast<std::size_t>(i)];
        if (x < -1e-9)
          EXPECT_TRUE(std::isnan(height));
        else
          EXPECT_NEAR(height, 0.5 * x - 0.25 * z + 0.3 * all.time_s[t], 1e-6);
      }
}

TEST(TrueHeights, OneTimeIsEnoughForASceneAtRest) {
  const TrueHeights all = true_heights(RisingPlane(0), kBox, 0, 3);
  EXPECT_EQ(all.time_s.size(), 1u);
  EXPECT_EQ(all.height_m.size(), std::size_t{TrueHeights::kColumns * TrueHeights::kColumns});
}

TEST(TrueHeights, NoneWhereNothingIsKnown) {
  const BoundingBox left(Vec3(-0.3, -1, -0.2), Vec3(-0.1, 1, 0.2));
  EXPECT_TRUE(true_heights(RisingPlane(0.1), left, 0, 3).empty());
}

}  // namespace
}  // namespace remote_touch::true_heights_test
