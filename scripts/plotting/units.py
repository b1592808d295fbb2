"""Shows the lengths of a figure in mm."""
import dataclasses

from .typeset import SHOWN_UNITS, in_mm, in_shown_unit, without_json


def shown_column(column):
    """None stays None."""
    if column is None or column.units not in SHOWN_UNITS:
        return column
    factor, units = SHOWN_UNITS[column.units]
    return dataclasses.replace(column, values=factor * column.values, units=units)


def shown_curve(curve):
    columns = {name: shown_column(getattr(curve, name)) for name in ("x", "y", "z")}
    factor = SHOWN_UNITS.get(curve.x.units, (1, ""))[0]
    return dataclasses.replace(curve, **columns, radius=factor * curve.radius, label=in_mm(without_json(curve.label)))


def shown_panel(panel):
    """Ranges are in the units of the columns."""
    x, y = ({getattr(curve, axis).units for curve in panel.curves} for axis in ("x", "y"))
    factors = [SHOWN_UNITS.get(next(iter(units), ""), (1, ""))[0] for units in (x, y)]
    ranges = [[factor * limit for limit in limits] for factor, limits in zip(factors, (panel.x_range, panel.y_range))]
    return dataclasses.replace(panel, curves=[shown_curve(curve) for curve in panel.curves], title=in_mm(panel.title),
                               x_label=in_shown_unit(panel.x_label), y_label=in_shown_unit(panel.y_label),
                               x_range=ranges[0], y_range=ranges[1])


def in_shown_units(figure):
    return dataclasses.replace(figure, panels=[shown_panel(panel) for panel in figure.panels])
