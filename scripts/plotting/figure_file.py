"""Reads a figure file: HDF5 of the schema remote-touch-figure/3, which analysis/storage/result_file.cpp writes."""
import dataclasses
import math
import re

import h5py
import numpy as np

from .plot_error import PlotError

SCHEMA = "remote-touch-figure/3"
STYLES = ("line", "dashed", "steps", "dots", "circle", "bars", "squares", "map", "band", "intervals", "image", "surface",
          "letters")
NEED_Z = ("map", "band", "intervals", "image", "surface", "letters")
FRACTION = re.compile(r"(fraction|share|probability) of |1 when ")


@dataclasses.dataclass
class Column:
    values: np.ndarray
    units: str
    long_name: str
    names: dict  # of an enum: value -> name
    is_log: bool = False  # of an axis: equal ratios are equally wide
    limits: tuple | None = None  # of colours, where several maps have the same

    @property
    def is_fraction(self):
        """As its name declares: values between 0 and 1 may be anything, lengths in metres for example."""
        return self.units == "1" and FRACTION.match(self.long_name) is not None

    @property
    def is_count(self):
        values = self.values[np.isfinite(self.values)]
        return self.units in ("", "1") and values.size > 0 and not self.is_fraction and (values == np.round(values)).all()


@dataclasses.dataclass(eq=False)
class Curve:
    x: Column
    y: Column
    style: str
    label: str
    radius: float
    z: Column | None  # colours of a map or an image, other edge of a band or an interval, heights of a surface, names of letters; or None


@dataclasses.dataclass
class ScenePart:
    kind: str  # points, segments or solid
    table: dict  # columns as arrays
    triangles: np.ndarray | None  # rows of three vertices, of a solid
    pose: np.ndarray | None  # of a solid: x, y, z, and w, x, y, z of a quaternion
    colour: int
    size: float
    opacity: float
    label: str
    coloured_by: Column | None = None  # values of points that a colour bar shows

    def columns(self, *names):
        return np.stack([self.table[name] for name in names], axis=-1)


@dataclasses.dataclass
class Scene:
    eye: np.ndarray
    target: np.ndarray
    up: np.ndarray
    width: float
    proportion: float
    parts: list


@dataclasses.dataclass
class Panel:
    title: str
    x_label: str
    y_label: str
    equal_aspect: bool
    x_range: list  # NaN: automatic
    y_range: list
    place: tuple  # (row, column), or None: below the panel before
    curves: list
    scene: Scene | None  # drawn instead of curves


@dataclasses.dataclass
class Figure:
    name: str  # of the files: fig4.11
    attributes: dict
    panels: list
    width_in: float = 0  # of the picture, once it is drawn

    @property
    def heading(self):
        if "heading" in self.attributes:  # of what is no figure
            return self.attributes["heading"]
        name = self.attributes.get("figure") or self.name.removeprefix("fig")
        number = f"Equation {name[2:]}" if name.startswith("eq") else f"Figure {name}"
        title = self.attributes.get("title", "")
        if name == "analysis" and title:  # of a sweep, and no figure with a number
            return title[:1].upper() + title[1:]
        return f"{number}: {title}" if title else number


def text(attributes, name, default=""):
    """An attribute as a string, however the writer stored it."""
    value = attributes.get(name, default)
    if isinstance(value, np.ndarray):
        value = value.flat[0] if value.size else default
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def number(attributes, name, default):
    return float(np.ravel(attributes.get(name, default))[0])


def pair(attributes, name):
    values = np.ravel(attributes.get(name, [math.nan, math.nan])).astype(float)
    return list(values) if values.size == 2 else [math.nan, math.nan]


def numbered(group, prefix):
    """The members prefix0, prefix1, ... of a group, in the order of their numbers."""
    found = [name for name in group if re.fullmatch(prefix + r"\d+", name)]
    return [group[name] for name in sorted(found, key=lambda name: int(name[len(prefix):]))]


def enum_names(data):
    """value -> name, of a dataset of named values"""
    return {value: name for name, value in (h5py.check_enum_dtype(data.dtype) or {}).items()}


def read_column(file, table, name):
    path = f"/tables/{table}/{name}"
    if path not in file or not isinstance(file[path], h5py.Dataset):
        raise PlotError(f"{file.filename}: a curve asks for {path}, which is not there")
    data = file[path]
    values = np.ravel(data[()]).astype(float)
    return Column(values, text(data.attrs, "units"), text(data.attrs, "long_name"), enum_names(data))


def read_curve(file, group):
    table = text(group.attrs, "table")
    x = read_column(file, table, text(group.attrs, "x"))
    y = read_column(file, table, text(group.attrs, "y"))
    style = text(group.attrs, "style", "line")
    if style not in STYLES:
        raise PlotError(f"{file.filename}: {group.name}: style {style!r}: expected {', '.join(STYLES)}")
    if style in NEED_Z and not text(group.attrs, "z"):
        raise PlotError(f"{file.filename}: {group.name}: style {style!r} needs z, the name of a third column")
    z = read_column(file, table, text(group.attrs, "z")) if style in NEED_Z else None
    if any(column.values.size != x.values.size for column in (y, z) if column):
        raise PlotError(f"{file.filename}: {group.name}: {'x, y and z' if z else 'x and y'} differ in length")
    return Curve(x, y, style, text(group.attrs, "label"), number(group.attrs, "radius", 0), z)


def read_table(file, name):
    path = f"/tables/{name}"
    if path not in file:
        raise PlotError(f"{file.filename}: a picture asks for {path}, which is not there")
    return {column: np.ravel(data[()]) for column, data in file[path].items()}


def rows(table, *names):
    return np.stack([table[name] for name in names], axis=-1)


def read_part(file, group):
    a = group.attrs
    triangles = pose = None
    if text(a, "kind") == "solid":
        triangles = rows(read_table(file, text(a, "triangles")), "a", "b", "c").astype(int)
        poses = read_table(file, text(a, "poses"))
        pose = rows(poses, "x", "y", "z", "qw", "qx", "qy", "qz")[int(number(a, "pose_row", 0))]
    values = text(a, "coloured_by")  # files of earlier versions have no such attribute
    return ScenePart(text(a, "kind"), read_table(file, text(a, "table")), triangles, pose,
                     int(number(a, "colour", 0)), number(a, "size", 0), number(a, "opacity", 1), text(a, "label"),
                     read_column(file, text(a, "table"), values) if values else None)


def read_scene(file, group):
    a = group.attrs
    eye, target, up = (np.ravel(a[name]).astype(float) for name in ("eye", "target", "up"))
    parts = [read_part(file, part) for part in numbered(group, "part")]
    return Scene(eye, target, up, number(a, "width", 1), number(a, "proportion", 0.75), parts)


def read_place(attributes):
    """Row and column, or None."""
    place = pair(attributes, "place")
    return None if math.isnan(place[0]) else (int(place[0]), int(place[1]))


def read_panel(file, group):
    a = group.attrs
    curves = [read_curve(file, curve) for curve in numbered(group, "curve")]
    return Panel(text(a, "title"), text(a, "x_label"), text(a, "y_label"), number(a, "equal_aspect", 0) != 0,
                 pair(a, "x_range"), pair(a, "y_range"), read_place(a), curves,
                 read_scene(file, group["scene"]) if "scene" in group else None)


def open_file(path):
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise PlotError(f"{path}: {error}") from None


def schema_of(path):
    with open_file(path) as file:
        return text(file.attrs, "schema")


def read_figure(path):
    """A figure without panels is one that could not be run; its caption says why."""
    with open_file(path) as file:
        panels = [read_panel(file, group) for group in numbered(file.get("panels", {}), "")]
        return Figure(path.stem, {name: text(file.attrs, name) for name in file.attrs}, panels)
