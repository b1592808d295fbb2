"""A slow slave behind a delay over an organ that moves: which radius of a forbidden region keeps it from touching, and how hard it
touches without a region. Chapter 8 asks this and does not measure it."""
import math
import sys

import numpy as np

from remote_touch import theory
from remote_touch.studies import band, dots, line, main, study

AMPLITUDE_M, SHAKE_HZ, FRAME_RATE_HZ, TICK_S = 0.02, 0.5, 30, 0.001  # settings of the experiment steer-robot

FREQUENCIES_HZ = (2, 10)  # natural frequencies of the slave
RADII_M = (0, 0.0025, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.02, 0.025)  # of the region
# The hand feels one of these forces; the keys are names of tables.
ARCHITECTURES = {"rendered_20_mm": ("rendered, region of 20 mm", {"fixtures.0.radius_m": 0.02}),
                 "rendered": ("rendered, no region", {"fixtures.0.radius_m": 0}),
                 "none": ("no feedback", {"feedback.force": "none"}),
                 "slave_force": ("force of the slave", {"feedback.force": "slave-force"}),
                 "passive": ("force of the slave, passivity control", {"feedback.force": "passive-slave-force"})}


def bounds_m(rows, age_s):
    """The radius that is needed without noise, if the organ is seen age_s late: A |1 - G(iu) exp(-iu t_d)|. The slave reaches a
    command at the end of the tick after its arrival."""
    return np.array([theory.following_error_m(amplitude_m=AMPLITUDE_M, hz=SHAKE_HZ, natural_frequency_hz=hz,
                                              age_s=delay_s + TICK_S + age_s)
                     for hz, delay_s in zip(rows.frequency, rows.delay)])


def radius_without_touch_m(clearances_m):
    """The first radius at which the clearance is 0, interpolated; NaN if it is larger than all."""
    free = np.flatnonzero(clearances_m > 0)
    if len(free) == 0:
        return math.nan
    i = free[0]
    return np.interp(0, clearances_m[i - 1:i + 1], RADII_M[i - 1:i + 1]) if i > 0 else 0


@study("steer-robot", "which region keeps a slow slave behind a delay off an organ that moves, and the force on it otherwise",
       title="A slave behind a delay over an organ that moves", source="this project", caption="""
       A hand holds a slave robot over a plane that moves up and down with an amplitude of 20 mm at 0.5 Hz; the points have 1
       mm of noise, and frames arrive without a delay. Upper panel: the radius of the forbidden region at which the slave just
       does not touch the plane (dots), and the bounds derived from delay, bandwidth and age of the frames (bands). Lower
       panel: the largest force on the slave, for each force that the hand may feel. Simulated.""")
def steer_robot(s):
    draw_radii(s)
    draw_forces(s)


def draw_radii(s):
    clearances = s.grid({"frequency": FREQUENCIES_HZ, "delay": (0, 0.05, 0.1, 0.2), "radius": RADII_M},
                        lambda cell: ("steer-robot", {"slave.natural_frequency_hz": cell.frequency,
                                                      "command_link.delay_s": cell.delay, "fixtures.0.radius_m": cell.radius}),
                        {"clearance": lambda run: run.measures["min_slave_clearance"]})
    needed_m = np.array([radius_without_touch_m(each) for each in clearances.clearance.reshape(-1, len(RADII_M))])
    links = clearances.where(radius=RADII_M[0])
    least_m, latest_m = bounds_m(links, 0), bounds_m(links, 1 / FRAME_RATE_HZ)
    curves = []
    for hz in FREQUENCIES_HZ:
        name, of = f"needed_{hz}_hz", links.frequency == hz
        s.table(name, f"a slave of {hz} Hz",
                delay=(links.delay[of], "s", "delay of the commands"),
                radius=(needed_m[of], "m", "least radius without a touch"),
                least=(least_m[of], "m", "bound without noise, the organ is seen at once"),
                latest=(latest_m[of], "m", "bound without noise, the organ is seen a frame late"))
        curves += [band(name, "delay", "least", f"{hz} Hz, derived", z="latest"), dots(name, "delay", "radius", f"{hz} Hz")]
    s.panel("Radius of the region that keeps the slave from touching", "delay of the commands (s)", "radius (m)", curves)
    claims = s.claims("a slave over an organ that moves: ")
    # The slave's ball has the radius r_c, and noise moves the region by less than its standard deviation.
    claims.at_most("the radius that is needed is at least the derived one: largest amount below it",
                   (least_m - needed_m).max(), 0.001, "m")
    claims.at_most("the radius that is needed is not much larger than derived for a frame that is one interval old: largest amount "
                   "above it", (needed_m - latest_m).max(), 0.002, "m")


def draw_forces(s):
    touches = s.grid({"felt": [*ARCHITECTURES], "delay": (0, 0.025, 0.05, 0.1, 0.2)},
                     lambda cell: ("steer-robot", {**ARCHITECTURES[cell.felt][1], "command_link.delay_s": cell.delay,
                                                   "force_link.delay_s": cell.delay}),
                     {"force": lambda run: run.measures["max_slave_force"],
                      "energy": lambda run: run.measures["max_energy_injected"],
                      "channel_energy": lambda run: run.measures["min_channel_energy"]})
    for name, (title, _) in ARCHITECTURES.items():
        rows = touches.where(felt=name)
        s.table(name, title,
                delay=(rows.delay, "s", "delay in each direction"),
                force=(rows.force, "N", "largest force of the scene on the slave"),
                energy=(rows.energy, "J", "maximum energy given to the hand"))
    s.panel("Force on the slave, 2 Hz", "delay in each direction (s)", "largest force (N)",
            [line(name, "delay", "force", title) for name, (title, _) in ARCHITECTURES.items()])
    region, passive = touches.where(felt="rendered_20_mm"), touches.where(felt="passive")
    claims = s.claims("2 Hz: ")
    claims.at_most("a region of 20 mm keeps the slave from touching up to 0.1 s in each direction: largest force",
                   region.force[region.delay <= 0.1].max(), 0, "N")
    claims.at_least("without a region the rendered force does not keep the slave from touching: force at 0.1 s",
                    touches.where(felt="rendered", delay=0.1).force[0], 1, "N")
    claims.at_least("the force of the slave after 0.1 s in each direction makes the loop unstable: energy given to the hand",
                    touches.where(felt="slave_force", delay=0.1).energy[0], 1, "J")
    # The moving organ may give the hand energy, but the channel makes none.
    claims.at_least("with passivity control the channel gives no more energy than it received, except by wrong predictions: lowest "
                    "energy", passive.channel_energy.min(), -0.005, "J")
    # A stiff contact without delay is where a controller that acts once per tick is weakest.
    claims.at_least("without a delay the loop has a limit cycle in spite of passivity control: energy given to the hand",
                    passive.where(delay=0).energy[0], 1, "J")


if __name__ == "__main__":
    sys.exit(main())
