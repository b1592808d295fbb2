"""The study of 1e7 lifts: from which acceleration on they pop through, over spacing, speed and noise, and the law that follows.

Lengths are in contact radii r_c, speeds in r_c f_c, accelerations in r_c f_c^2; f_c is the frame rate. The lifts are the stored
tally pop-through-law.h5 beside this file, made by `remote-touch sweep pop-through-law.json`, which takes hours.
"""
import json
import pathlib
import sys

import numpy as np

import remote_touch
from remote_touch.studies import color_map, dots, line, main, study

TALLY = pathlib.Path(__file__).with_name("pop-through-law.h5")
RC_M, FC_HZ = 0.005, 30
M_PER_S, M_PER_S2 = RC_M * FC_HZ, RC_M * FC_HZ ** 2  # of a unit
SPEED = 1  # 0.1 m/s as in Fig 4.12: for curves and law
MIDDLE = 1  # spacing of Fig 4.12, 1.5 mm
REMADE_CELLS = (0, 1, 19, 20), (2, 0, 7, 11), (4, 3, 3, 2)  # places on the axes


class Lifts:
    """The tally in pure numbers. half, few: the limits at which 50 % and 5 % have popped through, with the ends of their 95 %
    intervals, over spacing, speed and noise."""

    def __init__(self):
        self.tally = remote_touch.open(TALLY)
        self.config = json.loads(self.tally.attrs["config"])
        self.spacing, self.noise = self.tally.spacing_m.values / RC_M, self.tally.noise_sigma_m.values / RC_M
        self.speed = self.tally.start_velocity_m_per_s.values / M_PER_S
        self.acceleration = self.tally.acceleration_m_per_s2.values / M_PER_S2
        self.share = self.tally.popped_through_mean.values
        self.half, self.few = (limits_of(TALLY, level, self.share.shape[:3]) for level in (0.5, 0.05))
        self.limit = self.half["value"]


def limits_of(lifts, level, shape):
    """The accelerations at which this share of the lifts has popped through; NaN outside the axis."""
    rows = remote_touch.analyse(lifts, limit="popped_through", along="acceleration_m_per_s2", level=level, direction="rises")
    return {name: rows["limits"][name].values.reshape(shape) / M_PER_S2 for name in ("value", "low", "high")}


# --- the law: limit = (1 - s^2 / 2)^(1/2) + (gain - loss s) sigma, for a spacing s and noise sigma ---

def without_noise(spacing):
    """The height at which the proxy rests in the middle of four points. With it in place of r_1, (4.14) holds."""
    return np.sqrt(1 - spacing ** 2 / 2)


def points_at(lifts, spacings):
    """Spacing, noise and limit of the known limits at these spacings."""
    spacing, noise = np.meshgrid(lifts.spacing[spacings], lifts.noise, indexing="ij")
    limit = lifts.limit[spacings, SPEED]
    known = np.isfinite(limit)
    return spacing[known], noise[known], limit[known]


def fitted_law(lifts, spacings):
    """(gain, loss) with the least squares."""
    spacing, noise, limit = points_at(lifts, spacings)
    return np.linalg.lstsq(np.column_stack((noise, -spacing * noise)), limit - without_noise(spacing), rcond=None)[0]


def law_at(law, spacing, noise):
    gain, loss = law
    return without_noise(spacing) + (gain - loss * spacing) * noise


def rms_residual(lifts, law, spacings):
    spacing, noise, limit = points_at(lifts, spacings)
    return np.sqrt(np.mean((limit - law_at(law, spacing, noise)) ** 2))


def neutral_spacing(law):
    """The spacing at which noise does not change the limit."""
    return law[0] / law[1]


# --- runs ---

def different_cells(s, lifts):
    """The number of cells whose lifts, all made again, do not pop through as often as in the tally."""
    replicates = lifts.config["replicates"]
    jobs = [(lifts.config["experiment"], {**settings_of(lifts, places), "replicate": i})
            for places in REMADE_CELLS for i in range(replicates)]
    popped = np.reshape(s.measure(jobs, lambda run: run.measures["popped_through"]), (-1, replicates))
    counted = lifts.share * lifts.tally.popped_through_values.values
    return sum((lifts_again == 1).sum() != round(counted[places]) for lifts_again, places in zip(popped, REMADE_CELLS))


def settings_of(lifts, places):
    """Those of all lifts of a cell. The start depth is on the axis of the speed."""
    spacing_m, velocity_m_per_s, noise_m, acceleration_m_per_s2 = (
        axis.values[place] for axis, place in zip(lifts.tally.coords.values(), places))
    return {"scenario.spacing_m": spacing_m, "scenario.start_velocity_m_per_s": velocity_m_per_s,
            "scenario.start_depth_m": lifts.config["axes"][1]["values"][places[1]][1], "scenario.noise_sigma_m": noise_m,
            "scenario.acceleration_m_per_s2": acceleration_m_per_s2, "cell": np.ravel_multi_index(places, lifts.share.shape)}


def difference_to_30_steps(s, lifts):
    """The largest difference between the limits with the 30 steps of the dissertation and those of the study, at the spacing and
    the speed of Fig 4.12 and three strengths of noise."""
    made = s.sweep(lifts.config, {
        "keep": "runs", "replicates": 40, "renderer.steps_per_tick": 30, "renderer.gamma": 0.3,
        "axes.0": {"parameter": "scenario.spacing_m", "values": [0.0015]}, "scenario.start_depth_m": 0.02,
        "axes.1": {"parameter": "scenario.start_velocity_m_per_s", "values": [0.1]},
        "axes.2": {"parameter": "scenario.noise_sigma_m", "values": [0.0005, 0.0025, 0.005]}})
    same = np.isin(np.round(lifts.noise, 9), np.round(made.noise_sigma_m.values / RC_M, 9))
    return np.abs(limits_of(made, 0.5, (3,))["value"] - lifts.limit[MIDDLE, SPEED, same]).max()


# --- the figure ---

@study("pop-through-law", "from which acceleration on lifts pop through, over spacing, noise and speed: a law from 1e7 lifts",
       title="The law of pop-through", source="this project", caption="""
       1e7 lifts of noisy clouds, a stored tally: the acceleration at which the proxy of half of them, and of 5 %, passes to the
       wrong side within six frames, over the noise, for five spacings of the points and four speeds at the start. r_c: contact
       radius, f_c: frame rate. Start at 0.67 r_c f_c unless stated; simulated.""")
def pop_through_law(s):
    lifts = Lifts()
    law, of_three = fitted_law(lifts, [0, 1, 2, 3, 4]), fitted_law(lifts, [0, 2, 4])
    draw_spacings(s, lifts, lifts.half, "50", law, with_law=True)
    draw_spacings(s, lifts, lifts.few, "5", law, with_law=False)
    draw_map(s, lifts, 0)
    draw_map(s, lifts, len(lifts.spacing) - 1)
    draw_speeds(s, lifts, law)
    s.place_in_rows(2)
    both = np.array([law, of_three])
    s.table("law", "limit / (r_c f_c^2) = (1 - s^2 / 2)^(1/2) + (gain - loss s) sigma",
            spacings=([5, 3], "1", "number of spacings whose limits were fitted"),
            gain=(both[:, 0], "1", "what noise gains at dense points"),
            loss=(both[:, 1], "1", "what noise loses for each r_c of spacing"),
            neutral_spacing=(neutral_spacing(both.T), "r_c", "spacing at which noise does not change the limit"))
    claim(s, lifts, law, of_three)
    checks = s.claims(set_up=True)
    checks.between("the tally has every run of the sweep: runs", lifts.tally.runs.values.sum(), 1e7, 1e7, "runs")
    checks.at_least("the law is fitted to most limits: share of the limits that are known", np.isfinite(lifts.limit[:, SPEED]).mean(),
                    0.8, "fraction")
    checks.at_most("3000 runs of three cells are made again and counted: cells with another count", different_cells(s, lifts), 0,
                   "cells")


def limit_table(s, name, title, lifts, limits, spacing, speed, law):
    """The limits at one spacing and speed over noise."""
    s.table(name, title, noise=(lifts.noise, "r_c", "standard deviation of the noise"),
            limit=(limits["value"][spacing, speed], "r_c f_c^2", "acceleration at which this share of the lifts pops through"),
            low=(limits["low"][spacing, speed], "r_c f_c^2", "lower end of its 95 % interval"),
            high=(limits["high"][spacing, speed], "r_c f_c^2", "upper end of its 95 % interval"),
            law=(law_at(law, lifts.spacing[spacing], lifts.noise), "r_c f_c^2", "the law for the half"))


def draw_spacings(s, lifts, limits, share, law, with_law):
    curves = []
    for i, spacing in enumerate(lifts.spacing):
        name = f"share_{share}_spacing_{i}"
        limit_table(s, name, f"limits of {share} % at a spacing of {spacing:.2g} r_c", lifts, limits, i, SPEED, law)
        curves.append(dots(name, "noise", "limit", f"spacing {spacing:.2g} r_c"))
        if with_law:
            curves.append(line(name, "noise", "law", f"spacing {spacing:.2g} r_c, law"))
    s.panel(f"{share} % pop through" + (", and the law" if with_law else ""), "noise (r_c)", "acceleration (r_c f_c^2)",
            curves, y_range=(0, 1.7))


def draw_speeds(s, lifts, law):
    for i, speed in enumerate(lifts.speed):
        limit_table(s, f"speed_{i}", f"limits of 50 % with a start at {speed:.2g} r_c f_c", lifts, lifts.half, MIDDLE, i, law)
    s.panel("50 % pop through, spacing 0.3 r_c", "noise (r_c)", "acceleration (r_c f_c^2)",
            [dots(f"speed_{i}", "noise", "limit", f"start at {speed:.2g} r_c f_c") for i, speed in enumerate(lifts.speed)],
            y_range=(0, 1.7))


def draw_map(s, lifts, spacing):
    """The share of lifts that pop through over noise and acceleration."""
    name, title = f"map_spacing_{spacing}", f"spacing {lifts.spacing[spacing]:.2g} r_c"
    noise, acceleration = np.meshgrid(lifts.noise, lifts.acceleration, indexing="ij")
    s.table(name, f"share of lifts that pop through, {title}", noise=(noise.ravel(), "r_c", "standard deviation of the noise"),
            acceleration=(acceleration.ravel(), "r_c f_c^2", "acceleration of the lift"),
            popped_through=(lifts.share[spacing, SPEED].ravel(), "1", "share of lifts that pop through"))
    s.panel(f"Share that pops through, {title}", "noise (r_c)", "acceleration (r_c f_c^2)",
            [color_map(name, "noise", "acceleration", "share that pops through", z="popped_through")])


def claim(s, lifts, law, of_three):
    at_speed = lifts.limit[:, SPEED]
    claims = s.claims()
    claims.at_most("with noise of 0.05 r_c half of the lifts pop through at e f_c^2, where e is the height of the proxy amid four "
                   "points: largest difference over five spacings",
                   np.abs(at_speed[:, 0] - without_noise(lifts.spacing)).max(), 0.1, "r_c f_c^2", "0 (4.14)")
    claims.at_most("a law with two fitted numbers gives the limits over spacing and noise: rms residual",
                   rms_residual(lifts, law, [0, 1, 2, 3, 4]), 0.06, "r_c f_c^2")
    claims.at_most("the law of three spacings predicts the limits at the two between them: rms residual",
                   rms_residual(lifts, of_three, [1, 3]), 0.07, "r_c f_c^2")
    claims.between("noise raises the limit of dense points and lowers that of sparse ones: neutral spacing", neutral_spacing(law),
                   0.33, 0.43, "r_c")
    claims.at_least("with points 0.2 r_c apart noise of r_c raises the limit: by", at_speed[0, -1] - at_speed[0, 0], 0.4,
                    "r_c f_c^2")
    claims.at_most("with points 0.6 r_c apart noise of 0.75 r_c lowers the limit: change", at_speed[-1, 14] - at_speed[-1, 0], -0.4,
                   "r_c f_c^2")
    claims.at_most("a start at 0.33 or 0.67 r_c f_c gives the same limits: rms difference",
                   np.sqrt(np.nanmean((lifts.limit[:, 0] - at_speed) ** 2)), 0.09, "r_c f_c^2")
    claims.at_least("a start above r_c f_c with points 0.3 r_c apart and noise of 0.05 r_c is lost at the first touch: share that "
                    "pops through at the least acceleration", lifts.share[MIDDLE, 3, 0, 0], 0.5, "fraction")
    claims.at_most("30 steps of gamma = 0.3 give the limits of 8 steps of 0.5: largest difference of three",
                   difference_to_30_steps(s, lifts), 0.1, "r_c f_c^2")


if __name__ == "__main__":
    sys.exit(main())
