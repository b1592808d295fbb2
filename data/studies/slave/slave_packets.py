"""The packets that a perceptual dead-band leaves of the commands and forces of a slave that follows a contour."""
import sys

import numpy as np
from slave_tasks import CONTOUR_DAMPING_NS_PER_M, CONTOUR_GAIN, CONTOUR_STIFFNESS_N_PER_M, HAND_DAMPING_NS_PER_M, HAND_MASS_KG, \
    HAND_STIFFNESS_N_PER_M, MASS_KG, TICK_S, contour_task, text

from remote_touch import theory
from remote_touch.studies import dashed, dots, main, study

SLAVE_HZ = 5
FRACTIONS = (0.05, 0.1, 0.2)  # Weber fractions of the force
LENGTHS_M = (0.0002, 0.0005, 0.001, 0.002)  # dead-bands of the commands
# The largest reductions that publications report, in percent. Their signals come from human hands and from sensors with noise.
PUBLISHED = (85, 90, 96)


def contour(settings):
    return contour_task(settings, feedback="slave-force", frequency_hz=SLAVE_HZ)


def bound_of_forces_per_s(run, fraction):
    """A value that is held is sent again after a path of at least log(1 + k) in units of its magnitude, with the Weber fraction k.
    On a straight path outwards the magnitude grows by the factor 1 + k; every other path is longer. A sample with which a contact
    begins or ends is sent too."""
    size_N, path_N = run.norm("slave_force"), np.linalg.norm(np.diff(run.slave_force, axis=0), axis=1)
    less_N = np.minimum(size_N[:-1], size_N[1:])
    touches = less_N > 0
    resent = np.minimum(1, path_N[touches] / less_N[touches] / np.log1p(fraction)).sum()
    return (1 + resent + np.count_nonzero(~touches & (path_N > 0))) / run.time[-1]


def bound_of_commands_per_s(run, length_m):
    """A command that is held is sent again after a path of at least the dead-band."""
    path_m = np.linalg.norm(np.diff(run.slave_command, axis=0), axis=1).sum()
    return (1 + path_m / length_m) / run.time[-1]


def shift_m(run, whole):
    """The rms distance of the slave from that of another run."""
    return np.sqrt(((run.slave_position - whole.slave_position) ** 2).sum(axis=1).mean())


def stable_delay_s():
    """Of the linear loop of the task. The forces of the slave are sampled and held, and so are its commands."""
    round_trip_s, _ = theory.delay_onset(
        mass_kg=HAND_MASS_KG, stiffness_N_per_m=HAND_STIFFNESS_N_PER_M, damping_Ns_per_m=HAND_DAMPING_NS_PER_M,
        slave_mass_kg=MASS_KG, slave_natural_frequency_hz=SLAVE_HZ, feedback_gain=CONTOUR_GAIN,
        environment_stiffness_N_per_m=CONTOUR_STIFFNESS_N_PER_M, environment_damping_Ns_per_m=CONTOUR_DAMPING_NS_PER_M)
    return round_trip_s - theory.held_round_trip(0, TICK_S, 4)


def banded(s, whole, name, setting, bands, bound_per_s, band_column, panel):
    """Makes the runs with each dead-band of a link; draws them, and returns their table. whole: the run that sends every sample.
    panel: its title and the label of its x axis."""
    link = f"{name}_link"
    runs = s.runs([contour({f"{link}.{setting}": text(each), f"{link}.predicts": predicts})
                   for predicts in (False, True) for each in bands])
    held, predicted = runs[:len(bands)], runs[len(bands):]
    rate = f"{name}_packet_rate"
    table = f"{name}s"
    rows = s.table(table, f"packets of {table} per second; without a dead-band 1000",
                   band=(bands, *band_column),
                   held=([run.measures[rate] for run in held], "1/s", "packets per second, values are held"),
                   predicted=([run.measures[rate] for run in predicted], "1/s", "packets per second, linear prediction"),
                   bound=([*map(bound_per_s, held, bands)], "1/s", "bound for values that are held"),
                   shift=([shift_m(run, whole) for run in held], "m", "rms distance from the slave that gets every sample"))
    s.panel(*panel, "packets per second",
            [dots(table, "band", "held", "held"), dots(table, "band", "predicted", "linear prediction"),
             dashed(table, "band", "bound", "bound, held"),
             dots("published", "band", "rate", f"published: {', '.join(map(str, PUBLISHED))} % fewer, for other dead-bands")])
    return rows


@study("slave-packets", "packets of commands and forces over the dead-band, beside published reductions",
       title="Packets of a slave that follows a contour", source="Hinterseer et al. 2008", caption="""
       A hand presses a slave of 5 Hz into a soft surface with waves of 3 mm, slides along it and back, and feels half of the
       force of the slave. Packets per second over the dead-band of the forces (Weber fraction) and of the commands (length),
       with values that are held and with linear prediction (dots); the bound for held values from the path of the signal
       (dashed); and, on the right edge, the largest reductions that publications report for the signals of human hands and
       dead-bands of their own. Without a dead-band there are 1000 packets per second. Simulated.""")
def slave_packets(s):
    whole = s.run(*contour({}))
    s.table("published", "published reductions; their dead-bands are not those of this figure",
            band=(np.full(len(PUBLISHED), np.nan), "1", "dead-band, not comparable"),
            rate=((1 - np.array(PUBLISHED) / 100) / TICK_S, "1/s", "packets per second"))
    forces = banded(s, whole, "force", "weber_fraction", FRACTIONS, bound_of_forces_per_s, ("1", "Weber fraction"),
                    ("Forces", "Weber fraction"))
    commands = banded(s, whole, "command", "least", LENGTHS_M, bound_of_commands_per_s, ("m", "least difference that is sent"),
                      ("Commands", "dead-band (m)"))
    s.place_in_rows(2)
    s.claims("a slave on a contour: ", set_up=True).at_least(
        "the linear loop without a dead-band is stable: largest stable delay", stable_delay_s(), 0.001, "s")
    claims = s.claims("a slave on a contour: ")
    claims.at_least("forces with a Weber fraction of 0.1, held, need at least 90 % fewer packets: reduction",
                    1 - forces.held[1] * TICK_S, 0.9, "fraction", "up to 0.9")
    claims.at_most("held forces need no more packets than the bound from the path of the signal: largest ratio",
                   (forces.held / forces.bound).max(), 1)
    claims.at_most("held commands need no more packets than the bound from the path of the signal: largest ratio",
                   (commands.held / commands.bound).max(), 1)
    claims.at_most("linear prediction of commands needs no more packets than held commands at any dead-band: largest ratio",
                   (commands.predicted / commands.held).max(), 1)
    claims.at_most("linear prediction of commands with 0.2 mm at least halves the packets: ratio to held commands",
                   commands.predicted[0] / commands.held[0], 0.5)
    # The hand may be pushed by a force that is wrong by this fraction, against its own spring.
    claims.at_most("a Weber fraction of 0.1 moves the slave by no more than the error of the force moves a hand at rest: rms "
                   "distance",
                   forces["shift"][1], 0.1 * CONTOUR_GAIN * whole.norm("slave_force").max() / HAND_STIFFNESS_N_PER_M, "m")


if __name__ == "__main__":
    sys.exit(main())
