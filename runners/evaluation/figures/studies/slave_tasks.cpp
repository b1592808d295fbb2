#include "runners/evaluation/figures/studies/slave_tasks.h"

#include <cmath>

namespace remote_touch {

namespace {

std::string number(double value) {
  return std::to_string(value);
}

// A surface of 60 x 60 points around the origin.
std::string surface(const std::string& more) {
  return R"(scenario={"name": "moving-shape", "columns": 60, "rows": 60, "truth": "moving")" + more + "}";
}

std::string path(const std::string& waypoints) {
  return R"(trajectory={"name": "waypoints", "waypoints": [)" + waypoints + "]}";
}

Experiment task(const RemoteSide& remote, const std::vector<std::string>& settings) {
  std::vector<std::string> all = settings;
  all.push_back("slave.natural_frequency_hz=" + number(remote.frequency_hz));
  for (const char* link : {"command_link", "force_link"})
    all.push_back(std::string(link) + ".delay_s=" + number(remote.delay_s));
  all.push_back("feedback.force=" + remote.feedback);
  all.push_back("fixtures.0.radius_m=" + number(remote.region_m));
  return Experiment::load("steer-robot", all);
}

}  // namespace

double stopped_height_m(double region_m) {
  const double radius_m = region_m + kSlaveRadius_m;
  return std::sqrt(radius_m * radius_m - kPointSpacing_m * kPointSpacing_m / 2);
}

Experiment approach_task(const RemoteSide& remote, double from_m, bool has_mass) {
  std::vector<std::string> settings = {
      surface(""),
      path("[0, " + number(from_m) + ", 0, 0], [0, " + number(kApproachTo_m) + ", 0, " +
           number(kApproach_m_per_s) + "]"),
      "duration_s=2.5"};
  settings.push_back(has_mass ? "device.max_force_N=12" : "operator=null");
  return task(remote, settings);
}

Experiment organ_task(const RemoteSide& remote, double shake_hz, double noise_m,
                      std::vector<std::string> settings) {
  settings.push_back("scenario.noise_sigma_m=" + number(noise_m));
  settings.push_back("scenario.shake_hz=" + number(shake_hz));
  return task(remote, settings);
}

Experiment lift_task(const RemoteSide& remote) {
  return task(remote, {R"(scenario={"name": "moving-lift", "columns": 60, "rows": 60, "noise_sigma_m": 0,)"
                       R"("acceleration_m_per_s2": )" +
                           number(kLift_m_per_s2) + R"(, "rise_s": )" + number(kLiftFrom_s) +
                           R"(, "truth": "moving"})",
                       path("[0, 0, 0, 0]"), "operator=null", "duration_s=" + number(kLiftFrom_s + kLift_s)});
}

Experiment contour_task(const RemoteSide& remote, const std::vector<std::string>& settings) {
  std::vector<std::string> all = {
      surface(R"(, "shape": "ripple", "amplitude_m": 0.003, "period_m": 0.03)"),
      path("[-0.03, 0.02, 0, 0], [-0.03, -0.02, 0, 0.05], [0.03, -0.02, 0, 0.05], [-0.03, -0.02, 0, 0.05], "
           "[-0.03, 0.02, 0, 0.05]"),
      "slave.steps_per_tick=2",  // the contact is soft, and the distance from waves is slow to compute
      "slave.contact_stiffness_N_per_m=" + number(kContourStiffness_N_per_m),
      "slave.contact_damping_Ns_per_m=" + number(kContourDamping_Ns_per_m),
      "duration_s=" + number(kContour_s)};
  all.insert(all.end(), settings.begin(), settings.end());
  if (remote.feedback == "slave-force") all.push_back("feedback.gain=" + number(kContourGain));
  return task(remote, all);
}

}  // namespace remote_touch
