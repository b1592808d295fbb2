// The 1 cm radius query compared with those of PCL and nanoflann: the same clouds, the same moving centres, a
// list of indices as the answer. Every search is compared with the plain loop over all points before it is
// timed.
#include <benchmark/benchmark.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/organized.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <nanoflann.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/naive_proxy.h"
#include "tests/support/scenes.h"

namespace remote_touch {
namespace {

// PCL keeps points in float, so a point this near to the sphere may be on either side. nanoflann excludes the
// sphere itself. All other points must be the same.
constexpr double kUndecided_m = 1e-6;

class Ours {
 public:
  Ours(const PointCloud& cloud, const Kernels& kernels) : kernels_(kernels), search_(make_search(cloud)) {
    list_.reserve(search_->size(), false, false);
  }
  std::size_t find(const Ball& ball) {
    list_.clear();
    search_->gather(ball, kernels_, list_);
    list_.finish();
    return list_.size();
  }
  std::vector<std::uint32_t> found() const { return {list_.index(), list_.index() + list_.size()}; }

 private:
  const Kernels& kernels_;
  std::shared_ptr<const NeighbourSearch> search_;
  GatheredPoints list_;
};

pcl::PointCloud<pcl::PointXYZ>::Ptr pcl_cloud(const PointCloud& cloud) {
  auto points = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (std::size_t i = 0; i < cloud.size(); ++i)
    points->emplace_back(static_cast<float>(cloud.x[i]), static_cast<float>(cloud.y[i]),
                         static_cast<float>(cloud.z[i]));
  if (cloud.image) points->width = cloud.image->camera.width, points->height = cloud.image->camera.height;
  return points;
}

// Search is OrganizedNeighbor or KdTreeFLANN.
template <class Search>
class Pcl {
 public:
  explicit Pcl(const PointCloud& cloud) { search_.setInputCloud(pcl_cloud(cloud)); }
  std::size_t find(const Ball& ball) {
    const Eigen::Vector3f c = ball.centre.cast<float>();
    return static_cast<std::size_t>(
        search_.radiusSearch({c.x(), c.y(), c.z()}, ball.radius, index_, squared_));
  }
  std::vector<std::uint32_t> found() const { return {index_.begin(), index_.end()}; }

 private:
  Search search_{false};  // unsorted
  pcl::Indices index_;
  std::vector<float> squared_;
};

class Nanoflann {
 public:
  Nanoflann(const Nanoflann&) = delete;
  Nanoflann& operator=(const Nanoflann&) = delete;
  explicit Nanoflann(const PointCloud& cloud) : points_{cloud} {
    tree_ = std::make_unique<Tree>(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(40));
    tree_->buildIndex();
  }
  std::size_t find(const Ball& ball) {
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    return tree_->radiusSearch(ball.centre.data(), ball.radius * ball.radius, found_, unsorted);
  }
  std::vector<std::uint32_t> found() const {
    std::vector<std::uint32_t> index;
    for (const auto& [i, squared] : found_) index.push_back(i);
    return index;
  }

 private:
  struct Points {
    const PointCloud& cloud;
    std::size_t kdtree_get_point_count() const { return cloud.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return axis == 0 ? cloud.x[i] : axis == 1 ? cloud.y[i] : cloud.z[i];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3,
                                                   std::uint32_t>;
  Points points_;
  std::unique_ptr<Tree> tree_;  // refers to points_
  std::vector<std::pair<std::uint32_t, double>> found_;
};

bool same(std::vector<std::uint32_t> found, const std::vector<std::uint32_t>& expected,
          const PointCloud& cloud, const Ball& ball) {
  std::sort(found.begin(), found.end());
  std::vector<std::uint32_t> different;
  std::set_symmetric_difference(found.begin(), found.end(), expected.begin(), expected.end(),
                                std::back_inserter(different));
  return std::all_of(different.begin(), different.end(), [&](std::uint32_t i) {
    return std::abs((cloud.point(i) - ball.centre).norm() - ball.radius) <= kUndecided_m;
  });
}

// make() builds the search and returns a pointer to it. Building is timed too, because every frame of a
// stream needs it again. It includes the copy of the cloud into the search's own form.
template <class Make>
void add(const std::string& peer, const naive::Queries& queries, Make make) {
  const auto search = make();
  const std::string of = "/" + queries.name + "/" + peer;
  const auto is_right = [&queries, search] {
    for (std::size_t i = 0; i < queries.balls.size(); ++i) {
      search->find(queries.balls[i]);
      if (!same(search->found(), queries.expected[i], queries.cloud, queries.balls[i])) return false;
    }
    return true;
  };
  benchmarks::add("query" + of, is_right, [&queries, search](benchmark::State& state) {
    std::size_t i = 0, found = 0;
    for (auto _ : state) {
      found += search->find(queries.balls[i]);
      benchmark::ClobberMemory();
      if (++i == queries.balls.size()) i = 0;
    }
    state.counters["found"] =
        benchmark::Counter(static_cast<double>(found), benchmark::Counter::kAvgIterations);
  });
  benchmarks::add("prepare" + of, [make](benchmark::State& state) {
    for (auto _ : state) {
      const auto made = make();
      benchmark::DoNotOptimize(made.get());
    }
  });
}

void add_all(const naive::Queries& queries) {
  const PointCloud& cloud = queries.cloud;
  for (const Isa isa : {Isa::x86_64, Isa::x86_64_v3, Isa::x86_64_v4}) {
    if (isa > best_isa()) continue;
    const Kernels& kernels = kernels_for(isa);
    add(std::string("ours/") + kernels.isa, queries,
        [&cloud, &kernels] { return std::make_shared<Ours>(cloud, kernels); });
  }
  if (cloud.image)
    add("pcl_organized_neighbor", queries,
        [&cloud] { return std::make_shared<Pcl<pcl::search::OrganizedNeighbor<pcl::PointXYZ>>>(cloud); });
  add("pcl_kdtree_flann", queries,
      [&cloud] { return std::make_shared<Pcl<pcl::KdTreeFLANN<pcl::PointXYZ>>>(cloud); });
  add("nanoflann_leaf_40", queries, [&cloud] { return std::make_shared<Nanoflann>(cloud); });
}

}  // namespace
}  // namespace remote_touch

int main(int argc, char** argv) {
  using namespace remote_touch;
  std::vector<naive::Queries> queries;
  for (const naive::Centres centres : {naive::Centres::slide, naive::Centres::jump}) {
    queries.push_back(naive::on_grid(centres));
    queries.push_back(naive::on_image("image_1.03m", naive::wave_image(1.03), centres));
  }
  for (const naive::Queries& each : queries) add_all(each);
  return benchmarks::run_benchmarks(argc, argv);
}
