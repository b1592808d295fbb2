"""Sets words as print has them: r_c with a subscript, m/s^2 with a superscript, lengths in mm. A dollar sign in a name
stays a dollar sign."""
import html
import re
import textwrap

GREEK = {"sigma": "σ", "beta": "β", "tau": "τ", "lambda": "λ", "alpha": "α", "mu": "µ"}
SYMBOL = re.compile(rf"\b({'|'.join(GREEK)}|[A-Za-z])_([A-Za-z0-9]{{1,3}})\b")
POWER = re.compile(r"\^(?:\((-?\d+)\)|(-?\d+))")
SHOWN_UNITS = {"m": (1000, "mm")}  # factor, and the unit that is shown
UNIT_WORDS = {"deg": "°", "us": "µs", "N m": "N·m", "N s/m": "N·s/m"}
LENGTH = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?) m(?![\w/^·])")
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff\ufffe\uffff]")  # neither XML nor a font has these


def symbol(match):
    letter, index = match.groups()
    if index == "hat":
        return rf"$\hat{{{letter}}}$"
    letter = f"\\{letter}" if letter in GREEK else letter
    return rf"${letter}_\mathrm{{{index}}}$"


def typeset(words):
    """As matplotlib draws it, with mathematics between dollar signs."""
    words = POWER.sub(r"$^{\1\2}$", CONTROL.sub("?", words).replace("$", r"\$"))
    words = re.sub(r" - (?=\S)", " \u2212 ", words)
    words = re.sub(r"(?<=[ (])-(?=\d)", "\u2212", words)
    words = re.sub(r"(?<=\w) x (?=\w)", " × ", words)
    words = re.sub(r"\blog10\b", "log$_{10}$", words)
    words = SYMBOL.sub(symbol, words)
    words = re.sub(rf"\b({'|'.join(GREEK)})\b(?![}}_])", lambda match: GREEK[match[1]], words)
    return re.sub(r"(\d) deg\b", r"\1°", words)


def html_symbol(match):
    letter, index = match.groups()
    letter = GREEK.get(letter, letter)
    return f"<i>{letter}&#x302;</i>" if index == "hat" else f"<i>{letter}</i><sub>{index}</sub>"


def typeset_html(words):
    """As a page shows it. No words make another tag than those of symbols."""
    words = SYMBOL.sub(html_symbol, html.escape(str(words), quote=True))
    words = re.sub(rf"\b({'|'.join(GREEK)})\b", lambda match: GREEK[match[1]], words)
    return POWER.sub(r"<sup>\1\2</sup>", words)


def wrapped(words, letters):
    """In lines of so many letters."""
    return "\n".join(typeset(line) for line in textwrap.wrap(words, max(letters, 8), break_on_hyphens=False))


def in_mm(words):
    """0.025 m as 25 mm."""
    return LENGTH.sub(lambda match: f"{1000 * float(match[1]):g} mm", words)


def unit_words(unit):
    return UNIT_WORDS.get(unit, unit)


def with_unit(label, unit):
    """The label with its unit in parentheses, or the label alone if it has one already."""
    if unit in ("", "1") or label == unit:
        return label
    shown = "|".join(map(re.escape, {unit, unit_words(unit)}))
    written = re.search(rf"\(({shown})\)$|\bin ({shown})\b", label)
    return label if written else f"{label} ({unit_words(unit)})".strip()


def in_shown_unit(label):
    """The label of an axis whose values are shown in another unit than they are stored in."""
    unit = re.search(r"\(([^()]*)\)$", label)
    if not unit:
        return label
    shown = SHOWN_UNITS.get(unit[1], (1, unit_words(unit[1])))[1]
    return f"{label[:unit.start()]}({shown})"
