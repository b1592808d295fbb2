"""The tasks of the studies with a slave. All are the experiment steer-robot with other settings; the points have no noise
unless a function says so, and the scene is the true surface at all times. The values over which the studies are drawn: delays
are those of each direction."""
import json
import math

# The settings of steer-robot, with its defaults, that derivations use. No task changes them, except that contour_task() has a
# softer contact.
MASS_KG, RADIUS_M, STIFFNESS_N_PER_M = 2, 0.005, 30000  # of the slave
HAND_MASS_KG, HAND_STIFFNESS_N_PER_M, HAND_DAMPING_NS_PER_M = 0.5, 300, 15
POINT_SPACING_M, FRAME_RATE_HZ, TICK_S = 0.0015, 30, 0.001

FREQUENCIES_HZ = (1, 2, 4, 8)
DELAYS_S = (0, 0.05, 0.1, 0.2)

APPROACH_M_PER_S, APPROACH_TO_M = 0.2, -0.02
ORGAN_M, LOWERING_M_PER_S = 0.02, 0.1
LIFT_M_PER_S2, LIFT_FROM_S, LIFT_S = 3, 1, 1 / 3
CONTOUR_STIFFNESS_N_PER_M, CONTOUR_DAMPING_NS_PER_M, CONTOUR_GAIN, CONTOUR_S = 2000, 20, 0.5, 4


def stopped_height_m(region_m):
    """The height over a flat grid of points at which the command stops: a ball with the radius region_m + r_c rests in the
    middle of four points. r_c is equal to RADIUS_M."""
    radius_m = region_m + RADIUS_M
    return math.sqrt(radius_m * radius_m - POINT_SPACING_M * POINT_SPACING_M / 2)


def task(settings, frequency_hz=2, delay_s=0, feedback="rendered", region_m=0):
    """A slave with this natural frequency, a delay of the commands and of the forces, and a forbidden region."""
    return "steer-robot", {**settings, "slave.natural_frequency_hz": text(frequency_hz), "command_link.delay_s": text(delay_s),
                           "force_link.delay_s": text(delay_s), "feedback.force": feedback, "fixtures.0.radius_m": text(region_m)}


def text(number):
    """With six digits after the point."""
    return json.loads(f"{number:.6f}")


def surface(**more):
    """A surface of 60 x 60 points around the origin."""
    return {"name": "moving-shape", "columns": 60, "rows": 60, "truth": "moving", **more}


def path(*waypoints):
    return {"name": "waypoints", "waypoints": [*map(list, waypoints)]}


def approach_task(from_m, has_mass, **remote):
    """The HIP moves straight down to a plane at rest, at APPROACH_M_PER_S from from_m above it, and stops 20 mm below it. A hand
    with mass is pushed back by the force that it feels, up to 12 N, as much as an omega.3 exerts. A hand without mass follows
    its path exactly."""
    hand = {"device.max_force_N": 12} if has_mass else {"operator": None}
    return task({"scenario": surface(), "duration_s": 2.5, **hand,
                 "trajectory": path((0, text(from_m), 0, 0), (0, APPROACH_TO_M, 0, APPROACH_M_PER_S))}, **remote)


def organ_task(shake_hz, noise_m, settings=None, **remote):
    """The hand is lowered at LOWERING_M_PER_S into a plane, which then shakes with the amplitude ORGAN_M."""
    return task({**(settings or {}), "scenario.noise_sigma_m": text(noise_m), "scenario.shake_hz": text(shake_hz)}, **remote)


def lift_task(**remote):
    """Fig 4.12 with a slave: a plane rises at 0.1 m/s under a hand at rest for 0.5 s after it has touched the proxy, and then
    accelerates for LIFT_S at 3 m/s^2."""
    scenario = {"name": "moving-lift", "columns": 60, "rows": 60, "noise_sigma_m": 0, "acceleration_m_per_s2": LIFT_M_PER_S2,
                "rise_s": LIFT_FROM_S, "truth": "moving"}
    return task({"scenario": scenario, "trajectory": path((0, 0, 0, 0)), "operator": None,
                 "duration_s": text(LIFT_FROM_S + LIFT_S)}, **remote)


def contour_task(settings, feedback="rendered", **remote):
    """A hand with mass presses into a soft surface with waves, slides along it and back, and lifts."""
    gain = {"feedback.gain": CONTOUR_GAIN} if feedback == "slave-force" else {}
    return task({"scenario": surface(shape="ripple", amplitude_m=0.003, period_m=0.03),
                 "trajectory": path((-0.03, 0.02, 0, 0), (-0.03, -0.02, 0, 0.05), (0.03, -0.02, 0, 0.05), (-0.03, -0.02, 0, 0.05),
                                    (-0.03, 0.02, 0, 0.05)),
                 "slave.steps_per_tick": 2,  # the contact is soft, and the distance from waves is slow to compute
                 "slave.contact_stiffness_N_per_m": CONTOUR_STIFFNESS_N_PER_M,
                 "slave.contact_damping_Ns_per_m": CONTOUR_DAMPING_NS_PER_M,
                 "duration_s": CONTOUR_S, **settings, **gain}, feedback=feedback, **remote)
