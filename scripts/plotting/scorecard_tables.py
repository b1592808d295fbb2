"""The tables of a scorecard's page."""
from .claims import esc
from .scorecard_plots import key, level_text

SHOWN_UNITS = {"m": (1e3, "mm"), "J": (1e3, "mJ"), "s": (1e3, "ms"), "1": (1, "")}  # factor, words
MARKS = {"best": "best", "worst": "worst", "none": "", "given": "worst", "taken": "best"}  # classes of the style
BETTER = {"larger": "larger is better, successes", "smaller": "smaller is better, successes",
          "near_zero": "near zero is better, successes", "reported": "not judged, all runs"}


def cell(content, style=""):
    return f'<td class="{style}">{content}</td>' if style else f"<td>{content}</td>"


def table(heads, rows):
    """heads: as HTML. rows: lists of cells, the first the name's."""
    head = "".join(f"<th>{words}</th>" for words in heads)
    body = "\n".join(f"<tr>{''.join(row)}</tr>" for row in rows)
    return f"<div class=table><table><tr>{head}</tr>\n{body}</table></div>"


def name_cell(one, method=None):
    dash = "" if method is None else key(method)
    return f'<th class="name" title="{esc(one["title"])}">{dash}{esc(one["name"])}</th>'


def number(value, factor=1):
    return "-" if value is None else f"{factor * value:.3g}"


def with_interval(mean, factor):
    if mean["runs"] == 0:
        return "-"
    low, high = mean["low"], mean["high"]
    interval = "" if low is None else f"<small> {number(low, factor)} .. {number(high, factor)}</small>"
    return number(mean["mean"], factor) + interval


def share_text(share):
    if "low" not in share:  # of a stored card
        return number(share["fraction"])
    return f"{share['fraction']:.2f} <small>{share['low']:.2f} .. {share['high']:.2f}</small>"


def unit_of(measure):
    return SHOWN_UNITS.get(measure["units"], (1, measure["units"]))


def level_heads(card, scene):
    return [level_text(noise, card["contact_radius_m"]) for noise in scene["noise_sigma_m"]]


def named_rows(card, methods, cells):
    """A row for each method: its name, and what cells() makes of what it has here."""
    pairs = zip(card["methods"], methods, strict=True)
    return [[name_cell(name, c), *cells(one)] for c, (name, one) in enumerate(pairs)]


def threshold_value(threshold):
    factor, units = unit_of(threshold)
    return f"{number(threshold['threshold'], factor)} {esc(units)}".strip()


def threshold_cell(counts):
    """The runs below a threshold among those with noise, and in small print among those without."""
    def share(below, runs):
        return "-" if runs == 0 else f"{below:d} of {runs:d}"

    return cell(f"{share(counts['below'], counts['runs'])} "
                f"<small>{share(counts['noise_free_below'], counts['noise_free_runs'])}</small>")


def has_rule_before(card):
    """Whether a scene was judged by an earlier rule too, as scenes of a held surface are."""
    return any(one["old"] is not None for scene in card["scenes"] for one in scene["success"])


def overview_table(card):
    """Successes of all scenes together, how often each method stands out, and how many runs are below each threshold of
    perception; the most successful method first."""
    interval = "<br><small>mean over the scenes, 95 % interval</small>"
    before = [f"by the rule before, with noise{interval}"] if has_rule_before(card) else []
    heads = ["", f"successes with noise{interval}", f"successes without noise{interval}", *before,
             f"scenes {'held' if before else 'with success'} in more than {100 * card['held_fraction']:g} % of the runs", "best alone", "worst alone",
             *(f"{esc(one['measure'])} below {threshold_value(one)}<br><small>successful runs with noise; without"
               "</small>" for one in card["thresholds"])]
    rows = named_rows(card, card["methods"], lambda method: [
        cell(with_interval(method["success"], 1)), cell(with_interval(method["noise_free"], 1)),
        *(cell(with_interval(method["old_success"], 1)) for _ in before),
        cell(f"{method['scenes_held']:d} of {len(card['scenes'])}"), cell(f"{method['scenes_best']:d}"),
        cell(f"{method['scenes_worst']:d}")])
    for one in card["thresholds"]:
        for row, counts in zip(rows, one["methods"], strict=True):
            row.append(threshold_cell(counts))
    order = sorted(range(len(rows)), key=lambda c: -(card["methods"][c]["success"]["mean"] or 0))
    return table(heads, [rows[c] for c in order])


def behind_table(card, weaknesses):
    """What a method is behind in, and whom; each scene leads to its section."""
    def value(one, key):
        factor, units = SHOWN_UNITS.get(one["units"], (1, one["units"]))
        return f"{number(one[key], factor)} {esc(units)}".strip()

    def row(one):
        more = "" if one["ahead"] == 1 else f" <small>and {one['ahead'] - 1:d} more</small>"
        p = "-" if one["p"] is None else f"{one['p']:.2g}"
        return [f'<th class="name"><a href="#{esc(one["scene"])}">{esc(one["scene"])}</a></th>',
                cell(esc(one["what"]), "left"), cell(value(one, "own_mean")),
                cell(f"{value(one, 'other_mean')} <small>{esc(one['other'])}</small>{more}"), cell(p)]

    heads = ["scene", "what", esc(card["behind"]["method"]), "better", "p, corrected"]
    return table(heads, [row(one) for one in weaknesses])


def behind_summary(card, weaknesses):
    """In how many scenes a method is behind, for each measure; whom most often."""
    rows = []
    for what in dict.fromkeys(one["what"] for one in weaknesses):
        others = [one["other"] for one in weaknesses if one["what"] == what]
        most = max(dict.fromkeys(others), key=others.count)
        rows.append((len(others), [f'<th class="name">{esc(what)}</th>', cell(f"{len(others):d} of {len(card['scenes']):d}"),
                                   cell(f"{esc(most)} <small>in {others.count(most):d}</small>", "left")]))
    rows.sort(key=lambda row: -row[0])
    return table(["", "scenes with a better method", "most often"], [row for _, row in rows])


def failure_text(failure, levels, link):
    if failure is None:
        return "none"
    level = levels[failure["level"]]
    if "error" in failure:
        return f"error at {level}, run {failure['replicate']:d}: {esc(failure['error'])}"
    page = f'<a href="{esc(link(failure["page"]))}">look at it</a>, ' if "page" in failure else ""
    return f'{page}<a href="{esc(link(failure["file"]))}">trace</a> at {level}: <code>{esc(failure["command"])}</code>'


def success_table(card, scene, link):
    """Successes at each noise level and over all, and a typical failure. link: from its file to where that lies."""
    levels = level_heads(card, scene)
    before = ["by the rule before"] if has_rule_before(card) else []

    def cells(one):
        for share in one["levels"]:
            successes, runs = share["successes"], share["runs"]
            yield cell(f"{successes:d}/{runs:d}", "all" if successes == runs else "zero" if successes == 0 else "some")
        yield cell(share_text(one["overall"]), MARKS[one["mark"]])
        for _ in before:
            yield cell("-" if one["old"] is None else f"{one['old']['overall']['fraction']:.2f}")
        if not card.get("stored"):
            yield cell(failure_text(one["failure"], levels, link), "left")

    last = ["with noise"] if card.get("stored") else ["with noise, 95 % interval", *before, "a typical failure, at the lowest noise that has one"]
    heads = ["noise / r_c", *levels, *last]
    return table(heads, named_rows(card, scene["success"], cells))


def measure_table(card, scene):
    """The measures over all levels with noise."""
    heads = [f"{esc(measure['name'])} {esc(unit_of(measure)[1])}<br><small>{BETTER[measure['better']]}</small>"
             for measure in scene["measures"]]
    of_method = [[(measure, measure["methods"][c]) for measure in scene["measures"]]
                 for c in range(len(card["methods"]))]
    return table(["", *heads], named_rows(card, of_method, lambda measures: [
        cell(with_interval(one["overall"], unit_of(measure)[0]), MARKS[one["mark"]]) for measure, one in measures]))


def level_tables(card, scene):
    """The measures at each noise level, folded away."""
    if len(scene["noise_sigma_m"]) < 2:
        return ""
    tables = []
    for measure in scene["measures"]:
        factor, units = unit_of(measure)
        tables.append(table([f"{esc(measure['name'])} {esc(units)}", *level_heads(card, scene)],
                            named_rows(card, measure["methods"], lambda one: [
                                cell(with_interval(level, factor)) for level in one["levels"]])))
    return f"<details><summary>measures at each noise level</summary>{''.join(tables)}</details>"


def audit_table(card, scene):
    """What each force law gives to a hand, in a cycle and in an update."""
    rows = []
    for law in scene["laws"]:
        cells = [cell(f"{number(level['energy_per_cycle_J']['mean'], 1e3)} "
                      f"<small>{number(level['energy_per_update_J'], 1e3)}</small>", MARKS[level["mark"]])
                 for level in law["levels"]]
        rows.append([name_cell(law), *cells, cell(share_text(law["overall"]))])
    return table(["noise / r_c", *level_heads(card, scene), "runs that are passive and felt"], rows)


def cost_table(card):
    """Of ticks and frames, also in units of a reference."""
    reference = esc(card["costs"]["reference"])
    heads = ["", f"tick / {reference}'s", f"frame / {reference}'s", "tick, us", "frame, us"]
    return table(heads, named_rows(card, card["costs"]["methods"], lambda cost: [
        cell(number(cost["tick_ratio"])), cell(number(cost["frame_ratio"])),
        cell(number(cost["tick_s"], 1e6)), cell(number(cost["frame_s"], 1e6))]))
