"""Fig 4.13 for a plate in place of the proxy: noisy surfaces that accelerate, rendered by tracked sheets and by the three contact
rules of the tool."""
import sys

import numpy as np
from lift_maps import CONTACT_RADIUS_M, NOISE, LiftMap

from remote_touch import theory
from remote_touch.studies import dashed, line, main, study

PLATE = "slab-10"
TRACKED = {"tracked": ("tracked sheets", {"name": "tracked-tool", "tool_mesh": PLATE})}
# The rival rules with their default parameters, and with the velocity estimate that they have in sweep tool-noise.
RIVALS = {column: (label, {"name": "tool", "tool_mesh": PLATE, "contact_rule": rule, "velocity_estimate": True})
          for column, label, rule in (("voxels", "as printed", "voxels"), ("look_ahead", "look-ahead", "look-ahead"),
                                      ("continuous", "continuous", "continuous"))}
LOOK_AHEAD_AS_IS = {"look_ahead_plain": ("look-ahead, no velocity estimate",
                                         {"name": "tool", "tool_mesh": PLATE, "contact_rule": "look-ahead"})}
METHODS = {**TRACKED, **RIVALS, **LOOK_AHEAD_AS_IS}  # column: label and renderer
# The renderer's parameters were fixed with seeds 1 to 20, before any run with these seeds had been viewed.
TRACKED_SEEDS, OTHER_SEED, JUMP_SEEDS = range(101, 111), 101, (101, 102)

JUMP_NOISE, SHAPE_NOISE, FROM_S = (0.3, 1, 3), (0, 0.3, 1, 2), 0.5  # noise: r_c
MIN_UPDATES = 10  # for an rms jump; with fewer, because the plate is rarely held, it is NaN
# The limits of force and torque are so high that they do not act.
JUMP_SETTINGS = {"renderer.max_force_N": 1000, "renderer.max_torque_Nm": 100, "duration_s": 0.9}
RISES = {"scenario.rise_s": 5 / 6, "scenario.acceleration_s": 0}  # at 0.1 m/s
WITH_HAND = {**RISES, "trajectory.poses": [[0, 0.03, 0, 0, 0, 0, 0], [0, -0.002, 0, 0, 0, 0, 0.2], [0, -0.002, 0, 0, 0, 0, 0.2],
                                           [0, 0.078, 0, 0, 0, 0, 0.8]]}
# A surface at rest, whose noise is drawn anew in every frame; one that rises with the hand; and one that rises while the hand
# stays, so that the spring grows longer.
MOTIONS = {"at_rest": ("Surface at rest", {"scenario.wait_s": 2, "scenario.rise_s": 0, "scenario.acceleration_s": 0}),
           "carried": ("Rises with the hand", WITH_HAND), "left": ("Rises, the hand stays", RISES)}
SHAPES = ("flat", "ridge", "corner", "sphere", "valley")


def task(method, noise, seed, settings):
    return "tracked-tool-lift", {"renderer": METHODS[method][1], "scenario.noise_sigma_m": round(noise * CONTACT_RADIUS_M, 6),
                                 "seed": seed, **settings}


# --- lifts ---

def lift_map(s, method, seed, stored):
    """The lifts of the whole map by a method: the number of those that did not pop through, and of all. stored: adds the map, and
    the cells in which more than half of the lifts survived."""
    made = LiftMap(s.map("tool-tracked", {"renderer": METHODS[method][1], "seed": seed}), "tool_popped_through")
    if stored:
        made.add_to(s, f"_{method}")
    return np.array([made.counts[:, 0].sum(), made.runs.sum()])


def add_lifts(s):
    """The maps of all methods. Returns the counts over all seeds, by method."""
    counts = {"tracked": sum(lift_map(s, "tracked", seed, seed == TRACKED_SEEDS[0]) for seed in TRACKED_SEEDS)}
    counts |= {method: lift_map(s, method, OTHER_SEED, True) for method in RIVALS}
    low, high = np.transpose([theory.exact_interval(held, runs) for held, runs in counts.values()])
    held, runs = np.transpose([*counts.values()])
    s.table("success", "lifts that did not pop through, over the whole map",
            method=([METHODS[method][0] for method in counts], "1", "how the plate is rendered"),
            survived=(held / runs, "1", "share of lifts that did not pop through"),
            survived_low=(low, "1", "lower end of its 95 % interval"),
            survived_high=(high, "1", "upper end of its 95 % interval"),
            runs=(runs.astype(float), "1", "number of lifts"))
    return counts


def success_text(counts):
    """"tracked sheets 418 of 420 (0.983 to 0.999), as printed 42 of 42 (0.916 to 1)", with 95 % intervals."""
    texts = []
    for method, (held, runs) in counts.items():
        low, high = theory.exact_interval(held, runs)
        texts.append(f"{METHODS[method][0]} {held} of {runs} ({low:.3g} to {high:.3g})")
    return ", ".join(texts)


# --- jumps at frames ---

def squared_jumps(run):
    """The sums of squares, of force and torque, of the change at a frame beyond the change in the tick before, so that an even rise
    counts as 0; and the number of the updates. They are the updates at which the plate is held before and after."""
    i = run.frame_updates()
    held = run.force.any(axis=1)
    i = i[(i >= 2) & (run.time[i] >= FROM_S) & held[i] & held[i - 1]]
    return [*(((rows[i] - 2 * rows[i - 1] + rows[i - 2]) ** 2).sum() for rows in (run.force, run.torque)), i.size]


def add_jumps(s, name, title, motion):
    """The rms jump at each noise strength, over the updates of all seeds."""
    columns = {"noise": (JUMP_NOISE, *NOISE)}
    for method in METHODS:
        sums = np.reshape(s.measure([task(method, noise, seed, {**JUMP_SETTINGS, **motion})
                                     for noise in JUMP_NOISE for seed in JUMP_SEEDS], squared_jumps), (len(JUMP_NOISE), -1, 3))
        force, torque, updates = sums.sum(axis=1).T
        updates = np.where(updates < MIN_UPDATES, np.nan, updates)
        columns |= {f"{method}_force": (np.sqrt(force / updates), "N", "rms change of the force at frames"),
                    f"{method}_torque": (np.sqrt(torque / updates), "N m", "rms change of the torque at frames")}
    return s.table(name, title, columns)


def draw_jumps(s, name, title, what, unit):
    curves = [(dashed if method in LOOK_AHEAD_AS_IS else line)(name, "noise", f"{method}_{what}", label)
              for method, (label, _) in METHODS.items()]
    s.panel(f"{title}: {what}", "noise (r_c)", f"rms {what} jump ({unit})", curves)


# --- shapes that are not flat ---

def mean_height_m(run):
    """The mean distance of the plate's centre of mass to the true surface."""
    return run.signed_distance[run.time >= FROM_S].mean()


def raised_by_noise(s, method):
    """The height by which noise raises the plate, compared with the same renderer without noise, in r_c: by shape and noise."""
    heights_m = np.reshape(s.measure([task(method, noise, OTHER_SEED, {"scenario.shape": shape, "duration_s": 0.8, **WITH_HAND})
                                      for shape in SHAPES for noise in SHAPE_NOISE], mean_height_m), (len(SHAPES), -1))
    return (heights_m - heights_m[:, :1]) / CONTACT_RADIUS_M


@study("tool-tracked", "a plate on noisy surfaces that accelerate, by tracked sheets and by three contact rules",
       title="A plate on noisy surfaces that accelerate, by tracked sheets", quick_coarse=2)
def tool_tracked(s):
    counts = add_lifts(s)
    s.caption = (
        "A noisy surface rises under a plate of 40 x 40 x 10 mm at 0.1 m/s and then accelerates, as in Fig 4.13; frames at 30 Hz; "
        "simulated. Lifts that did not pop through, over noise up to 3 r_c and acceleration up to 1400 r_c/s^2, with 95 % "
        f"intervals: {success_text(counts)}. Drawn is what the frames do to force and torque on a surface at rest and on one that "
        "rises evenly: a jump is the change at a frame beyond the change in the tick before, rms over the frames of two seeds, 101 "
        "and 102. The three contact rules have a velocity estimate, and look-ahead also none. Parameters were fixed with seeds 1 "
        "to 20. The lifts of tracked sheets are of seeds 101 to 110, the others of seed 101.")
    jumps = {name: add_jumps(s, name, title, motion) for name, (title, motion) in MOTIONS.items()}
    for name in ("at_rest", "carried"):
        draw_jumps(s, name, MOTIONS[name][0], "force", "N")
        draw_jumps(s, name, MOTIONS[name][0], "torque", "N m")
    s.place_in_rows(2)
    raised = {method: raised_by_noise(s, method) for method in ("tracked", "look_ahead")}
    s.table("shapes", "how much higher noise holds a plate on surfaces that rise with the hand",
            shape=(np.repeat(SHAPES, len(SHAPE_NOISE)), "1", "shape of the surface"),
            noise=(np.tile(SHAPE_NOISE, len(SHAPES)), *NOISE),
            tracked=(raised["tracked"].ravel(), "r_c", "by tracked sheets"),
            look_ahead=(raised["look_ahead"].ravel(), "r_c", "by look-ahead"))
    claim_lifts(s.claims("tracked sheets hold the plate in nearly all runs of the whole map: ", of_map=True), counts)
    claim_jumps(s, jumps)
    s.claims().at_most("noise up to 2 r_c hardly changes the height of a plate on a flat surface: largest change",
                       np.abs(raised["tracked"][SHAPES.index("flat")]).max(), 0.1, "r_c")


def claim_lifts(claims, counts):
    (held, runs), (printed, of_printed) = counts["tracked"], counts["voxels"]
    claims.at_least(f"fraction (by the printed rule: {printed} of {of_printed})", held / runs, 0.99, "fraction")
    claims.at_least("lower end of the exact 95 % interval of the fraction", theory.exact_interval(held, runs)[0], 0.97, "fraction")


def claim_jumps(s, jumps):
    """Against the jump of look-ahead, with or without its velocity estimate, whichever is smaller."""
    for name, rows in jumps.items():
        claims = s.claims(f"{MOTIONS[name][0]}: at frames the ")
        for what in ("force", "torque"):
            least = np.minimum(rows[f"look_ahead_{what}"], rows[f"look_ahead_plain_{what}"])
            claims.at_most(f"{what} jumps less with tracked sheets than with look-ahead: largest ratio of the jumps",
                           (rows[f"tracked_{what}"] / least).max(), 1 / 3, "ratio")


if __name__ == "__main__":
    sys.exit(main())
