"""Reads claims.json and writes the claims as HTML."""
import html
import json
import sys

from plotting.plot_error import PlotError

COLUMNS = {"claim": "Claim", "paper": "Dissertation", "measured": "Measured", "criterion": "Criterion", "unit": "Unit"}
NOTHING = {"paper": ("-",), "unit": ("1", None)}  # the cell stays empty
SHORT = 24  # a cell of so few characters stays on one line


def read_claims(path):
    if not path.exists():
        print(f"plot: {path} is not there: the page shows no claims", file=sys.stderr)
        return []
    try:
        claims = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise PlotError(f"{path}: {error}") from None
    if not isinstance(claims, list) or not all(isinstance(claim, dict) for claim in claims):
        raise PlotError(f"{path}: not a list of claims")
    return claims


def esc(value):
    return html.escape(str(value), quote=True)


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
    unjudged = "not run" if claim.get("measured") is None else "open"
    return {True: ("pass", "pass"), False: ("fail", "FAIL")}.get(claim.get("pass"), ("none", unjudged))


def claim_row(anchor, claim):
    cells = []
    for name in COLUMNS:
        value = claim.get(name)
        shown = "" if value in NOTHING.get(name, ()) else value_text(value)
        style = " class=number" if name == "measured" else " class=short" if len(shown) <= SHORT else ""
        cells.append(f"<td{style}>{esc(shown)}</td>")
    style, word = verdict(claim)
    return f'<tr id="{esc(anchor)}">{"".join(cells)}<td class="verdict {style}">{word}</td></tr>'


def claim_table(anchored):
    if not anchored:
        return "<p class=none>No claims.</p>"
    head = "".join(f"<th{' class=number' if name == 'measured' else ''}>{words}</th>"
                   for name, words in [*COLUMNS.items(), ("verdict", "Verdict")])
    rows = "\n".join(claim_row(anchor, claim) for anchor, claim in anchored)
    return f"<div class=table><table><thead><tr>{head}</tr></thead><tbody>\n{rows}\n</tbody></table></div>"


def overview(anchored):
    words = [verdict(claim)[1] for _, claim in anchored]
    failed = [(anchor, claim) for anchor, claim in anchored if verdict(claim)[1] == "FAIL"]
    style = "fail" if failed else "pass"
    lines = [f'<p class="count"><span class="{style}">{words.count("pass")} of {len(words)} claims pass</span>'
             f', {len(failed)} failed, {words.count("open")} open, {words.count("not run")} not run.</p>',
             "<p class=none>A claim is a statement about a figure with a criterion for a measured number. Open: measured on a "
             "part of the runs only. Not run: a recording is missing.</p>"]
    if failed:
        items = "\n".join(f'<li><a href="#{esc(anchor)}">{esc(claim.get("figure", ""))}: '
                          f'{esc(claim.get("claim", ""))}</a></li>' for anchor, claim in failed)
        lines.append(f"<p class=fail>Failed:</p>\n<ul>\n{items}\n</ul>")
    return "\n".join(lines)
