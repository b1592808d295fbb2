"""Reads a style file of the user, which replaces sizes, the font and colours of style.py."""
import json
import re
import string

from . import style
from .plot_error import PlotError

RANGES = {"text_pt": (6, 14), "column_in": (2, 8), "page_in": (4, 12)}  # of numbers
HELP = ('file of JSON with any of "text_pt" (6 to 14), "column_in" (2 to 8) and "page_in" (4 to 12), widths of pictures; '
        '"font", a family that is installed; "colours", an object of names and #rrggbb. Names: '
        + ", ".join(style.COLOURS))


def has_letters(font):
    """Returns whether a font of this name is installed and has letters and digits. In a font of symbols their places may
    be taken by glyphs with names such as `prime`."""
    from matplotlib.font_manager import FontProperties, findfont, fontManager, get_font
    if font.lower() not in {each.name.lower() for each in fontManager.ttflist}:
        return False
    found = get_font(findfont(FontProperties(family=font)))
    known = found.get_charmap()
    return (all(ord(letter) in known for letter in string.ascii_letters + string.digits) and
            not any(re.fullmatch("[A-Za-z]{2,}", found.get_glyph_name(known[ord(letter)])) for letter in "az"))


def fault(key, value):
    """What is wrong with an entry, in words, or nothing."""
    if key in RANGES:
        low, high = RANGES[key]
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return "" if is_number and low <= value <= high else f"expected a number from {low} to {high}"
    if key == "font":
        return "" if isinstance(value, str) and has_letters(value) else "expected a font that is installed and has letters"
    if key != "colours":
        return f"unknown: expected {', '.join([*RANGES, 'font', 'colours'])}"
    if not isinstance(value, dict):
        return "expected an object of names and colours"
    for name, colour in value.items():
        if name not in style.COLOURS:
            return f"{name}: unknown: expected one of {', '.join(style.COLOURS)}"
        if not (isinstance(colour, str) and re.fullmatch(r"#[0-9a-fA-F]{6}", colour)):
            return f"{name}: {colour!r}: expected #rrggbb"
    return ""


def use(path):
    """Call it before a module is imported that draws."""
    try:
        own = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise PlotError(f"--style {path}: {error}") from None
    if not isinstance(own, dict):
        raise PlotError(f"--style {path}: expected an object of JSON")
    for key, value in own.items():
        if words := fault(key, value):
            raise PlotError(f"--style {path}: {key}: {words}")
    style.COLOURS.update(own.get("colours", {}))
    style.COLUMN_IN, style.PAGE_IN = own.get("column_in", style.COLUMN_IN), own.get("page_in", style.PAGE_IN)
    style.set_text(own.get("text_pt", style.TEXT_PT), own.get("font"))
