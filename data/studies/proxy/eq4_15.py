"""Equation (4.15): the force between the updates of a cloud that moves at a constant velocity, for the three readings of its
sign."""
import sys

import numpy as np

from remote_touch.studies import line, main, study

VELOCITY_M_PER_S = 0.1
SETTLED_FROM_S = 1  # the velocity estimate has settled
READINGS = {"plus": "plus (as printed)", "none": "no term", "minus": "minus (used)"}

# The plane jumps by v / f_c, and in the same tick the HIP follows it by v / f_h. The printed sign doubles the jump.
JUMP_N = 600 * VELOCITY_M_PER_S * (1 / 30 - 1 / 1000)
ROUNDING_N = 1e-6

RISE = {"title": "a noise-free plane rises at 0.1 m/s under a HIP that keeps its depth",
        "scenario": {"name": "moving-lift", "noise_sigma_m": 0, "rise_s": 2, "acceleration_s": 0},
        "renderer": {"name": "proxy"},
        "trajectory": {"name": "press", "press_at_s": 0.5, "depth_m": 0.03, "surface": "moving"},
        "duration_s": 1.9}
# (4.13) sets a negative estimate to 0, "since there is no risk for pop through", so (4.15) has no term here.
FALL = {"title": "a noise-free plane recedes at 0.1 m/s from a HIP that keeps its depth",
        "scenario": {"name": "moving-lift", "noise_sigma_m": 0, "wait_s": 0.2, "start_depth_m": 0,
                     "start_velocity_m_per_s": -VELOCITY_M_PER_S, "rise_s": 2, "acceleration_s": 0},
        "renderer": {"name": "proxy"},
        "trajectory": {"name": "press", "start_m": [0, 0.02, 0], "press_at_s": 0.1, "depth_m": 0.03, "surface": "moving"},
        "duration_s": 1.9}


def jump_N(run):
    """The largest change of the force at a frame."""
    updates = run.frame_updates()
    updates = updates[run.time[updates - 1] >= SETTLED_FROM_S]
    return np.linalg.norm(run.force[updates] - run.force[updates - 1], axis=1).max()


@study("eq4.15", "force between updates of a moving cloud: the sign in equation (4.15)", title="Force between updates", caption="""
       A noise-free plane rises at 0.1 m/s under a HIP that keeps its depth, so the true force is constant. The velocity term of
       (4.15) as printed (plus), left out (none), and with the sign that removes the jump (minus).""")
def eq4_15(s):
    *rises, fall = s.runs([*((RISE, {"renderer.velocity_force": sign}) for sign in READINGS), FALL])
    for sign, run in zip(READINGS, rises):
        settled = run.time >= SETTLED_FROM_S
        s.table(sign, f"force with the term {sign}", time=(run.time[settled], "s", "simulated time"),
                force=(run.norm("force")[settled], "N", "magnitude of the force"))
    s.panel("A plane that rises at 0.1 m/s", "time (s)", "force (N)",
            [line(sign, "time", "force", label) for sign, label in READINGS.items()], x_range=(1, 1.1))  # three frames

    plus, none, minus = map(jump_N, rises)
    claims = s.claims()
    claims.at_most("with the minus sign the force does not jump at the frames of a surface that rises at 0.1 m/s: jump",
                   minus, ROUNDING_N, "N", "smooth")
    claims.differs("with the printed plus sign the force jumps at the frames of a surface that rises at 0.1 m/s: jump",
                   plus, 2 * JUMP_N - ROUNDING_N, 2 * JUMP_N + ROUNDING_N, "N", "smooth")
    claims.between("without the velocity term the force jumps at the frames of a surface that rises at 0.1 m/s: jump",
                   none, JUMP_N - ROUNDING_N, JUMP_N + ROUNDING_N, "N")
    claims.differs("with the minus sign the force jumps at the frames of a surface that recedes, because v_hat is never below 0 "
                   "(4.13): jump", jump_N(fall), JUMP_N - ROUNDING_N, JUMP_N + ROUNDING_N, "N", "smooth")


if __name__ == "__main__":
    sys.exit(main())
