"""Fig 4.12 with a slave: the surface rises, the command follows it from frame to frame, and the surface pushes the slave,
whose command is late."""
import sys

import numpy as np
from slave_tasks import DELAYS_S, FRAME_RATE_HZ, FREQUENCIES_HZ, LIFT_FROM_S, LIFT_M_PER_S2, MASS_KG, RADIUS_M, STIFFNESS_N_PER_M, \
    TICK_S, lift_task, stopped_height_m

from remote_touch.studies import dashed, dots, line, main, study

FRAME_S = 1 / FRAME_RATE_HZ
LIFT_END_S = 0.2  # the end of the run, in which the plane accelerates


def plane_m(run, time_s):
    """The height of the true plane, from the proxy over it; after the run: at its end."""
    return np.interp(time_s / TICK_S, np.arange(len(run)), run.proxy_position[:, 1] - run.signed_distance)


def derived_force_N(run, cell):
    """The mean force f on a slave that stays on the plane y while its command shows the plane as it was t_d before, y_d; t_d is
    the delay and half a frame interval. The momentum in the window gives m y'' = f + m w^2 (y_d - x) + 2 m w (y_d' - y'). The
    contact is a spring as well, so x = y - f / K."""
    w, end_s = 2 * np.pi * cell.frequency, run.time[-1]
    begin_s, late_s = end_s - LIFT_END_S, cell.delay + FRAME_S / 2
    times, t = [], begin_s
    while t < end_s:
        times.append(t)
        t += TICK_S
    times = np.array(times)
    ahead_m = np.mean(plane_m(run, times) - plane_m(run, times - late_s))
    rises_m = [plane_m(run, start_s + LIFT_END_S) - plane_m(run, start_s) for start_s in (begin_s, begin_s - late_s)]
    acceleration = LIFT_M_PER_S2 + w * w * ahead_m + 2 * w * (rises_m[0] - rises_m[1]) / LIFT_END_S
    return MASS_KG * acceleration / (1 + MASS_KG * w * w / STIFFNESS_N_PER_M)


def mean_force_N(run):
    return run.slave_force[run.time > run.time[-1] - LIFT_END_S, 1].mean()


def command_error_m(run):
    """The largest distance of the command, just before each update, from where it rests on the plane of the newest frame."""
    before = run.frame_updates() - 1
    before = before[run.time[before] > LIFT_FROM_S]
    seen_m = plane_m(run, run.frame_index[before] * FRAME_S)
    return np.abs(run.slave_command[before, 1] - seen_m - stopped_height_m(0)).max()


@study("slave-lift", "Fig 4.12 with a slave: the force of a rising surface on a slave that is late",
       title="A surface that rises under a slave", source="the theory of a linear slave", caption="""
       Fig 4.12 with a slave and without noise: a plane rises at 0.1 m/s under a hand at rest and accelerates with 3 m/s^2 from 1 s
       on. The commanded position follows the plane from frame to frame. The upper panel shows plane, command and slave in one run.
       The lower panel shows the mean force of the plane on the slave, measured (dots) and derived from momentum (lines).
       Simulated.""")
def slave_lift(s):
    lifts = s.grid({"frequency": FREQUENCIES_HZ, "delay": DELAYS_S},
                   lambda cell: lift_task(frequency_hz=cell.frequency, delay_s=cell.delay),
                   {"force": mean_force_N, "derived": derived_force_N, "error": command_error_m,
                    "peak": lambda run: run.measures["max_slave_force"]})
    draw_course(s)
    draw_forces(s, lifts)
    claims = s.claims("a surface that rises under a slave: ")
    claims.at_most("the command rests on the plane of the newest frame before each update: largest distance from it",
                   lifts.error.max(), 0.0002, "m")
    claims.at_most("the mean force is that on a slave that stays on the plane while its command is late by the delay and half a "
                   "frame interval: largest relative difference", np.abs(lifts.force / lifts.derived - 1).max(), 0.15, "fraction")
    claims.at_least("a delay of 0.1 s at least doubles the mean force at every natural frequency: smallest ratio",
                    (lifts.where(delay=0.1).force / lifts.where(delay=0).force).min(), 2, "1")


def draw_course(s):
    run = s.run(*lift_task(frequency_hz=2, delay_s=0.1))
    s.table("course", "a slave of 2 Hz, 0.1 s late",
            time=(run.time[400:], "s", "time"),
            plane=(plane_m(run, run.time)[400:], "m", "height of the true plane"),
            command=(run.slave_command[400:, 1] - RADIUS_M, "m", "height of the lower end of the commanded ball"),
            slave=(run.slave_position[400:, 1] - RADIUS_M, "m", "height of the lower end of the slave's ball"),
            force=(run.slave_force[400:, 1], "N", "force of the plane on the slave"))
    s.panel("2 Hz, 0.1 s: lower end of the ball", "time (s)", "y (m)",
            [dashed("course", "time", "plane", "true plane"), line("course", "time", "command", "command"),
             line("course", "time", "slave", "slave")])


def draw_forces(s, lifts):
    curves = []
    for hz in FREQUENCIES_HZ:
        rows, name = lifts.where(frequency=hz), f"force_{hz}_hz"
        s.table(name, f"a slave of {hz} Hz",
                delay=(rows.delay, "s", "delay of the commands"),
                force=(rows.force, "N", "mean force on the slave in the last 0.2 s"),
                derived=(rows.derived, "N", "derived mean force"),
                peak=(rows.peak, "N", "largest force on the slave"))
        curves += [line(name, "delay", "derived", f"{hz} Hz, derived"), dots(name, "delay", "force", f"{hz} Hz")]
    s.panel("Mean force of the last 0.2 s", "delay of the commands (s)", "force (N)", curves)


if __name__ == "__main__":
    sys.exit(main())
