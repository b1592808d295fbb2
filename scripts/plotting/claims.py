"""Reads claims.json and writes the claims as HTML."""
import html
import json
import os
import re
import sys
import urllib.parse

from .plot_error import PlotError
from .typeset import SHOWN_UNITS, in_mm, typeset_html, unit_words

DISSERTATION = "the dissertation"
COLUMNS = {"claim": "Claim", "paper": "Dissertation", "measured": "Measured", "criterion": "Criterion", "unit": "Unit"}
NOTHING = {"paper": ("-",), "unit": ("1", None)}  # the cell stays empty
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
BESIDE = ("at", "most", "least", "from", "to", "up", "expected", "here:", ">=", "<=", "=", "r_c", "-", "")  # numbers of a claim
SHORT = 24  # a cell of so few characters stays on one line


def read_claims(path):
    if not path.exists():
        print(f"plot: {path} is not there: the page shows no claims", file=sys.stderr)
        return []
    try:
        claims = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise PlotError(f"{path}: {error}") from None
    if not isinstance(claims, list) or not all(isinstance(claim, dict) for claim in claims):
        raise PlotError(f"{path}: not a list of claims")
    return claims


def esc(value):
    return html.escape(str(value), quote=True)


def address(name):
    """Of a file beside the page, whose name may have any character."""
    return esc(urllib.parse.quote(os.fsencode(name)))


def value_text(value):
    if value is None:
        return "\u2013"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list):
        return ", ".join(value_text(item) for item in value)
    return str(value)


def figure_of(claim):
    return "fig" + str(claim.get("figure", "")).removeprefix("fig")


def verdict(claim):
    """(CSS class, word)"""
    word = str(claim.get("verdict", "not run"))
    return (word if word in ("pass", "fail", "differs") else "none"), word.upper() if word == "fail" else word


def is_set_up(claim):
    return claim.get("set_up") is True


def in_shown_unit(claim):
    """The claim as the axes of figures have it: with lengths in mm, if it is one of numbers only."""
    stored, measured = claim.get("unit"), claim.get("measured")
    if not isinstance(stored, str):
        return claim
    if stored not in SHOWN_UNITS:
        return claim | {"unit": unit_words(stored)}
    said = {name: str(claim[name]) for name in ("criterion", "paper") if name in claim}
    is_plain = all(word in BESIDE or NUMBER.fullmatch(word) for words in said.values() for word in words.split())
    if not is_plain or isinstance(measured, bool) or not isinstance(measured, (int, float)):
        return claim
    factor, unit = SHOWN_UNITS[stored]
    scaled = {name: NUMBER.sub(lambda each: f"{factor * float(each[0]):.6g}", words) for name, words in said.items()}
    return claim | scaled | {"measured": factor * measured, "unit": unit}


def claim_row(anchor, claim):
    cells, claim = [], in_shown_unit(claim)
    for name in COLUMNS:
        value = claim.get(name)
        shown = "" if value in NOTHING.get(name, ()) else value_text(value)
        style = " class=number" if name == "measured" else " class=short" if len(shown) <= SHORT else ""
        cells.append(f"<td{style}>{typeset_html(in_mm(shown))}</td>")
    style, word = verdict(claim)
    return f'<tr id="{esc(anchor)}">{"".join(cells)}<td class="verdict {style}">{esc(word)}</td></tr>'


def source(claim):
    """Files of earlier versions name no source."""
    return str(claim.get("source", DISSERTATION))


def source_heading(name):
    """Heading of a column: the source without its article."""
    words = name.removeprefix("the ")
    return words[:1].upper() + words[1:]


def table(rows, sources=(DISSERTATION,)):
    names = {**COLUMNS, "paper": ", ".join(source_heading(name) for name in sources)}
    head = "".join(f"<th{' class=number' if name == 'measured' else ''}>{esc(words)}</th>"
                   for name, words in [*names.items(), ("verdict", "Verdict")])
    body = "\n".join(rows)
    return f"<div class=table><table><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table></div>"


def claim_table(anchored):
    """The claims of a figure; below them, apart, what only says that its runs are what they were meant to be."""
    claims = [claim_row(anchor, claim) for anchor, claim in anchored if not is_set_up(claim)]
    checks = [claim_row(anchor, claim) for anchor, claim in anchored if is_set_up(claim)]
    sources = sorted({source(claim) for _, claim in anchored}) or [DISSERTATION]
    parts = [table(claims, sources) if claims else "<p class=none>No claims.</p>"]
    if checks:
        parts.append(f"<p class=none>Checks of the set-up, no claims:</p>\n{table(checks, sources)}")
    return "\n".join(parts)


def differing_from(name, anchored):
    """The values of one source that this program does not give."""
    rows = []
    for anchor, claim in ((anchor, in_shown_unit(claim)) for anchor, claim in anchored):
        unit = "" if claim.get("unit") in NOTHING["unit"] else f" {claim['unit']}"
        rows.append(f'<tr><td class=short><a href="#{esc(anchor)}">{esc(claim.get("figure", ""))}</a></td>'
                    f'<td>{typeset_html(claim.get("claim", ""))}</td><td>{typeset_html(claim.get("paper", ""))}</td>'
                    f'<td class=number>{typeset_html(value_text(claim.get("measured")) + unit)}</td></tr>')
    body = "\n".join(rows)
    heading = ("<h2 id=differs>What the dissertation prints and this program does not give</h2>" if name == DISSERTATION
               else f"<h2>Values of {esc(name)} that differ here</h2>")
    return (f"{heading}\n<div class=table><table>"
            f"<thead><tr><th>Figure</th><th>What</th><th>{esc(source_heading(name))}</th><th class=number>Measured here</th></tr></thead>"
            f"<tbody>\n{body}\n</tbody></table></div>")


def by_source(anchored):
    """The claims that differ, of each source; the dissertation comes first."""
    lists = {}
    for anchor, claim in anchored:
        if verdict(claim)[1] == "differs":
            lists.setdefault(source(claim), []).append((anchor, claim))
    return dict(sorted(lists.items(), key=lambda item: (item[0] != DISSERTATION, item[0])))


def differing_words(lists):
    """The dissertation is named even if no claim differs from it."""
    counts = {DISSERTATION: 0} | {name: len(claims) for name, claims in lists.items()}
    return "".join(f", {count} differ from {esc(name)}" for name, count in counts.items())


def overview(anchored):
    claims = [one for one in anchored if not is_set_up(one[1])]
    words = [verdict(claim)[1] for _, claim in claims]
    failed = [(anchor, claim) for anchor, claim in anchored if verdict(claim)[1] == "FAIL"]
    style = "fail" if failed else "pass"
    lists = by_source(anchored)
    lines = [f'<p class="count"><span class="{style}">{words.count("pass")} of {len(words)} claims pass</span>'
             f'{differing_words(lists)}, {words.count("FAIL")} failed, '
             f'{words.count("open")} open, {words.count("not run")} not run.</p>',
             "<p class=none>A claim is a statement about a figure with a criterion for a measured number. Differs: the source of "
             "the figure, which is the dissertation unless another one is named, has another value. Open: measured on a part "
             "of the runs only. Not run: a recording is missing.</p>"]
    if failed:
        items = "\n".join(f'<li><a href="#{esc(anchor)}">{esc(claim.get("figure", ""))}: '
                          f'{typeset_html(claim.get("claim", ""))}</a></li>' for anchor, claim in failed)
        lines.append(f"<p class=fail>Failed:</p>\n<ul>\n{items}\n</ul>")
    lines.extend(differing_from(name, claims) for name, claims in lists.items())
    return "\n".join(line for line in lines if line)
