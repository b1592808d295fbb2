"""The small pictures of a scorecard's page: successes over noise, a line for each method."""
from .claims import esc
from .style import DASHES, MARKERS, method_looks, page_colour

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 420, 190, 34, 8, 8, 26

CSS = """
svg { width: 420px; max-width: 100%; height: 190px; font-size: 11px; } svg text { fill: currentColor; opacity: .75; }
svg.key { width: 28px; height: 10px; margin-right: 5px; }
.grid { stroke: #8884; fill: none; } .line { fill: none; stroke-width: 1.4; } .bar { stroke-width: 1; fill: none; }
"""

# Paths of markers about the origin, by the names that matplotlib has for them.
SHAPES = {"o": "M-2.6 0a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0-5.2 0z", "s": "M-2.4-2.4h4.8v4.8h-4.8z", "^": "M0-3.1l3 5.4h-6z",
          "D": "M0-3.3l3.3 3.3l-3.3 3.3l-3.3-3.3z", "v": "M0 3.1l3-5.4h-6z",
          "P": "M-1.1-3h2.2v1.9h1.9v2.2h-1.9v1.9h-2.2v-1.9h-1.9v-2.2h1.9z"}


def dash_array(look):
    dash = DASHES[look.dash]
    return "none" if dash == "solid" else " ".join(f"{length:g}" for length in dash[1])


def looks_css(names):
    """A method has one colour and dash everywhere on the page, those of the figures."""
    return "".join(f".c{c} path {{ stroke: {page_colour(look.colour)}; }} .c{c} .line {{ stroke-dasharray: {dash_array(look)}; }} "
                   f".c{c} use {{ fill: {page_colour(look.colour)}; }}\n" for c, look in enumerate(method_looks(names)))


def shapes(names):
    """The marker of each method, to be used by all plots of the page."""
    paths = "".join(f'<path id="m{c}" d="{SHAPES[MARKERS[look.marker]]}"/>' for c, look in enumerate(method_looks(names)))
    return f'<svg style="display:none"><defs>{paths}</defs></svg>'


def key(method):
    """A piece of a method's line, beside its name."""
    return (f'<svg class="key" viewBox="0 0 28 10" aria-hidden="true"><g class="c{method}"><path class="line" d="M0 5H28"/>'
            f'<use href="#m{method}" x="14" y="5"/></g></svg>')


def level_text(noise_m, radius_m):
    """A noise level in units of r_c; None: the scene's own."""
    return "own" if noise_m is None else f"{round(noise_m / radius_m, 3):g}"


class Axes:
    """Noise levels at equal distances, methods beside each other: so their intervals can be told apart."""

    def __init__(self, levels, methods):
        self.step, self.methods = (WIDTH - LEFT - RIGHT) / levels, methods

    def middle(self, level):
        return LEFT + self.step * (level + 0.5)

    def x(self, level, method):
        beside = (method + 0.5) / self.methods - 0.5  # -0.5 .. 0.5
        return LEFT + self.step * (level + 0.5 + 0.6 * beside)

    def y(self, fraction):
        return TOP + (HEIGHT - TOP - BOTTOM) * (1 - fraction)


def grid(axes, levels):
    lines = [f'<path class="grid" d="M{LEFT} {axes.y(fraction):.1f}H{WIDTH - RIGHT}"/>'
             f'<text x="{LEFT - 4}" y="{axes.y(fraction) + 4:.1f}" text-anchor="end">{fraction:g}</text>'
             for fraction in (0, 0.5, 1)]
    words = [f'<text x="{axes.middle(i):.1f}" y="{HEIGHT - 8}" text-anchor="middle">{esc(level)}</text>'
             for i, level in enumerate(levels)]
    return "".join(lines + words)


def line_of(shares, axes, method):
    """The line of a method with its intervals; shares: of each level."""
    at = [(axes.x(i, method), share) for i, share in enumerate(shares)]
    line = "L".join(f"{x:.1f} {axes.y(share['fraction']):.1f}" for x, share in at)
    bars = "".join(f"M{x:.1f} {axes.y(share['low']):.1f}V{axes.y(share['high']):.1f}" for x, share in at)
    dots = "".join(f'<use href="#m{method}" x="{x:.1f}" y="{axes.y(share["fraction"]):.1f}"/>' for x, share in at)
    return f'<g class="c{method}"><path class="line" d="M{line}"/><path class="bar" d="{bars}"/>{dots}</g>'


def noise_plot(methods, levels):
    """Inline SVG. methods: of each the shares of all levels; levels: their words."""
    axes = Axes(len(levels), len(methods))
    lines = "".join(line_of(shares, axes, c) for c, shares in enumerate(methods))
    return (f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
            'aria-label="share of successes over noise in units of r_c">'
            f"{grid(axes, levels)}{lines}</svg>")
