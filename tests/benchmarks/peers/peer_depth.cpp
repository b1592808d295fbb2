#include "tests/benchmarks/peers/peer_depth.h"

#include <pcl/features/integral_image_normal.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/organized.h>

#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/rgbd.hpp>

namespace remote_touch::peers {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

Points::Ptr pcl_points(const OrganisedPoints& from) {
  auto points = std::make_shared<Points>();
  for (std::size_t i = 0; i + 2 < from.xyz.size(); i += 3)
    points->emplace_back(from.xyz[i], from.xyz[i + 1], from.xyz[i + 2]);
  points->width = static_cast<std::uint32_t>(from.width),
  points->height = static_cast<std::uint32_t>(from.height);
  return points;
}

std::vector<float> numbers(const Normals& normals) {
  std::vector<float> all;
  for (const pcl::Normal& n : normals) all.insert(all.end(), {n.normal_x, n.normal_y, n.normal_z});
  return all;
}

using Integral = pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal>;

// The smoothing over 10 pixels and 0.02 is that of PCL's own example.
Peer integral_image(const Points::Ptr& points) {
  const auto normals = std::make_shared<Normals>();
  return {"pcl_covariance",
          [=] {
            Integral estimation;
            estimation.setNormalEstimationMethod(Integral::COVARIANCE_MATRIX);
            estimation.setMaxDepthChangeFactor(0.02f);
            estimation.setNormalSmoothingSize(10.0f);
            estimation.setInputCloud(points);
            estimation.compute(*normals);
          },
          [=] { return numbers(*normals); }};
}

// The radius of 8.5 mm holds about 81 points, as many as a window of 9 x 9 pixels at 0.8 m.
Peer organised_search(const Points::Ptr& points) {
  const auto normals = std::make_shared<Normals>();
  return {
      "pcl_normal_estimation_omp",
      [=] {
        pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(1);
        estimation.setSearchMethod(std::make_shared<pcl::search::OrganizedNeighbor<pcl::PointXYZ>>(false));
        estimation.setRadiusSearch(0.0085);
        estimation.setInputCloud(points);
        estimation.compute(*normals);
      },
      [=] { return numbers(*normals); }};
}

cv::Mat cv_points(const OrganisedPoints& from) {
  return cv::Mat(from.height, from.width, CV_32FC3, const_cast<float*>(from.xyz.data())).clone();
}

std::vector<float> numbers(const cv::Mat& image) {
  return {image.ptr<float>(), image.ptr<float>() + image.total() * 3};
}

// The estimation makes its tables for the camera before it is timed.
Peer fals(int window, const OrganisedPoints& from) {
  const cv::Mat camera = (cv::Mat_<float>(3, 3) << from.focal, 0, from.cx, 0, from.focal, from.cy, 0, 0, 1);
  const auto estimation = std::make_shared<cv::rgbd::RgbdNormals>(
      from.height, from.width, CV_32F, camera, window, cv::rgbd::RgbdNormals::RGBD_NORMALS_METHOD_FALS);
  estimation->initialize();
  const auto normals = std::make_shared<cv::Mat>();
  const cv::Mat points = cv_points(from);
  return {"opencv_fals_" + std::to_string(window), [=] { (*estimation)(points, *normals); },
          [=] { return numbers(*normals); }};
}

}  // namespace

std::vector<Peer> normals_of_others(const OrganisedPoints& from) {
  cv::setNumThreads(1);
  const Points::Ptr points = pcl_points(from);
  return {integral_image(points), organised_search(points), fals(5, from), fals(7, from)};
}

}  // namespace remote_touch::peers
