// NumPy files are read exactly, in each type and order; damaged ones are refused.
#include "scenarios/recordings/images_and_clouds/depth_npy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::depth_npy_test {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

std::string npy(const std::string& dictionary, const std::string& data, int version = 1) {
  std::string file = "\x93NUMPY" + std::string(1, static_cast<char>(version)) + '\0';
  const std::string header = dictionary + std::string(20, ' ') + "\n";
  file += version == 1 ? raw(static_cast<std::uint16_t>(header.size()))
                       : raw(static_cast<std::uint32_t>(header.size()));
  return file + header + data;
}
std::string header(const std::string& type, const std::string& shape, const std::string& fortran = "False") {
  return "{'descr': '" + type + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
}
template <class Value>
std::string data(const std::vector<double>& values, bool is_big_endian = false) {
  std::string bytes;
  for (const double value : values) {
    std::string one = raw(static_cast<Value>(value));
    if (is_big_endian) std::reverse(one.begin(), one.end());
    bytes += one;
  }
  return bytes;
}

class DepthNpy : public ::testing::Test {
 protected:
  DepthImage read(const std::string& bytes, double unit_m = 1, double max_depth_m = kNoLimit) const {
    return read_depth_npy(folder_.write("d.npy", bytes), unit_m, max_depth_m);
  }
  std::string refused(const std::string& bytes) const {
    return refusal([&] { read(bytes); });
  }
  const TestFolder folder_{"depth_npy_test"};
};

TEST_F(DepthNpy, IsReadExactlyInEachTypeAndOrder) {
  const std::vector<double> rows{0.5, 1.25, 3, 7, 1024.5, 65000}, columns{0.5, 7, 1.25, 1024.5, 3, 65000};
  const auto expect = [&](const std::string& bytes) {
    const DepthImage depth = read(bytes);
    EXPECT_EQ(depth.width, 3);
    EXPECT_EQ(depth.height, 2);
    EXPECT_EQ(depth.z_m, rows);
  };
  expect(npy(header("<f4", "(2, 3)"), data<float>(rows)));
  expect(npy(header("<f8", "(2, 3)"), data<double>(rows), 2));
  expect(npy(header(">f4", "(2, 3)"), data<float>(rows, true), 3));
  expect(npy(header("<f8", "(2, 3)", "True"), data<double>(columns)));
  expect(npy("{'shape': (2, 3), 'fortran_order': False, 'descr': '>f8'}", data<double>(rows, true)));
  const DepthImage integers = read(npy(header("<u2", "(1, 2)"), data<std::uint16_t>({1, 65534})), 0.001);
  EXPECT_EQ(integers.z_m, (std::vector<double>{0.001, 65534 * 0.001}));
  const double third = 1.0 / 3;
  EXPECT_EQ(read(npy(header("<f8", "(1, 1)"), data<double>({third}))).z_m[0], third);
  EXPECT_EQ(read(npy(header("<f4", "(1, 1)"), data<float>({third}))).z_m[0],
            static_cast<double>(static_cast<float>(third)));
}

TEST_F(DepthNpy, NoMeasurementAndTooFarAreNaN) {
  const DepthImage depth =
      read(npy(header("<f4", "(1, 6)"), data<float>({0, std::nan(""), kNoLimit, -kNoLimit, 3, 3.5})), 1, 3);
  for (const std::size_t i : {0, 1, 2, 3, 5}) EXPECT_TRUE(std::isnan(depth.z_m[i])) << i;
  EXPECT_EQ(depth.z_m[4], 3);
  const std::string largest = data<std::uint16_t>({65535});
  EXPECT_TRUE(std::isnan(read(npy(header("<u2", "(1, 1)"), largest)).z_m[0]));
  EXPECT_EQ(read(npy(header("<f8", "(1, 1)"), data<double>({65535}))).z_m[0], 65535);
}

TEST_F(DepthNpy, RefusesWhatIsNoDepthImage) {
  const std::string four = data<float>({1, 1, 1, 1});
  EXPECT_HAS(refused("P5 2 2"), "d.npy: does not begin as a NumPy file");
  EXPECT_HAS(refused(npy(header("<f4", "(4,)"), four)), "has the shape \"(4,)\": expected (height, width)");
  EXPECT_HAS(refused(npy(header("<f4", "(2, 2, 1)"), four)), "has the shape \"(2,2,1)\"");
  EXPECT_HAS(refused(npy(header("<f4", "(0, 2)"), "")), "has the shape \"(0,2)\"");
  EXPECT_HAS(refused(npy(header("<f2", "(2, 2)"), four)), "has values of type \"<f2\": expected float32");
  EXPECT_HAS(refused(npy(header("|O", "(2, 2)"), four)), "has values of type");
  EXPECT_HAS(refused(npy(header("<f4", "(2, 2)"), four.substr(1))), "has 15 bytes of data: expected 16");
  EXPECT_HAS(refused(npy(header("<f4", "(2, 2)"), four + "x")), "has 17 bytes of data: expected 16");
  EXPECT_HAS(refused(npy(header("<f4", "(65535, 65535)"), four)), "pixels: expected at most");
  EXPECT_HAS(refused(npy(header("<f4", "(1, 2)"), data<float>({1, -2}))), "pixel 1, 0 has the depth -2");
  const std::string whole = npy(header("<f4", "(2, 2)"), four);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_HAS(refused(whole.substr(0, size)), "d.npy: ");
}

// The point at the distance is where the ray of the pixel meets a ball around the camera.
TEST_F(DepthNpy, DistancesBecomeDepths) {
  const CameraIntrinsics camera{64, 48, 50, 55, 30.5, 25};
  DepthImage image{64, 48, std::vector<double>(camera.pixels(), 2.5)};
  image.z_m[7] = std::nan("");
  distances_to_depths(camera, image);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      const double z_m = image.z_m[static_cast<std::size_t>(v * 64 + u)];
      if (v == 0 && u == 7)
        EXPECT_TRUE(std::isnan(z_m));
      else
        EXPECT_NEAR(unproject(camera, u, v, z_m).norm(), 2.5, 1e-14);
    }
}

}  // namespace
}  // namespace remote_touch::depth_npy_test
