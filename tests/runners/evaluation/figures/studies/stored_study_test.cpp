// The stored studies are the files of data/studies, and the limits that figures take from them.
#include "runners/evaluation/figures/studies/stored_study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "runners/sweep/stored_sweep.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_study_test {
namespace {

TEST(StoredStudies, AreTheFilesOfTheFolder) {
  const std::filesystem::path folder = std::filesystem::path(REMOTE_TOUCH_SOURCE_DIR) / "data/studies";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files += entry.path().extension() == ".h5";
  EXPECT_EQ(embedded_studies().size(), files);
  for (const EmbeddedFile& study : embedded_studies()) {
    const std::filesystem::path file = folder / (std::string(study.name) + ".h5");
    EXPECT_LE(std::filesystem::file_size(file), 1'000'000u);
    EXPECT_TRUE(study.bytes == bytes_of(file)) << study.name;
    EXPECT_EQ(digest(stored_study(study.name).tally), digest(read_tally(Hdf5Reader(file)).tally));
  }
}

TEST(StoredStudies, HaveAName) {
  EXPECT_HAS(refusal([] { stored_study("no-study"); }),
             "no-study: no such study: expected a file of data/studies");
}

// Ten of ten lifts pop through from a known acceleration on, which depends on the spacing and the noise.
TEST(LawLimits, AreWhereTheEventBegins) {
  SweepGrid outline;
  const auto axis = [&](const char* name, std::vector<double> values) {
    outline.axes.push_back({name, "1", "", std::move(values)});
  };
  axis("spacing_m", {0.001, 0.002}), axis("start_velocity_m_per_s", {0.15});
  axis("noise_sigma_m", {0.0025, 0.005}), axis("acceleration_m_per_s2", {0.9, 1.8, 2.7, 3.6, 4.5});
  const auto first = [](std::size_t spacing, std::size_t noise) { return 1 + spacing + 2 * noise; };
  const CellCounts counts{[&](std::size_t cell) {
    const std::vector<std::size_t> at = outline.axis_indices(cell);
    return at[3] >= first(at[0], at[2]) ? EventCounts{10, 0} : EventCounts{0, 10};
  }};
  const LawAxes axes = law_axes(outline);
  EXPECT_NEAR(axes.spacing[1], 0.4, 1e-12);
  EXPECT_NEAR(axes.speed[0], 1, 1e-12);
  EXPECT_NEAR(axes.noise[1], 1, 1e-12);
  EXPECT_NEAR(axes.acceleration[4], 1, 1e-12);
  const std::vector<LawLimit> limits = law_limits(outline, counts, 0.5);
  ASSERT_EQ(limits.size(), 4u);
  for (const LawLimit& each : limits) {
    const double at = 0.2 * (static_cast<double>(first(each.spacing, each.noise)) + 0.5);  // half way
    EXPECT_NEAR(each.limit, at, 1e-12) << each.spacing << each.noise;
  }
  const std::vector<LimitPoint> points = points_at(axes, limits, 0, {1});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[1].limit, 0.2 * 4.5, 1e-12);
  EXPECT_NEAR(points[1].spacing, 0.4, 1e-12);
  outline.axes[0].name = "columns";
  EXPECT_HAS(refusal([&] { law_axes(outline); }),
             "columns: an axis of a study of pop-through: expected spacing_m");
}

}  // namespace
}  // namespace remote_touch::stored_study_test
