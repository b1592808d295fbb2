"""The table `expected`: what finds each planted bug."""
import re

HEAD = ["bug", "found by", "baselines", "recorded", "first baseline", "tick", "quantity", "class", "in verify"]
RECORDED = HEAD.index("recorded")
FIRST = HEAD.index("first baseline")

def read_table(file):
    if not file.is_file():
        return {}
    lines = [line for line in file.read_text().splitlines() if line and not line.startswith("#")]
    starts = [match.start() for match in re.finditer(r"(?<=  )\S|^\S", lines[0])] if lines else []
    rows = {}
    for line in lines[1:]:
        cells = [line[start:end].strip() for start, end in zip(starts, starts[1:] + [None])]
        rows[cells[0]] = cells + [""] * (len(HEAD) - len(cells))
    return rows


def table_text(rows):
    rows = [HEAD] + rows
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEAD))]
    return "".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() + "\n" for row in rows)


HEADLINE = """\
# What finds each planted bug. Written by ./run --update; README.md tells what the columns mean.
"""


def write_table(file, rows):
    file.write_text(HEADLINE + table_text(list(rows.values())))
