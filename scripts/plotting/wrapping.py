"""Breaks words into lines that are as wide as they are drawn."""
import functools
import re

from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.cbook import is_math_text
from matplotlib.font_manager import FontProperties

from .style import HEADING_PT, PNG_DPI, RC, TEXT_PT
from .typeset import typeset

NARROWEST_IN = 0.5  # the least width of a line
TITLE, HEADING = ("bold", TEXT_PT), ("normal", HEADING_PT)  # weight and size
TEXT = ("normal", TEXT_PT)
PARTS = re.compile(r"\\.|\$(?:[^$\\]|\\.)*\$|.")  # of a word: a dollar sign, a formula, a letter


@functools.cache
def renderer():
    return RendererAgg(1, 1, PNG_DPI)


@functools.lru_cache(maxsize=10000)
def text_width_in(words, font=TEXT):
    """Returns the width of words that typeset() returned."""
    weight, size = font
    is_math = is_math_text(words)
    shown = words if is_math else words.replace(r"\$", "$")
    properties = FontProperties(family=RC["font.sans-serif"], weight=weight, size=size)
    return renderer().get_text_width_height_descent(shown, properties, is_math)[0] / PNG_DPI


def pieces(word, width_in, font):
    """A word that is wider than a line is broken, but none of its formulas."""
    if text_width_in(word, font) <= width_in:
        return [word]
    lines = [""]
    for part in PARTS.findall(word):
        if lines[-1] and text_width_in(lines[-1] + part, font) > width_in:
            lines.append("")
        lines[-1] += part
    return lines


def folded(words, width_in, font=TEXT):
    """Breaks words that typeset() returned, at spaces. No formula has a space."""
    width_in, lines = max(width_in, NARROWEST_IN), []
    for word in (piece for word in re.split("[ \n]+", words) for piece in pieces(word, width_in, font)):
        if lines and text_width_in(f"{lines[-1]} {word}", font) <= width_in:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    return "\n".join(lines)


def wrapped(words, width_in, font=TEXT):
    return folded(typeset(words), width_in, font)
