// Model of a colour and depth camera in turbid water: colours fade into a veil of scattered light, and depth
// becomes noisier or is lost. The rates describe the trend, not one particular water.
#pragma once

#include <array>
#include <cstdint>

namespace remote_touch {

// exp(-x) for x >= 0, with a relative error below 1e-12; 0 from 64 on. Computed by products, so that the bits
// do not depend on which exponential the C library picks for a machine.
double decay(double x);

// Distances are metres of water between the camera and the object; infinite if the pixel shows no object. The
// model neglects blur and the path of the light to the objects.
class Water {
 public:
  // Attenuation beta per metre, 0 for clear water. Red is lost fastest, blue slowest.
  explicit Water(double turbidity_per_m) : turbidity_per_m_(turbidity_per_m) {}

  static constexpr double kAttenuation[3] = {1.3, 0.95, 0.8};  // factors on beta for red, green and blue
  static constexpr double kVeil[3] = {13, 31, 28};             // a dark bluish green; 0 to 255

  // Colour through the water, as channels from 0 to 255. A channel c of rgb, 0xRRGGBB, becomes
  // c exp(-beta_c d) + veil_c (1 - exp(-beta_c d)).
  std::array<double, 3> seen(std::uint32_t rgb, double distance_m) const;

  // Probability that a pixel has no depth, 1 - (1 - dropout) exp(-beta d / 4), with dropout the probability
  // in clear water.
  double lost(double dropout_probability, double distance_m) const;
  // Factor on the standard deviation of depth, 1 + beta d, because the sensor's light pattern returns
  // fainter.
  double depth_noise_factor(double distance_m) const;

 private:
  const double turbidity_per_m_;
};

}  // namespace remote_touch
