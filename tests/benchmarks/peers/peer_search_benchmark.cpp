// The 1 cm radius query compared with those of PCL and nanoflann: the same wavy wall across the view of a 640
// x 480 camera, 81 points within 1 cm, the same centres 0.1 mm apart, a list of indices as the answer. Every
// search is compared with the plain loop over all points before it is timed.
#include <benchmark/benchmark.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/organized.h>

#include <cmath>
#include <memory>
#include <nanoflann.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/points/neighbour_search.h"
#include "core/points/point_cloud.h"
#include "tests/benchmarks/checked_benchmark.h"

namespace remote_touch {
namespace {

// PCL keeps points in float, so a point this near to the sphere may be on either side. nanoflann excludes the
// sphere itself. All other points must be the same.
constexpr double kUndecided_m = 1e-6;

struct Queries {
  PointCloud cloud;
  std::vector<Ball> balls = {};
};

Queries slide_over_wall() {
  constexpr double kDistance_m = 1.03, kRadius_m = 0.01;
  constexpr int kQueries = 512;
  const CameraIntrinsics camera{640, 480, 525, 525, 319.5, 239.5};
  DepthImage depth{camera.width, camera.height, {}};
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      depth.z_m.push_back(kDistance_m + 0.01 * std::sin(0.03 * u) + 0.005 * std::sin(0.05 * v));
  Queries queries{cloud_from_depth(depth, camera, RigidTransform::Identity())};
  const int row = camera.height / 3;
  double u = camera.width / 2.0;
  for (int i = 0; i < kQueries; ++i) {
    const double z = depth.z_m[static_cast<std::size_t>(row) * camera.width + std::lround(u)];
    queries.balls.push_back({unproject(camera, u, row, z), kRadius_m});
    u += 1e-4 * camera.fx / z;
  }
  return queries;
}

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

bool same(const std::vector<std::uint32_t>& found, const PointCloud& cloud, const Ball& ball) {
  const std::set<std::uint32_t> all(found.begin(), found.end());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const double outside_m = (cloud.point(i) - ball.centre).norm() - ball.radius;
    if (std::abs(outside_m) > kUndecided_m && all.contains(i) != (outside_m < 0)) return false;
  }
  return true;
}

void add(const std::string& name, const Queries& queries, const auto& search) {
  const auto is_right = [&queries, search] {
    for (const Ball& ball : queries.balls) {
      search->find(ball);
      if (!same(search->found(), queries.cloud, ball)) return false;
    }
    return true;
  };
  benchmarks::add("query/" + name, is_right, [&queries, search](benchmark::State& state) {
    std::size_t i = 0;
    for (auto _ : state) {
      search->find(queries.balls[i]);
      benchmark::ClobberMemory();
      if (++i == queries.balls.size()) i = 0;
    }
  });
}

}  // namespace
}  // namespace remote_touch

int main(int argc, char** argv) {
  using namespace remote_touch;
  const Queries queries = slide_over_wall();
  const PointCloud& cloud = queries.cloud;
  for (const Kernels* kernels : supported_kernels())
    add(std::string("ours/") + kernels->isa, queries, std::make_shared<Ours>(cloud, *kernels));
  add("pcl_organized_neighbor", queries,
      std::make_shared<Pcl<pcl::search::OrganizedNeighbor<pcl::PointXYZ>>>(cloud));
  add("pcl_kdtree_flann", queries, std::make_shared<Pcl<pcl::KdTreeFLANN<pcl::PointXYZ>>>(cloud));
  add("nanoflann_leaf_40", queries, std::make_shared<Nanoflann>(cloud));
  return benchmarks::run_benchmarks(argc, argv);
}
