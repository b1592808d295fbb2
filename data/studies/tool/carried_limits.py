"""Strength (a speed, an angle, an acceleration) up to which a surface carries a plate, by each contact rule: limits that are
measured in sweeps, and limits that are derived."""
import numpy as np

from remote_touch.studies import dashed, dots, intervals

RULES = {"voxels": "as printed", "look_ahead": "look-ahead", "continuous": "continuous"}  # columns and labels, as in the sweeps
FRAMES_HZ = 30
VOXEL_M, FRAME_REACH_M, DISK_RADIUS_RATIO = 0.0005, 0.02, 0.75  # defaults of renderer tool


def jump_m(rule, thickness_m, drop_m=0, rise_m=0):
    """Largest jump of a surface along the thickness h of a plate before the plate is lost. Under the plate, the surface falls by
    drop_m below the touched place, and rises by rise_m above it. The printed rule counts the interior of the plate, h - 2 w
    (6.2.4); look-ahead the whole plate; the continuous rule also the way out, along which the highest place must become free."""
    if rule == "voxels":
        return thickness_m - 2 * VOXEL_M + drop_m
    through_m = thickness_m + drop_m
    return through_m if rule == "look_ahead" else max(through_m, FRAME_REACH_M - rise_m)


class Carried:
    """A sweep with the measure tool_popped_through. Its last axis is the rule, the axis before it a strength, rising. A setting is
    a combination of values of the axes before these two.

    popped: by setting, strength, rule and replicate; NaN: unknown. settings: the values of the first axis.
    """

    def __init__(self, sweep):
        popped = sweep.tool_popped_through
        self.settings, self.strengths = (sweep[popped.dims[axis]].values for axis in (0, -3))
        self.popped = popped.values.reshape(-1, *popped.shape[-3:])

    def counts(self, rule):
        """For each setting and strength: the numbers of runs that are lost, carried, and unknown."""
        lost = self.popped[:, :, [*RULES].index(rule)]
        return np.stack([(lost > 0.5).sum(axis=2), (lost <= 0.5).sum(axis=2), np.isnan(lost).sum(axis=2)], axis=2)

    def limits(self, rule):
        """For each setting: the strength up to which every run is carried (NaN: none), the next one, at which a run is lost, and
        that from which on all runs are lost (infinite: none)."""
        lost, carried, unknown = np.moveaxis(self.counts(rule), 2, 0)
        all_lost = (lost > 0) & (carried == 0)
        from_here_on = np.logical_and.accumulate(all_lost[:, ::-1], axis=1)[:, ::-1]
        below, above = np.append(np.nan, self.strengths), np.append(self.strengths, np.inf)
        first, first_unknown = first_true(lost > 0), first_true(unknown > 0)
        first_lost = np.where(first_unknown < first, np.nan, above[first])  # an unknown run may be a lost one
        return below[np.minimum(first, first_unknown)], first_lost, above[first_true(from_here_on)]


def first_true(rows):
    """The index of the first true value in each row; the length of the row if there is none."""
    return np.where(rows.any(axis=1), rows.argmax(axis=1), rows.shape[1])


def rows_apart(rows, carried, lost, low, high):
    """The number of rows in which a limit is not between two columns: a run is lost below `low`, or carried above `high`, or a
    limit is NaN. `carried` is NaN where nothing is carried."""
    return np.sum(np.isnan(rows[low] + rows[high] + rows[lost]) | (rows[lost] < rows[low]) | (rows[carried] > rows[high]))


def draw_limits(s, table, title, setting, settings, units, derived, x_label, y_label, samples=61, **frame):
    """A panel over the setting. The limits that are derived for a rule, derived(rule, setting), are dashed, from a table of so many
    evenly spaced samples (more than 20: lines of fewer samples have markers). The strengths up to which every run is carried are
    dots, with a bar to the next strength, at which a run is lost.

    setting: name, units and meaning of the first column of the table. settings: its values.
    """
    name, setting_units, meaning = setting
    dense, curves = settings[0] + np.arange(samples) * ((settings[-1] - settings[0]) / (samples - 1)), []
    s.table(f"{table}_bounds", f"{title}: derived limits", {
        name: (dense, setting_units, meaning),
        **{f"{rule}_bound": ([derived(rule, value) for value in dense], units, "derived limit") for rule in RULES}})
    for rule, label in RULES.items():
        curves += [dashed(f"{table}_bounds", name, f"{rule}_bound", f"{label}, derived"),
                   intervals(table, name, f"{rule}_carried", z=f"{rule}_first_lost"), dots(table, name, f"{rule}_carried", label)]
    s.panel(title, x_label, y_label, curves, **frame)
