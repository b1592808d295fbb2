"""Segmentation by hue of the two valves of 7.5.1 in ever more turbid water, where the truth is known."""
import sys

import numpy as np

import remote_touch as rt
from remote_touch.studies import Rows, image, line, main, study
from remote_touch.theory import exact_interval

LEVELS_PER_M, DEFAULT_PER_M = (0, 0.3, 0.6, 1, 1.5, 2, 3), 0.6
FRAMES = 5
ENOUGH_PICKED = 100  # pixels, for a meaningful precision

# The valves that the two rules of the experiment must find, in the order of the rules.
VALVES = {"red": "left", "yellow": "right"}

# The masks that are drawn: their levels and titles, which explain the colours. The rectangle that is shown, in pixels.
MASKS = {0: "Picked: red and yellow", 2: "Black: no depth, white: wrong", 4: "Magenta: missed"}
LEFT, TOP, RIGHT, BOTTOM = 205, 195, 435, 290
BACK, NO_DEPTH, MISSED, WRONG, FOUND = 0x3C4654, 0x000000, 0xFF00FF, 0xFFFFFF, {"red": 0xE03A30, "yellow": 0xF0C020}


def true_pixels(settings):
    """For each valve the pixels that show it: those that another paint of the valve changes, in clear water without noise."""
    def colours(**paint):
        return rt.scene(**{**settings, "turbidity_per_m": 0, "colour_noise": 0, **paint}).cloud(0).colour
    usual = colours()
    return {name: colours(**{f"{side}_hue_deg": 180}) != usual for name, side in VALVES.items()}


def masks(cloud, rules):
    """The pixels with depth, and for each valve those that its rule picks."""
    return np.isfinite(cloud.x), {name: cloud.rule_weights(rule) > 0 for name, rule in zip(VALVES, rules)}


def counts(measured, picked, shows):
    """Pixels of a valve with depth that are picked and missed, other pixels that are picked, and its pixels without depth."""
    return np.sum([picked & shows, measured & shows & ~picked, picked & ~shows, shows & ~measured], axis=1)


def drawn_mask(measured, picked, shows):
    picture = np.where(measured, BACK, NO_DEPTH)
    for name in VALVES:
        of = measured & shows[name]
        picture[of] = np.where(picked[name][of], FOUND[name], MISSED)
        picture[picked[name] & ~shows[name]] = WRONG
    return picture


def fraction(events, of):
    """NaN of nothing."""
    return np.divide(events, of, out=np.full(len(of), np.nan), where=of > 0)


def scores(found, missed, wrong, without_depth):
    """Fractions over the levels, from counts of pixels. The exact intervals count pixels as if they were independent. A hue at the
    edge of a range is wrong for a whole surface at once, so they reflect the number of pixels only."""
    recall_low, recall_high = np.transpose([*map(exact_interval, found, found + missed)])
    precision_low, precision_high = np.transpose([*map(exact_interval, found, found + wrong)])
    return Rows(
        turbidity=np.array(LEVELS_PER_M), recall=fraction(found, found + missed), recall_low=recall_low, recall_high=recall_high,
        precision=fraction(found, found + wrong), precision_low=precision_low, precision_high=precision_high,
        depth_fraction=fraction(found + missed, found + missed + without_depth), found=found / FRAMES, missed=missed / FRAMES,
        wrong=wrong / FRAMES, without_depth=without_depth / FRAMES, picked=found + wrong)


@study("turbidity", "two valves in turbid water found by hue: precision and recall",
       title="Two valves found by hue in turbid water", caption="""
       A simulated camera looks at a red and a yellow valve, 900 mm away in water whose every channel is attenuated, red
       most of all, and veiled. First row: what it sees, cut out around the valves. Second row: what the rules of hue pick of it.
       Red and yellow are right, magenta is a part of a valve that is missed, white is something else that is picked, black has no
       depth and therefore no point. Third row: recall and precision among the pixels with depth, and the fraction of pixels with
       depth; the precision of 0 at the end of yellow's curve is of less than a pixel in a frame. Most of a valve is too narrow for
       the depth camera, which sees nothing within 1 px of an edge. The water is a model with chosen rates, so the turbidity at
       which a hue is lost holds for that model only. The figure shows which hue is lost first, and how.""")
def turbidity(s):
    pictures, counted = {}, {name: [] for name in VALVES}
    for level, per_m in enumerate(LEVELS_PER_M):
        config = s.uses("turbidity", {"scenario.turbidity_per_m": per_m})
        if level == 0:
            shows = true_pixels(config["scenario"])
        scene = rt.scene(**config["scenario"])
        clouds = [scene.cloud(frame) for frame in range(FRAMES)]
        found = [masks(cloud, config["fixtures"]) for cloud in clouds]
        for name in VALVES:
            counted[name].append(sum(counts(measured, picked[name], shows[name]) for measured, picked in found))
        pictures[level] = clouds[0].colour, drawn_mask(*found[0], shows)
        columns = clouds[0].columns
    scored = {name: scores(*np.transpose(of)) for name, of in counted.items()}
    for name, of in scored.items():
        add_scores(s, name, of)
    add_pictures(s, pictures, columns)
    for column, (title, value) in enumerate({"Recall": "recall", "Precision": "precision",
                                             "Pixels of a valve that have depth": "depth_fraction"}.items()):
        s.panel(title, "turbidity (1/m)", "fraction", [line(name, "turbidity", value, f"{name} valve") for name in VALVES],
                at=(2, column), x_range=(0, 3), y_range=(-0.02, 1.02))
    add_claims(s, scored)


def add_scores(s, name, of):
    interval = {"low": "95 % interval, lower end", "high": "95 % interval, upper end"}
    texts = {"recall": "recall: share of its pixels with depth that are picked",
             **{f"recall_{end}": text for end, text in interval.items()},
             "precision": "precision: share of the picked pixels that are its",
             **{f"precision_{end}": text for end, text in interval.items()},
             "depth_fraction": "share of its pixels that have a depth", "found": "its pixels that are picked, a frame",
             "missed": "its pixels with depth that are not picked, a frame", "wrong": "other pixels that are picked, a frame",
             "without_depth": "its pixels without depth, a frame"}
    s.table(name, f"the {name} valve, {FRAMES} frames", turbidity=(of.turbidity, "1/m", "turbidity beta"),
            **{column: (of[column], "1", text) for column, text in texts.items()})


def add_pictures(s, pictures, columns):
    rows, across = map(np.ravel, np.mgrid[TOP:BOTTOM, LEFT:RIGHT])
    for column, (level, title) in enumerate(MASKS.items()):
        per_m = f"{LEVELS_PER_M[level]:.1f} per metre"
        kinds = ("colours", "what the camera sees", f"Seen at {per_m}"), ("mask", "the masks", title)
        for row, ((kind, text, of), pixels) in enumerate(zip(kinds, pictures[level])):
            name = f"{kind}_{level}"
            s.table(name, f"{text} at {per_m}", column=(across, "px", "column of the pixel"), row=(rows, "px", "row of the pixel"),
                    colour=(pixels[rows * columns + across], "1", "red * 65536 + green * 256 + blue"))
            s.panel(of, "", "", [image(name, "column", "row", z="colour")], at=(row, column), equal_aspect=True,
                    x_range=(LEFT - 0.5, RIGHT - 0.5), y_range=(BOTTOM - 0.5, TOP - 0.5))  # rows count downwards


def lost_at_per_m(of):
    """The lowest level at which most of a valve is missed; infinite if there is none."""
    return min(of.turbidity[~(of.recall >= 0.5)], default=np.inf)


def add_claims(s, scored):
    for name, of in scored.items():
        claims = s.claims(f"the {name} valve")
        clear, usual, turbid = (of.where(turbidity=per_m) for per_m in (0, DEFAULT_PER_M, 3))
        claims.at_least(" is found in clear water: recall", clear.recall[0], 0.99, "fraction")
        claims.at_least(" is not confused with other things in clear water: precision", clear.precision[0], 0.99, "fraction")
        claims.at_least(" is found at a turbidity of 0.6 per metre: recall", usual.recall[0], 0.95, "fraction")
        claims.at_least(" is not confused with other things at a turbidity of 0.6 per metre: precision", usual.precision[0], 0.95,
                        "fraction")
        claims.at_most(" is found less in more turbid water: largest rise of recall from a level to the next",
                       np.diff(of.recall).max(initial=0), 0.01, "fraction")
        claims.at_most(" has less depth in more turbid water: largest rise of the share with depth from a level to the next",
                       np.diff(of.depth_fraction).max(initial=0), 0.01, "fraction")
        claims.at_least(" is not confused with other things where 100 pixels or more are picked: smallest precision",
                        min(of.precision[of.picked >= ENOUGH_PICKED], default=np.nan), 0.95, "fraction")
        claims.at_most(" is missed at a turbidity of 3 per metre: recall", turbid.recall[0], 0.05, "fraction")
    s.claims().at_most("the yellow valve is missed in water that is no more turbid than for the red one: turbidity at which most "
                       "pixels are missed, yellow minus red", np.subtract(*map(lost_at_per_m, (scored["yellow"], scored["red"]))),
                       0, "1/m")


if __name__ == "__main__":
    sys.exit(main())
