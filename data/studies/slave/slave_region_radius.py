"""The radius of a forbidden region that keeps a slave of 2 Hz from touching: over the delay of commands and frames, the speed of
the organ and the noise of the points."""
import math
import sys

import numpy as np
from slave_tasks import DELAYS_S, FRAME_RATE_HZ, LOWERING_M_PER_S, ORGAN_M, TICK_S, organ_task, text

from remote_touch import theory
from remote_touch.studies import band, dashed, dots, main, study

SLAVE_HZ = 2
NOISES_M = (0, 0.001, 0.002)
# The frequency of the organ, and whether frames are as late as the commands.
ORGANS = ((0.25, False), (0.5, False), (1, False), (0.5, True))
# A slave that is lowered overshoots the end of its command by v / (e w) before the organ moves.
LOWERED_M = LOWERING_M_PER_S / (math.e * 2 * math.pi * SLAVE_HZ)


def bounds_m(age_s):
    """A |1 - G(iu) exp(-iu t_d)| for each delay and organ, which is seen age_s after its frame. The slave reaches a command at the
    end of the tick after its arrival."""
    return np.array([[theory.following_error_m(amplitude_m=ORGAN_M, hz=hz, natural_frequency_hz=SLAVE_HZ,
                                               age_s=delay_s * (2 if is_late else 1) + TICK_S + age_s)
                      for hz, is_late in ORGANS] for delay_s in DELAYS_S])


LEAST_M, LATEST_M = bounds_m(0), bounds_m(1 / FRAME_RATE_HZ)


def needed_radii_m(s):
    """The radius for each noise, delay and organ.

    The slave feels no contact in these runs, so its least clearance may be negative, and a region that is larger by one millimetre
    makes it larger by about one. Each round corrects the radius by the clearance; after three the clearance was below 0.02 mm in
    all runs that were tried. Only what happens up to the first touch matters here, and until then a slave that feels contacts
    moves alike.
    """
    cells = [(noise_m, delay_s, hz, is_late) for noise_m in NOISES_M for delay_s in DELAYS_S for hz, is_late in ORGANS]
    radii_m = np.tile(LATEST_M.ravel(), len(NOISES_M))
    for _ in range(3):
        jobs = [organ_task(hz, noise_m, {"slave.contact_stiffness_N_per_m": 0, "frame_latency_s": text(delay_s if is_late else 0)},
                           frequency_hz=SLAVE_HZ, delay_s=delay_s, region_m=radius_m)
                for (noise_m, delay_s, hz, is_late), radius_m in zip(cells, radii_m)]
        radii_m = np.maximum(0, radii_m - s.measure(jobs, lambda run: run.measures["min_slave_clearance"]))
    return radii_m.reshape(len(NOISES_M), len(DELAYS_S), len(ORGANS))


@study("slave-region-radius", "the region that keeps a slave from touching, over delay, speed of the organ and noise",
       title="The region that a slave of 2 Hz needs", source="the theory of a linear slave", caption="""
       A hand holds a slave over an organ, a plane that moves up and down with an amplitude of 20 mm. The dots show the radius
       of the forbidden region at which the slave just does not touch, over the delay of the commands, for three frequencies of
       the organ; the legend shows its largest speeds. The bands are the bounds A |1 - G(iu) exp(-iu t_d)| for an organ that is
       seen at once and one frame interval late. A slave that is lowered at 0.1 m/s overshoots by v / (e w) before the organ
       moves (dashed). The last panel has frames that are as late as the commands. Noise makes the region that is needed
       smaller, so the radius to choose is that without noise. Simulated.""")
def slave_region_radius(s):
    radii_m = needed_radii_m(s)
    for i, noise_m in enumerate(NOISES_M):
        draw_regions(s, noise_m, radii_m[i])
    draw_late_frames(s, radii_m[:, :, -1])
    s.place_in_rows(2)
    add_claims(s, radii_m)


def add_table(s, name, title, radii_m, organ):
    s.table(name, title,
            delay=(DELAYS_S, "s", "delay of the commands"),
            radius=(radii_m, "m", "least radius without a touch"),
            least=(LEAST_M[:, organ], "m", "bound without noise, the organ is seen at once"),
            latest=(LATEST_M[:, organ], "m", "bound without noise, the organ is seen a frame late"),
            lowered=(np.full(len(DELAYS_S), LOWERED_M), "m", "bound of the slave that is lowered"))


def draw_regions(s, noise_m, radii_m):
    mm, curves = f"{1000 * noise_m:.0f}", []
    for k, (hz, _) in enumerate(ORGANS[:-1]):
        speed = f"{1000 * 2 * math.pi * hz * ORGAN_M:.0f}"
        name = f"speed_{speed}_noise_{mm}"
        add_table(s, name, f"organ of up to {speed} mm/s, noise of {mm} mm", radii_m[:, k], k)
        curves += [band(name, "delay", "least", f"{speed} mm/s, derived", z="latest"),
                   dots(name, "delay", "radius", f"{speed} mm/s")]
    curves.append(dashed(name, "delay", "lowered", "bound of the lowered slave"))
    s.panel(f"Noise of {mm} mm" if noise_m else "No noise", "delay of the commands (s)", "radius (m)", curves)


def draw_late_frames(s, radii_m):
    """The radius to choose is that without noise: noise only makes the region that is needed smaller."""
    names = [f"late_frames_noise_{1000 * noise_m:.0f}" for noise_m in NOISES_M]
    labels = [f"noise of {1000 * noise_m:.0f} mm" for noise_m in NOISES_M]
    for name, label, radius_m in zip(names, labels, radii_m):
        add_table(s, name, f"frames as late as the commands, {label}", radius_m, -1)
    s.panel("Frames as late as the commands, 63 mm/s", "delay of the commands (s)", "radius (m)",
            [band(names[0], "delay", "least", "derived without noise", z="latest"),
             *(dots(name, "delay", "radius", label) for name, label in zip(names, labels))])


def add_claims(s, radii_m):
    without_m = radii_m[0]
    increase = (radii_m[1:] - without_m) / np.reshape(NOISES_M[1:], (-1, 1, 1))  # in standard deviations of the noise
    claims = s.claims("a slave of 2 Hz over an organ that moves: ")
    # A ball between four points lies up to 0.11 mm below where it touches them.
    claims.at_most("without noise the region that is needed is at least A |1 - G(iu) exp(-iu t_d)|: largest amount below it",
                   (LEAST_M - without_m).max(), 0.0002, "m")
    claims.at_most("without noise no larger region is needed than for a frame that is one interval old, or for the overshoot "
                   "v / (e w) of a slave that is lowered: largest amount above both",
                   (without_m - np.maximum(LATEST_M, LOWERED_M)).max(), 0.0005, "m")
    # The ball rests on the highest of many points, so noise moves the command away from the organ.
    claims.at_most("noise does not make a larger region necessary: largest increase as a multiple of the standard deviation of the "
                   "noise", increase.max(), 0.5)
    claims.at_most("noise makes the needed region smaller by at most 3 standard deviations: largest decrease as a multiple of it",
                   -increase.min(), 3)


if __name__ == "__main__":
    sys.exit(main())
