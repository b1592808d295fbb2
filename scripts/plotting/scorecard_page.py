"""Makes index.html of a scorecard, one self-contained file, from the scorecard.json that `remote-touch scorecard`
writes. Nothing is computed here."""
import json
import os
import urllib.parse

from plotting.claims import esc
from plotting.plot_error import PlotError
from plotting.page import CSS, write_page
from plotting.scorecard_plots import CSS as PLOT_CSS
from plotting.scorecard_plots import colours_css, level_text, noise_plot
from plotting.scorecard_tables import (audit_table, cost_table, level_heads, level_tables, measure_table,
                                       overview_table, success_table)

SCHEMA = "remote-touch-scorecard/1"
OWN_CSS = """
body { font-size: 15px; max-width: 78rem; }
table { width: auto; margin: .5em 0; font-size: 13px; }
th, td { border: 1px solid #ddd; padding: 2px 7px; text-align: right; font-weight: normal; }
th.name { text-align: left; white-space: nowrap; } td.left { text-align: left; }
small { color: #777; } code { font-size: 11px; }
td.best { background: #c8ecd2; font-weight: bold; } td.worst { background: #f6cdc6; }
td.all { background: #eaf7ee; } td.zero { background: #fbe9e6; }
.scene { display: flex; flex-wrap: wrap; gap: 0 1.5em; align-items: flex-start; }
"""


def how_to_read(card):
    """What the reader of the tables must know."""
    return f"""<p>Each method ran each scene {card["replicates"]:d} times at each noise level. Noise is given in units \
of the contact radius r_c = {1e3 * card["contact_radius_m"]:g} mm ("own": the scene has its own noise). It depends on \
the seed {card["seed"]:d}, the level and the number of the run, not on the method: all methods got the same points in \
the same frames. The parameters of the tracked sheet were chosen with seeds 1 to {card["last_tuned_seed"]:d}, which no \
run here uses. Lines are fractions of successful runs with Wilson's 95 % intervals. Where there is no noise and all \
runs of a method have the same numbers to the last bit, they count as one run in every fraction and mean, and in a \
comparison if this holds for both methods.</p>
<p><b>Success.</b> A surface is held while the proxy is at most 0.5 r_c below it; popped through means that the proxy \
is on the other side. This does not ask the same of all methods: a proxy that is a ball rests 1 r_c above a surface \
and may sink by 1.5 r_c; a proxy that is a point rests on the surface, with noise a little below it, and may sink by \
0.5 r_c; the surface of metaballs is higher than both. Direct rendering has no proxy: its position is the HIP itself, \
so it fails where a scene presses deeper than 0.5 r_c. A held surface must also be felt: there must be a force in the \
last 0.1 s or, where the path ends in free space, in a quarter of the ticks.</p>
<p><b>Best and worst</b> are marked only if the paired differences to all other methods, run by run over all noise \
levels, have 95 % intervals on one side of zero (fractions: Agresti and Min; others: percentile bootstrap with fixed \
keys). Without a mark these runs do not show a difference. A measure that is judged is compared over the pairs of runs \
in which both methods succeeded; with fewer than {card["min_pairs"]:d} such pairs there is no verdict. Its means are \
over the successful runs of each method, so a method that succeeds only where it is easy has the mean of easy runs. A \
measure that is not judged has its mean over all runs that have a number. The intervals are not adjusted for the \
number of comparisons.</p>"""


def scene_section(card, scene, link):
    name = esc(scene["name"])
    plot = noise_plot([one["levels"] for one in scene["success"]], level_heads(card, scene))
    return f"""<h2 id="{name}">{name}</h2>
<p>{esc(scene["title"])}.<br>Success is {esc(scene["success_meaning"])}. <b>{esc(scene["verdict"])}</b></p>
<div class="scene">{plot}<div>{measure_table(card, scene)}</div></div>
{success_table(card, scene, link)}
{level_tables(card, scene)}"""


def audit_section(card):
    if not card["audit"]:
        return ""
    return f"""<h2 id="audit">Passivity</h2>
<p>A simulated hand (a mass, moved along closed cycles by a spring and a damper) presses and slides on a plane at \
rest; the rendered force acts on it. Each cell gives the energy that the hand received from the renderer in one cycle \
and, in small print, from one frame update to the next while there is force, in mJ. Below 0 the renderer took energy; \
this also happens when it loses the surface and is pressed into it again. Red: the 95 % interval is above 0; green: \
below 0; a single run has no interval. v_plus and v_none give the sign of the velocity term of (4.15), which is minus \
otherwise; k_d3 is a damper of 3 Ns/m in (4.16), and k_d_minus its printed sign.</p>
{audit_table(card)}"""


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
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Scorecard</title><style>{CSS}{OWN_CSS}{PLOT_CSS}{colours_css(len(card["methods"]))}</style></head><body>
<h1>Scorecard of 3-DOF renderers</h1>
{how_to_read(card)}
{skipped_section(card)}
{overview_table(card)}
{contents(card)}
{scenes}
{audit_section(card)}
{costs_section(card)}
<footer>{esc(card["origin"])}; everything simulated. Numbers: scorecard.h5; every run: runs/.</footer>
</body></html>
"""


def is_scorecard(directory):
    """Also one that has lost its scorecard.json, or never had one."""
    return any((directory / name).exists() for name in ("scorecard.json", "scorecard.h5"))


def read_scorecard(path):
    try:
        card = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise PlotError(f"{path} is not there: the same `remote-touch scorecard` again writes it") from None
    except (ValueError, RecursionError) as error:
        raise PlotError(f"{path}: damaged: {error}") from None
    schema = card.get("schema") if isinstance(card, dict) else None
    if schema != SCHEMA:
        raise PlotError(f"{path}: schema {schema!r}: expected {SCHEMA!r}")
    return card


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
