#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/theory/haptic_loops.h"
#include "analysis/theory/surface_contacts.h"
#include "analysis/trace/curve_fits.h"
#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"
#include "runners/interfaces/python/bindings.h"

namespace remote_touch {

// The closed forms of analysis/theory, and estimates of analysis/trace. The headers there state
// formulas and preconditions; a structure is passed by the names of its members.

namespace py = pybind11;

namespace {

void require(bool holds, const char* function, const char* expected) {
  if (!holds) throw InputError(std::string("theory.") + function, std::string("expected ") + expected);
}

template <class... Numbers>
bool finite(Numbers... numbers) {
  return (std::isfinite(numbers) && ...);
}

void bind_slaves(py::module_& theory) {
  theory.def(
      "following_error_m",
      [](double amplitude_m, double hz, double natural_frequency_hz, double age_s) {
        require(finite(amplitude_m, hz, age_s) && finite(natural_frequency_hz) && natural_frequency_hz > 0,
                "following_error_m", "finite numbers and a natural frequency above 0");
        return following_error_m({amplitude_m, hz, natural_frequency_hz, age_s});
      },
      py::kw_only(), py::arg("amplitude_m"), py::arg("hz"), py::arg("natural_frequency_hz"), py::arg("age_s"),
      "The largest distance between a shaking motion and a slave that follows it.");
  theory.def(
      "first_impact",
      [](double speed_m_per_s, double way_m, double gap_m, double natural_frequency_hz) -> py::object {
        require(finite(speed_m_per_s, way_m, gap_m, natural_frequency_hz) && speed_m_per_s > 0 &&
                    natural_frequency_hz > 0 && way_m + gap_m > 0,
                "first_impact", "finite numbers; a speed, a natural frequency and way + gap above 0");
        const auto impact = first_impact({speed_m_per_s, way_m, gap_m, natural_frequency_hz});
        if (!impact) return py::none();
        return py::make_tuple(impact->time_s, impact->speed_m_per_s);
      },
      py::kw_only(), py::arg("speed_m_per_s"), py::arg("way_m"), py::arg("gap_m"),
      py::arg("natural_frequency_hz"),
      "Time and speed at which a slave first reaches the surface; None if it never does.");
  theory.def("impact_force_N", &impact_force_N, py::kw_only(), py::arg("push_N"),
             py::arg("stiffness_N_per_m"), py::arg("mass_kg"), py::arg("speed_m_per_s"),
             "The largest force on a mass that hits a spring.");
}

template <class Of>
void def_of_wall(py::module_& theory, const char* name, Of of, const char* text) {
  const SampledWall wall;
  theory.def(
      name,
      [of, name](double mass_kg, double damping_Ns_per_m, double wall_damping_Ns_per_m, double spring_share,
                 int delay_ticks, int velocity_ticks, double tick_s) {
        require(finite(mass_kg, damping_Ns_per_m, wall_damping_Ns_per_m, spring_share, tick_s) &&
                    mass_kg > 0 && tick_s > 0 && damping_Ns_per_m + wall_damping_Ns_per_m > 0 &&
                    velocity_ticks >= 1 && velocity_ticks <= 1000 && delay_ticks >= 0 && delay_ticks <= 1000,
                name,
                "mass, tick and damping above 0, 1 to 1000 ticks of the velocity and 0 to 1000 of delay");
        return of({mass_kg, damping_Ns_per_m, wall_damping_Ns_per_m, spring_share, delay_ticks,
                   velocity_ticks, tick_s});
      },
      py::kw_only(), py::arg("mass_kg") = wall.mass_kg, py::arg("damping_Ns_per_m") = wall.damping_Ns_per_m,
      py::arg("wall_damping_Ns_per_m") = wall.wall_damping_Ns_per_m,
      py::arg("spring_share") = wall.spring_share, py::arg("delay_ticks") = wall.delay_ticks,
      py::arg("velocity_ticks") = wall.velocity_ticks, py::arg("tick_s") = wall.tick_s, text);
}

void bind_loops(py::module_& theory) {
  const PositionForceLoop loop;
  theory.def(
      "delay_onset",
      [](double mass_kg, double stiffness_N_per_m, double damping_Ns_per_m, double slave_mass_kg,
         double slave_natural_frequency_hz, double slave_damping_ratio, double environment_stiffness_N_per_m,
         double environment_damping_Ns_per_m, double feedback_gain) {
        require(finite(mass_kg, stiffness_N_per_m, damping_Ns_per_m, slave_mass_kg,
                       slave_natural_frequency_hz, slave_damping_ratio, environment_stiffness_N_per_m,
                       environment_damping_Ns_per_m, feedback_gain) &&
                    mass_kg > 0 && slave_mass_kg > 0 && slave_natural_frequency_hz > 0 &&
                    slave_damping_ratio > 0,
                "delay_onset", "finite numbers; masses, natural frequency and damping ratio above 0");
        const DelayOnset onset =
            delay_onset({mass_kg, stiffness_N_per_m, damping_Ns_per_m, slave_mass_kg,
                         slave_natural_frequency_hz, slave_damping_ratio, environment_stiffness_N_per_m,
                         environment_damping_Ns_per_m, feedback_gain});
        return py::make_tuple(onset.round_trip_s, onset.frequency_hz);
      },
      py::kw_only(), py::arg("mass_kg") = loop.mass_kg, py::arg("stiffness_N_per_m") = loop.stiffness_N_per_m,
      py::arg("damping_Ns_per_m") = loop.damping_Ns_per_m, py::arg("slave_mass_kg") = loop.slave_mass_kg,
      py::arg("slave_natural_frequency_hz") = loop.slave_natural_frequency_hz,
      py::arg("slave_damping_ratio") = loop.slave_damping_ratio,
      py::arg("environment_stiffness_N_per_m") = loop.environment_stiffness_N_per_m,
      py::arg("environment_damping_Ns_per_m") = loop.environment_damping_Ns_per_m,
      py::arg("feedback_gain") = loop.feedback_gain,
      "The least round trip (s) for which a position-force loop is not stable, and the frequency (Hz) there.");
  theory.def("held_round_trip", &held_round_trip, py::arg("round_trip_s"), py::arg("tick_s"),
             py::arg("holds"), "The round trip without holds that has the same phase.");
  def_of_wall(theory, "wall_law_N_per_m", &wall_law_N_per_m,
              "The largest stable stiffness of a sampled wall for slow oscillations.");
  def_of_wall(theory, "exact_wall_limit_N_per_m", &exact_wall_limit_N_per_m,
              "The smallest stiffness of a sampled wall at which an oscillation grows.");
}

py::tuple as_tuple(const RestingWrench& wrench) {
  return py::make_tuple(wrench.force_N, wrench.torque_Nm);
}

void bind_tools(py::module_& theory) {
  const EvenSpring spring;
  const auto stiffness = py::arg("stiffness_N_per_m") = spring.stiffness_N_per_m;
  const auto radius = py::arg("gyration_radius_m") = spring.gyration_radius_m;
  theory.def(
      "block_on_line",
      [](double a_m, double b_m, double height_m, double angle_rad, double k, double r) {
        require(finite(a_m, b_m, height_m, angle_rad, k, r), "block_on_line", "finite numbers");
        return as_tuple(block_on_line(a_m, b_m, {k, r}, height_m, angle_rad));
      },
      py::arg("a_m"), py::arg("b_m"), py::arg("height_m"), py::arg("angle_rad"), stiffness, radius,
      "Force (x, y in N) and torque (N m) on the hand that holds a block on a line.");
  theory.def(
      "ball_in_groove",
      [](double radius_m, double slope_rad, const Eigen::Vector2d& place_m, double k, double r) {
        require(finite(radius_m, slope_rad, place_m.x(), place_m.y(), k, r), "ball_in_groove",
                "finite numbers");
        return as_tuple(ball_in_groove(radius_m, slope_rad, {k, r}, place_m));
      },
      py::arg("radius_m"), py::arg("slope_rad"), py::arg("place_m"), stiffness, radius,
      "Force and torque on the hand that holds a ball in a groove.");
  theory.def(
      "bar_in_slot",
      [](double a_m, double b_m, double w_m, double angle_rad, double k, double r) {
        require(finite(a_m, b_m, w_m, angle_rad, k, r), "bar_in_slot", "finite numbers");
        return as_tuple(bar_in_slot(a_m, b_m, w_m, {k, r}, angle_rad));
      },
      py::arg("a_m"), py::arg("b_m"), py::arg("w_m"), py::arg("angle_rad"), stiffness, radius,
      "Force and torque on the hand that turns a bar in a slot.");
  const auto under = [](const UnderPlate& plate) { return py::make_tuple(plate.drop_m, plate.rise_m); };
  theory.def(
      "under_edge",
      [under](double slope_rad, double half_m, double turn_rad) {
        return under(under_edge(slope_rad, half_m, turn_rad));
      },
      py::arg("slope_rad"), py::arg("half_m"), py::arg("turn_rad") = 0.0,
      "Drop and rise (m) of an edge under a plate.");
  theory.def(
      "under_corner",
      [under](double slope_rad, double half_m) { return under(under_corner(slope_rad, half_m)); },
      py::arg("slope_rad"), py::arg("half_m"), "Drop and rise (m) of a corner under a plate.");
  theory.def(
      "under_ball", [under](double radius_m, double seen_m) { return under(under_ball(radius_m, seen_m)); },
      py::arg("radius_m"), py::arg("seen_m"), "Drop and rise (m) of a ball under a plate.");
  theory.def(
      "noisy_jump_m",
      [](double thickness_m, const std::vector<std::pair<double, double>>& points, double sigma_m) {
        require(!points.empty() && finite(thickness_m, sigma_m), "noisy_jump_m",
                "finite numbers and a point");
        std::vector<NoisyPoint> noisy;
        for (const auto& [height_m, probability] : points) noisy.push_back({height_m, probability});
        return noisy_jump_m(thickness_m, noisy, sigma_m);
      },
      py::arg("thickness_m"), py::arg("points"), py::arg("sigma_m"),
      "The jump after which a plate is lost with probability 1/2. points: (height, probability of being "
      "under the plate).");
}

void bind_bounds(py::module_& theory) {
  theory.def(
      "critical_acceleration",
      [](double r1_m, double frame_rate_hz) {
        return critical_acceleration({r1_m, frame_rate_hz, 0, 1});
      },
      py::arg("r1_m"), py::arg("frame_rate_hz"), "(4.14): r_1 f_c^2, m/s^2.");
  theory.def(
      "bound_acceleration",
      [](double r1_m, double hz, double v0, int updates, double thickness_m, double normal_error) {
        return bound_acceleration({r1_m, hz, v0, updates}, thickness_m, normal_error);
      },
      py::kw_only(), py::arg("r1_m"), py::arg("frame_rate_hz"), py::arg("start_velocity_m_per_s"),
      py::arg("updates"), py::arg("thickness_m"), py::arg("normal_error"), "(4.25) solved for a, m/s^2.");
}

py::tuple as_tuple(const Estimate& estimate) {
  return py::make_tuple(estimate.value, estimate.low, estimate.high);
}

void bind_estimates(py::module_& theory) {
  theory.def(
      "estimated_mean", [](const std::vector<double>& numbers) { return as_tuple(estimated_mean(numbers)); },
      py::arg("numbers"), "Mean and its 95 % interval: value, low, high.");
  theory.def(
      "estimated_fraction",
      [](std::int64_t events, std::int64_t without, std::int64_t unknown) {
        require(events >= 0 && without >= 0 && unknown >= 0, "estimated_fraction", "counts of 0 or more");
        return as_tuple(estimated_fraction(EventCounts{events, without, unknown}));
      },
      py::arg("events"), py::arg("without"), py::arg("unknown") = 0,
      "Fraction of runs with an event and its 95 % interval: value, low, high.");
  theory.def(
      "exact_interval",
      [](double events, double runs) {
        require(finite(runs) && events >= 0 && events <= runs, "exact_interval", "0 <= events <= runs");
        return exact_interval(events, runs);
      },
      py::arg("events"), py::arg("runs"), "The exact 95 % interval of a fraction.");
  theory.def(
      "fit_polynomial",
      [](const std::vector<double>& x, const std::vector<double>& y, const std::vector<int>& powers) {
        require(x.size() == y.size() && x.size() > powers.size() && !powers.empty() &&
                    *std::min_element(powers.begin(), powers.end()) >= 0,
                "fit_polynomial", "as many x as y, fewer powers than these, and powers of 0 or more");
        return fit_polynomial(x, y, powers).coefficients;
      },
      py::arg("x"), py::arg("y"), py::arg("powers"),
      "The coefficients of a sum of these powers of x, by least squares.");
  theory.def(
      "sinusoid_in",
      [](const std::vector<double>& time_s, const std::vector<double>& values, double hz) {
        require(time_s.size() == values.size(), "sinusoid_in", "as many times as values");
        const Sinusoid wave = sinusoid_in(time_s, values, hz);
        return py::make_tuple(wave.amplitude, wave.phase_rad);
      },
      py::arg("time_s"), py::arg("values"), py::arg("hz"), "Amplitude and phase (rad) of a frequency.");
}

}  // namespace

void bind_theory(py::module_& module) {
  py::module_ theory = module.def_submodule("theory", "Closed forms and estimates.");
  bind_slaves(theory);
  bind_loops(theory);
  bind_tools(theory);
  bind_bounds(theory);
  bind_estimates(theory);
}

}  // namespace remote_touch
