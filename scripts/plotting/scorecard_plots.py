"""The small pictures of a scorecard's page: successes over noise, a line for each method."""
from plotting.claims import esc

# Okabe and Ito's colours, which the colour-blind tell apart.
COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#999999")
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 420, 190, 34, 8, 8, 26

CSS = """
svg { width: 420px; height: 190px; font-size: 11px; } svg text { fill: #555; }
.grid { stroke: #e4e4e4; fill: none; } .line { fill: none; stroke-width: 1.4; opacity: .75; }
.bar { stroke-width: 1; opacity: .55; fill: none; }
i { display: inline-block; width: 10px; height: 10px; border-radius: 5px; margin-right: 5px; }
"""


def colours_css(methods):
    """A method has one colour, by its place, everywhere on the page."""
    colours = [COLOURS[c % len(COLOURS)] for c in range(methods)]
    return "".join(f".c{c} path {{ stroke: {colour}; }} .c{c} circle {{ fill: {colour}; }} "
                   f".k{c} {{ background: {colour}; }}\n" for c, colour in enumerate(colours))


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
    dots = "".join(f'<circle cx="{x:.1f}" cy="{axes.y(share["fraction"]):.1f}" r="2.6"/>' for x, share in at)
    return f'<g class="c{method}"><path class="line" d="M{line}"/><path class="bar" d="{bars}"/>{dots}</g>'


def noise_plot(methods, levels):
    """Inline SVG. methods: of each the shares of all levels; levels: their words."""
    axes = Axes(len(levels), len(methods))
    lines = "".join(line_of(shares, axes, c) for c, shares in enumerate(methods))
    return (f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
            'aria-label="share of successes over noise in units of r_c">'
            f"{grid(axes, levels)}{lines}</svg>")
