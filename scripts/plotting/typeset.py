"""Sets words as print has them: r_c with a subscript, m/s^2 with a superscript, lengths in mm, settings without JSON. A
dollar sign in a name stays a dollar sign."""
import html
import json
import re

GREEK = {"sigma": "σ", "beta": "β", "tau": "τ", "lambda": "λ", "alpha": "α", "mu": "µ"}
SYMBOL = re.compile(rf"\b({'|'.join(GREEK)}|[A-Za-z])_([A-Za-z0-9]{{1,3}})\b")
POWER = re.compile(r"\^(?:\((-?\d+)\)|(-?\d+))")
VARIABLE = re.compile(r"(?<![\w\\{}_^$#&=-])(?:([xyzhvu])|(M)(?= of\b))(?![\w$-])")  # no unit has these letters
SYMBOL_WITH_POWER = re.compile(rf"{SYMBOL.pattern}(?:{POWER.pattern})?")
VARIABLE_WITH_POWER = re.compile(rf"{VARIABLE.pattern}(?:{POWER.pattern})?")
TIMES = re.compile(r"(?<=[\w)])(?<!\babout)(?<!\balong)(?<!\b[aioO]n)(?<!\bof)(?<!\b[aiA]t) x (?=[\w(])")
SHOWN_UNITS = {"m": (1000, "mm")}  # factor, and the unit that is shown
UNIT_WORDS = {"deg": "°", "us": "µs"}
PRODUCT = re.compile(r"[A-Za-z]{1,3}( [A-Za-z]{1,3})+(/\w+)?")  # of units, such as N m s/rad
LENGTH = re.compile(r"(?<![\w.])((?:\d+(?:\.\d+)?(?: to | or | x ))*\d+(?:\.\d+)?) (m|cm|micrometres|um)(?![\w/^·])")
DEGREES = re.compile(r"(?<=\d) deg\b")
NUMBER = re.compile(r"\d+(?:\.\d+)?")
EXPONENT = re.compile(r"(?<![\w.])(-?\d+(?:\.\d+)?)e([+-]?\d+)\b")
MM = {"m": 1000, "cm": 10, "micrometres": 0.001, "um": 0.001}  # in each unit
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff\ufffe\uffff]")  # neither XML nor a font has these


UNIT_OF_NAME = re.compile(r"_(kg_m2|Nm|Ns|m|s|hz|deg|kg|N|J)((?:_per_\w+)?)$", re.I)  # names of parameters end with it


def said(value):
    """A value of JSON in words: `penalty, stiffness 300 N/m` for {"name": "penalty", "stiffness_N_per_m": 300}."""
    if isinstance(value, dict):
        return ", ".join(said(each) if name == "name" else said_of(name, each) for name, each in value.items())
    if isinstance(value, list):
        return ", ".join(map(said, value))
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "none"}[value]
    return value if isinstance(value, str) else f"{value:.6g}"


def said_of(name, value):
    """One setting: `range 100, 200 mm` for "range_m": [0.1, 0.2]."""
    unit, words = UNIT_OF_NAME.search(name), UNIT_OF_NAME.sub("", name).replace("_", " ")
    each = value if isinstance(value, list) else [value]
    if not unit or not each or any(isinstance(one, (bool, dict, list)) for one in each):
        return f"{words} {said(value)}"
    of_all = re.sub(r"(?<=[a-z])2$", "^2", re.sub("hz", "Hz", unit[1].replace("_", " "), flags=re.I) + unit[2].replace("_per_", "/"))
    lengths = [in_mm(f"{said(one)} {of_all}") for one in each]
    unit_of_last = " " + lengths[-1].partition(" ")[2]
    return f"{words} {', '.join([*(one.removesuffix(unit_of_last) for one in lengths[:-1]), lengths[-1]])}"


def without_json(words):
    """Writes objects of JSON in words."""
    at = words.find('{"')
    while at >= 0:
        try:
            value, end = json.JSONDecoder().raw_decode(words, at)
            words, at = words[:at] + said(value) + words[end:], at + len(said(value))
        except (ValueError, RecursionError):
            at += 1
        at = words.find('{"', at)
    return words


def superscript(match):
    """Returns the power after a symbol or variable as mathematics; it is group 3 or 4 of the match."""
    return f"^{{{match[3] or match[4]}}}" if match[3] or match[4] else ""


def symbol(match):
    letter, index = match[1], match[2]
    if index == "hat":
        return rf"$\hat{{{letter}}}{superscript(match)}$"
    letter = f"\\{letter}" if letter in GREEK else letter
    return rf"${letter}_\mathrm{{{index}}}{superscript(match)}$"


def typeset(words):
    """As matplotlib draws it, with mathematics between dollar signs."""
    words = TIMES.sub(" × ", CONTROL.sub("?", without_json(words)).replace("$", r"\$"))
    words = SYMBOL_WITH_POWER.sub(symbol, words)
    words = VARIABLE_WITH_POWER.sub(lambda match: f"${match[1] or match[2]}{superscript(match)}$", words)
    words = POWER.sub(r"$^{\1\2}$", words)
    words = re.sub(r" - (?=\S)", " \u2212 ", words)
    words = re.sub(r"(?<=[ (])-(?=\d)", "\u2212", words)
    words = re.sub(r"\blog10\b", "log$_{10}$", words)
    words = re.sub(rf"\b({'|'.join(GREEK)})\b(?![}}_])", lambda match: GREEK[match[1]], words)
    return DEGREES.sub("°", words)


def html_symbol(match):
    letter, index = match.groups()
    letter = GREEK.get(letter, letter)
    return f"<i>{letter}&#x302;</i>" if index == "hat" else f"<i>{letter}</i><sub>{index}</sub>"


def typeset_html(words):
    """As a page shows it, 1e-05 as a power of ten. No words make another tag than those of symbols and powers."""
    words = TIMES.sub(" × ", html.escape(without_json(str(words)), quote=True))
    words = SYMBOL.sub(html_symbol, VARIABLE.sub(r"<i>\1\2</i>", words))
    words = re.sub(rf"\b({'|'.join(GREEK)})\b", lambda match: GREEK[match[1]], words)
    words = EXPONENT.sub(lambda match: f"{match[1]} × 10<sup>{int(match[2])}</sup>".replace("-", "\u2212"), words)
    return DEGREES.sub("°", POWER.sub(r"<sup>\1\2</sup>", words))


def in_mm(words):
    """Writes 0.025 m as 25 mm, and 3 cm as 30 mm. Lengths of 1 m and more are not changed."""
    def shown(match):
        numbers = [float(number) for number in NUMBER.findall(match[1])]
        if match[2] == "m" and max(numbers) >= 1:
            return match[0]
        return NUMBER.sub(lambda number: f"{MM[match[2]] * float(number[0]):g}", match[1]) + " mm"
    return LENGTH.sub(shown, words)


def capitalised(title):
    """But no symbol or name of a column: `x of the HIP`, `r_c`, `proxy_position`."""
    symbol = not title[:1].isascii() or not title[1:2].isalpha() or "_" in title.partition(" ")[0]
    return title if symbol else title[:1].upper() + title[1:]


def unit_words(unit):
    return unit.replace(" ", "·") if PRODUCT.fullmatch(unit) else UNIT_WORDS.get(unit, unit)


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
