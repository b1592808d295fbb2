"""Tables of plain text."""


def show(ns):
    return "-" if ns is None else f"{ns:.1f}" if ns < 100 else f"{ns:.0f}"


def verdict(measured, asked):
    return "" if asked is None else "met" if measured <= asked else "NOT met"


def table(title, head, rows):
    rows = [head] + [[str(cell) for cell in row] for row in rows]
    widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
    print(f"\n{title}")
    for row in rows:
        cells = [row[0].ljust(widths[0])] + [cell.rjust(w) for cell, w in zip(row[1:], widths[1:])]
        print("  " + "  ".join(cells))
