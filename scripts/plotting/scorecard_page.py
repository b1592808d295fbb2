"""Makes index.html of a scorecard, one self-contained file, from the scorecard.json that `remote-touch scorecard`
writes. Nothing is computed here."""
import json
import os
import urllib.parse

from .claims import esc
from .plot_error import PlotError
from .page import CSS, write_page
from .scorecard_plots import CSS as PLOT_CSS
from .scorecard_plots import level_text, looks_css, noise_plot, shapes
from .scorecard_tables import (audit_table, behind_summary, behind_table, cost_table, has_rule_before,
                                       level_heads, level_tables, measure_table, overview_table, success_table,
                                       threshold_value)
from .style import COLOURS, page_colour

SCHEMA = "remote-touch-scorecard/5"
# /4 has no thresholds; the weaknesses of /3 also have the key "shown" in place of "significant".
EARLIER_SCHEMAS = ("remote-touch-scorecard/4", "remote-touch-scorecard/3")
STORED_SCHEMA = "remote-touch-stored-scorecard/1"  # of `remote-touch scorecard json`
OWN_CSS = f"""
body {{ font-size: 15px; max-width: 78rem; }}
h2#reading ~ p {{ max-width: 60rem; }}
table {{ width: auto; margin: .5em 0; font-size: 13px; }}
th, td {{ border: 1px solid light-dark(#ddd, #3a3d42); padding: 2px 7px; text-align: right; font-weight: normal; }}
th.name {{ text-align: left; white-space: nowrap; }} td.left {{ text-align: left; }}
small {{ color: light-dark(#666, #a8a8a8); }} code {{ font-size: 11px; }}
td.best, td.all {{ background: {page_colour(COLOURS['best'])}; }} td.best {{ font-weight: bold; }}
td.worst, td.zero {{ background: {page_colour(COLOURS['worst'])}; }}
.scene {{ display: flex; flex-wrap: wrap; gap: 0 1.5em; align-items: flex-start; }}
"""


def behind_section(card):
    """What the project's own method is not best in, before all else."""
    behind = card["behind"]
    if not behind:
        return ""
    method = esc(behind["method"])
    shown = [one for one in behind["list"] if one["significant"]]
    others = [one for one in behind["list"] if not one["significant"]]
    parts = [f'<h2 id="behind">Where {method} is not the best</h2>']
    if shown:
        parts.append(f"<p>Another method is better by more than chance in {len(shown):d} comparison(s):</p>"
                     f"{behind_summary(card, shown)}"
                     "<details><summary>each of them</summary><p>The numbers are means over the runs of each method; compared "
                     "are the runs in pairs, so that the better of two means may be the other one.</p>"
                     f"{behind_table(card, shown)}</details>")
    else:
        parts.append("<p>No other method is better by more than chance in any scene or measure.</p>")
    if others:
        parts.append(f"<details><summary>{len(others):d} case(s) in which another method succeeds more often, which may "
                     f"be chance or was not tested (no noise)</summary>{behind_table(card, others)}</details>")
    return "\n".join(parts)


def thresholds_text(card):
    """The published thresholds of perception, with their sources."""
    if not card["thresholds"]:
        return ""
    listed = "".join(f"<li>{esc(one['measure'])}: {threshold_value(one)} is {esc(one['meaning'])} "
                     f"<small>({esc(one['source'])})</small></li>" for one in card["thresholds"])
    return f"""
<p><b>Thresholds of perception</b> are published. The table of all scenes counts the runs in which a measure is below \
its threshold, so that a hand would probably not notice it. Only successful runs that have the measure count; runs \
without noise are in small print. A method that succeeds only where it is easy is judged by easy runs. No person judged \
the forces of this page.</p><ul>{listed}</ul>"""


def rule_text(card):
    """What success means."""
    if not has_rule_before(card):
        return """<p><b>Success</b> has a rule for each task, which stands below the title of each scene. It is the same for \
all methods.</p>"""
    return """<p><b>Success</b> in most scenes is a held surface, by one rule for all methods. Judged is the point that touches: of a \
ball the point that faces the surface, of a point the point itself, of direct rendering (a spring without a proxy) \
the place where its force would end. From 0.1 s after the HIP got below the true surface, this point must never be \
farther from it than the tolerance, below or above, and there must be a force in 90 % of these ticks. The rule before \
allowed a ball to sink three times as far as a point, did not count floating, and looked at the last tick only; its \
fractions stand beside those of the new one. Where the truth is not known in more than a tenth of these ticks, a run is no \
success.</p>"""


def tuned_text(card):
    """Which seeds were used before, for cards with a method that was tuned with them."""
    if not any("tracked" in method["name"] for method in card["methods"]):
        return ""
    return (f'The parameters of the tracked sheet were chosen with seeds 1 to {card["last_tuned_seed"]:d}, which no run here '
            "uses. ")


def family_text(card):
    """The number of tests that are corrected together; cards of earlier versions do not state it."""
    if "tests" not in card:
        return "The p values of all pairs of methods in all scenes and measures of this page are corrected together (Holm), "
    return (f'The p values of all {card["tests"]:d} comparisons of two methods, in all scenes and measures of this page, are corrected '
            f'together (Holm; {card["least_pairs"]:d} pairs are the fewest that can show a difference), ')


def how_to_read(card):
    """What the reader of the tables must know."""
    return f"""<h2 id="reading">How to read the tables</h2>
<p>Each method ran each scene {card["replicates"]:d} times at each noise level, and a scene with its own \
noise as often as others at all levels with noise. Noise is given in units of the contact radius \
r_c = {1e3 * card["contact_radius_m"]:g} mm ("own": the scene's own). It depends on \
the seed {card["seed"]:d}, the level and the number of the run, not on the method: all methods got the same points in \
the same frames. {tuned_text(card)}Lines are fractions of successful runs with their 95 % intervals (Clopper and Pearson). Where there is no noise and all \
runs of a method have the same numbers to the last bit, they count as one run; if noise changes no run of a method at all, all its runs in \
the scene are one. Runs without noise are never mixed with the others.</p>
{rule_text(card)}
<p><b>Best and worst</b> are marked only where one method differs from all others by more than chance: fractions by the \
exact sign test, other measures by sign flips up to 16 pairs and by Student's t beyond, run by run over all levels with \
noise. Where few large differences decide, there is no verdict. {family_text(card)}so that \
the probability of any false verdict on the page is at most {card["significance"]:g}. Fewer than {card["min_pairs"]:d} \
pairs give no verdict. A measure that is judged is compared over the pairs of runs in which both methods succeeded. \
Its means are over the successful runs of each method, so a method that succeeds only where it is easy has the mean of \
easy runs. A measure that is not judged has its mean over all runs that have a number. Intervals of single numbers \
are not corrected.</p>
<p><b>In units of perception</b>: jump_fraction_10 is the fraction of the frame updates at which the force changes by \
more than 10 % of the force before; packet_rate_10 is how many packets a second a connection with a dead-band of 10 % \
would send (IEEE 1918.1.1).</p>{thresholds_text(card)}"""


def scene_section(card, scene, link):
    name = esc(scene["name"])
    if card.get("stored"):
        return (f'<h2 id="{name}">{name}</h2><p>Scene and success: <code>remote-touch describe {name}</code></p>'
                f"{success_table(card, scene, link)}{level_tables(card, scene)}")
    plot = noise_plot([one["levels"] for one in scene["success"]], level_heads(card, scene))
    # Only recorded scenes state their truth, and only since cards of this version.
    truth = f"<br>Truth: {esc(scene['truth'])}." if scene.get("truth") else ""
    return f"""<h2 id="{name}">{name}</h2>
<p>{esc(scene["title"])}.{truth}<br>Success is {esc(scene["success_meaning"])}. <b>{esc(scene["verdict"])}</b></p>
<div class="scene">{plot}<div>{measure_table(card, scene)}</div></div>
{success_table(card, scene, link)}
{level_tables(card, scene)}"""


def audit_section(card):
    if not card["audit"]:
        return ""
    return f"""<h2 id="audit">Passivity</h2>
<p>A simulated hand (a mass, moved along closed cycles by a spring and a damper) presses and slides, or turns, on a \
plane at rest; the rendered force acts on it, and the torque of a tool. Each cell gives the energy that the hand received from the renderer in one cycle \
and, in small print, from one frame update to the next while there is force, in mJ. Below 0 the renderer took energy; \
this also happens when it loses the surface and is pressed into it again. Red: the 95 % interval is above 0; green: \
below 0; a single run has no interval. v_plus and v_none give the sign of the velocity term of (4.15), which is minus \
otherwise; k_d3 is a damper of 3 Ns/m in (4.16), and k_d_minus its printed sign.</p>
{"".join(f"<h3>{esc(scene['title'])}</h3>{audit_table(card, scene)}" for scene in card["audit"])}"""


def costs_section(card):
    costs = card["costs"]
    if not costs:
        return ""
    return f"""<h2 id="costs">Costs</h2>
<p>Wall clock on {esc(costs["cpu"] or "the machine that measured them")}, one thread, one run of each scene at \
{level_text(costs["noise_sigma_m"], card["contact_radius_m"])} r_c, medians over the scenes. All points \
of a frame were made before it was timed, so the times do not contain the making of noise. Times differ from run to \
run; they are in costs.json and in no digest. Proxy steps per tick are the measure mean_steps of the sweeps in runs/.</p>
{cost_table(card)}"""


def skipped_section(card):
    return "\n".join(f'<p id="{esc(one["name"])}"><b>Skipped: {esc(one["name"])}</b>, {esc(one["why"])}</p>'
                     for one in card["skipped"])


def contents(card):
    links = [(scene["name"], scene["name"]) for scene in card["scenes"]]
    links += [(part, words) for part, words in (("audit", "passivity audit"), ("costs", "costs")) if card[part]]
    return "<p>" + " ".join(f'<a href="#{esc(anchor)}">{esc(words)}</a>' for anchor, words in links) + "</p>"


def scorecard_page(card, link=lambda file: file):
    """link: from a file of the card's folder to where that lies, as the page names it."""
    scenes = "\n".join(scene_section(card, scene, link) for scene in card["scenes"])
    names = [method["name"] for method in card["methods"]]
    where = ("Without runs there are no marks, failures, costs and passivity in the scenes." if card.get("stored")
             else "Numbers: scorecard.h5; every run: runs/.")
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Scorecard</title><style>{CSS}{OWN_CSS}{PLOT_CSS}{looks_css(names)}</style></head><body>
{shapes(names)}
<h1>Scorecard of {len(card["methods"]):d} methods, {len(card["scenes"]):d} scenes</h1>
{behind_section(card)}
<h2 id="overview">All scenes</h2>
{overview_table(card)}
{skipped_section(card)}
{contents(card)}
{how_to_read(card)}
{scenes}
{audit_section(card)}
{costs_section(card)}
<footer>{esc(card["origin"])}; everything simulated. {where}</footer>
</body></html>
"""


def is_scorecard(directory):
    """Also one that has lost its scorecard.json, or never had one."""
    return any((directory / name).exists() for name in ("scorecard.json", "scorecard.h5"))


def with_present_names(card):
    """A card of an earlier schema, with the keys of this one. A damaged card is returned as it is."""
    try:
        present = card | {"thresholds": []}
        if card["behind"]:
            listed = [{"significant" if key == "shown" else key: value for key, value in one.items()}
                      for one in card["behind"]["list"]]
            present["behind"] = card["behind"] | {"list": listed}
        return present
    except (AttributeError, KeyError, TypeError):
        return card


def mean_over(row, key, low=None, high=None):
    return {"runs": row["scenes"], "mean": row[key], "low": low, "high": high}


def stored_scene(name, methods, counts, means):
    """A scene of a stored card. Only runs give marks, intervals over all levels, and typical failures."""
    levels = {method: [row for row in counts if row["method"] == method] for method in methods}

    def success(rows):
        noisy = [row for row in rows if row["noise_sigma"] != 0]
        runs = sum(row["runs"] for row in noisy)
        fraction = sum(row["successes"] for row in noisy) / runs if runs else None
        return {"levels": rows, "overall": {"fraction": fraction}, "mark": "none", "old": None, "failure": None}

    def measure(what):
        rows = [row for row in means if row["measure"] == what]
        return {"name": what, "units": rows[0]["units"],
                "methods": [{"levels": [row for row in rows if row["method"] == method]} for method in methods]}

    return {"name": name, "noise_sigma_m": [row["noise_sigma"] for row in levels[methods[0]]],
            "success": [success(levels[method]) for method in methods],
            "measures": [measure(what) for what in dict.fromkeys(row["measure"] for row in means)]}


def card_of_stored(stored):
    """The card that `remote-touch scorecard json` printed, with the keys of scorecard.json."""
    methods = [row["method"] for row in stored["overview"]]
    thresholds = {}
    for row in stored["thresholds"]:
        thresholds.setdefault(row["measure"], row | {"methods": []})["methods"].append(row)
    by_scene = {name: ([], []) for name in dict.fromkeys(row["scene"] for row in stored["success"])}
    for part, rows in enumerate((stored["success"], stored["measures"])):
        for row in rows:
            by_scene[row["scene"]][part].append(row)
    return stored | {
        "stored": True, "audit": None, "costs": None, "skipped": [], "origin": "the stored scorecard",
        "methods": [{"name": row["method"], "title": row["method"], "scenes_held": row["held"], "scenes_best": row["best"],
                     "scenes_worst": row["worst"], "success": mean_over(row, "success", row["low"], row["high"]),
                     "noise_free": mean_over(row, "noise_free"), "old_success": mean_over(row, "old_success")}
                    for row in stored["overview"]],
        "thresholds": list(thresholds.values()),
        "behind": {"method": stored["own_method"], "list": stored["behind"]} if stored["own_method"] in methods else None,
        "scenes": [stored_scene(name, methods, *rows) for name, rows in by_scene.items()]}


def read_scorecard(path):
    try:
        card = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise PlotError(f"{path} is not there: the same `remote-touch scorecard` again writes it") from None
    except (ValueError, RecursionError) as error:
        raise PlotError(f"{path}: damaged: {error}") from None
    schema = card.get("schema") if isinstance(card, dict) else None
    if schema == STORED_SCHEMA:
        try:
            return card_of_stored(card)
        except (KeyError, IndexError, TypeError, AttributeError) as error:
            raise PlotError(f"{path}: damaged: {type(error).__name__} {error}") from None
    if schema not in (SCHEMA, *EARLIER_SCHEMAS):
        raise PlotError(f"{path}: schema {schema!r}: expected {SCHEMA!r}")
    return card if schema == SCHEMA else with_present_names(card)


def plot_scorecard(directory, out):
    """Writes the page of a card's folder."""
    file = directory / "scorecard.json"
    card = read_scorecard(file)
    if any(directory.glob("fig*.h5")):
        raise PlotError(f"{directory}: figures and a scorecard, both with index.html: expected a folder for each")

    def link(name):  # the page may lie elsewhere
        return urllib.parse.quote(os.path.relpath(directory / name, out))

    try:
        text = scorecard_page(card, link)
    except (KeyError, IndexError, TypeError, AttributeError, ValueError, ArithmeticError) as error:
        raise PlotError(f"{file}: damaged: {type(error).__name__} {error}") from None
    out.mkdir(parents=True, exist_ok=True)
    write_page(out / "index.html", text)
    print(f"plot: {len(card['scenes'])} scene(s), {len(card['methods'])} method(s): {out / 'index.html'}")
