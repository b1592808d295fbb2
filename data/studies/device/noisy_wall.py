"""The largest stiffness at which a hand that rests on a plane with noise stays calm.

A hand without damping rests 2.4 mm deep on a plane that a proxy renders at 30 Hz from noisy points, on a device with the damping
b. The noise moves the rendered plane in every frame, so the hand always moves, and no oscillation grows for ever below the limit
K* = b / (T / 2) of a linear wall. The limit here is the largest stiffness at which the motion of the hand is calm: not more than
CALM_M in root mean square, a sixth of the depth, so that the contact hardly ever opens.

Theory: the height of the rendered plane has the standard deviation s and a new value in every frame interval D, and the spring
of the hand has a quarter of the stiffness K. So the hand of mass m has the natural frequency w = sqrt(1.25 K / m) and the damping
b (1 - K / K*), because the hold feeds it. A weakly damped oscillator that is driven by K times these steps has the variance
    s^2 K D q^2 / (2.5 b (1 - K / K*)), q = sin(w D / 2) / (w D / 2).
"""
import numpy as np
from wall_limit import HALVINGS, bisected, wall_task

from remote_touch import theory
from remote_touch.studies import Rows

CALM_M = 4e-4
DAMPING_NS_PER_M, MASS_KG, FRAME_S = 2, 0.3, 1 / 30
LAW_N_PER_M = theory.wall_law_N_per_m(mass_kg=MASS_KG, damping_Ns_per_m=DAMPING_NS_PER_M)  # K*
AT_REST_S = 1.6  # the hand rests from here on
SOFT_N_PER_M = 200
SEEDS = range(1, 5)


def task(noise_m, stiffness_N_per_m, seed):
    """A proxy that does not estimate a velocity moves only when a frame arrives."""
    return wall_task(stiffness_N_per_m, {
        "scenario": {"name": "moving-shape", "columns": 60, "rows": 60, "rise_s": 7.9}, "scenario.noise_sigma_m": noise_m,
        "renderer.velocity_estimate": False, "operator.mass_kg": MASS_KG, "device.damping_Ns_per_m": DAMPING_NS_PER_M,
        "duration_s": 8, "seed": seed})


def hand_m2(run):
    """Variance of the height of the hand at rest."""
    return np.var(run.hip_position[run.time >= AT_REST_S, 1], ddof=1)


def plane_m2(run):
    """Variance of the height of the plane, which is where the force would be zero."""
    return np.var((run.hip_position[:, 1] + run.force[:, 1] / SOFT_N_PER_M)[run.time >= AT_REST_S], ddof=1)


def mean_variances(s, noise_m, stiffness_N_per_m, variance):
    """The mean over the seeds for each noise."""
    jobs = [task(*case, seed) for case in zip(noise_m, stiffness_N_per_m) for seed in SEEDS]
    return np.reshape(s.measure(jobs, variance), (-1, len(SEEDS))).mean(axis=1)


def expected_m2(plane_noise_m, stiffness_N_per_m):
    half = np.sqrt(1.25 * stiffness_N_per_m / MASS_KG) * FRAME_S / 2
    damping = DAMPING_NS_PER_M * (1 - stiffness_N_per_m / LAW_N_PER_M)
    return plane_noise_m ** 2 * stiffness_N_per_m * FRAME_S * (np.sin(half) / half) ** 2 / (2.5 * damping)


def noisy_walls(s, noise_m):
    """Rows with the noise of the points along their rays, that of the plane, and the limit by theory and by bisection: it is known
    to 1.4 %, but for the chance of the noise."""
    plane_noise_m = np.sqrt(mean_variances(s, noise_m, np.full(len(noise_m), SOFT_N_PER_M), plane_m2))
    expected = bisected(np.ones(len(noise_m)), LAW_N_PER_M, 40, lambda values: expected_m2(plane_noise_m, values) > CALM_M ** 2)
    stiffness = bisected(0.4 * expected, 2.5 * expected, HALVINGS,
                         lambda values: mean_variances(s, noise_m, values, hand_m2) > CALM_M ** 2)
    return Rows(noise=noise_m, plane_noise=plane_noise_m, stiffness=stiffness, expected=expected)
