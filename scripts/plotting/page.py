"""Makes index.html: every figure with its caption and claims, and what is still to come while figures are made."""
import json
import os

from .claims import address, claim_table, esc, figure_of, overview
from .gallery import gallery
from .progress import duration
from .style import COLOURS, COLUMN_IN, page_colour
from .typeset import in_mm, typeset_html

CSS = """
body { font: 16px/1.5 system-ui, sans-serif; color-scheme: light dark; color: #222; background: #fff; max-width: 62rem;
       margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 3rem; border-top: 1px solid #ddd; padding-top: 1rem; }
img { max-width: 100%; height: auto; } img.column { width: 34rem; }
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(13.5rem, 1fr)); gap: 1.2rem 1rem; padding: 0; }
.gallery li { list-style: none; font-size: .88rem; line-height: 1.4; }
.gallery li > a:first-child { display: block; height: 10rem; margin-bottom: .3rem; border: 1px solid #ddd; background: #fff; }
.gallery img { width: 100%; height: 100%; object-fit: contain; padding: .1rem; box-sizing: border-box; }
.gallery b { display: block; } .gallery p { margin: .15rem 0; }
a { color: #1f4e79; }
.table { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; }
th, td { text-align: left; vertical-align: top; padding: .35rem .6rem; border-bottom: 1px solid #e3e3e3; }
th { color: #555; font-weight: 600; }
td.number { text-align: right; font-variant-numeric: tabular-nums; } th.number { text-align: right; }
tr:target { background: #fff3cd; }
.pass { font-weight: 600; } .fail, .differs { font-weight: 700; }
td.verdict, td.short { white-space: nowrap; }
.count { font-size: 1.15rem; }
.progress { background: #eef3f8; border-left: 4px solid #1f4e79; padding: .6rem 1rem; }
details { margin-top: .6rem; font-size: .9rem; color: #444; } pre { white-space: pre-wrap; overflow-wrap: anywhere; }
footer { margin-top: 3rem; border-top: 1px solid #ddd; padding-top: 1rem; font-size: .85rem; color: #555; }
@media (prefers-color-scheme: dark) {
  body { color: #e2e2e2; background: #16181b; } a { color: #8fbfe8; } th, footer, details { color: #a8a8a8; }
  h2, th, td, footer { border-color: #3a3d42; } img { background: #fff; border-radius: 4px; }
  tr:target { background: #4a3d10; }
  .progress { background: #1f2a35; border-color: #8fbfe8; } .gallery li > a:first-child { border-color: #3a3d42; }
}
""" + "".join(f".{name} {{ color: {page_colour(COLOURS[name])}; }}\n" for name in ("pass", "fail", "differs", "none"))

INTRODUCTION = """Haptic rendering of streaming point clouds, computed from simulated and recorded scenes: each figure with \
its claims, and whether they hold. No haptic device was used."""


def pretty(config):
    try:
        return json.dumps(json.loads(config), indent=2, ensure_ascii=False)
    except ValueError:
        return config


def view_links(views):
    """Pages that show a run of the figure in 3-D."""
    links = ", ".join(f'<a href="{address(view)}">{esc(view.rpartition("/")[2].removesuffix(".html"))}</a>' for view in views)
    return f"<p>Look at it in 3-D and over time: {links}.</p>" if links else ""


def picture(figure, formats):
    """The picture, and links to it in other formats. A picture of one column is shown so large that its letters are those
    of the page."""
    if not figure.panels:
        return ""
    style = " class=column" if 0 < figure.width_in <= COLUMN_IN else ""
    links = ", ".join(f'<a href="{address(figure.name)}.{each}">{each.upper()}</a>' for each in formats)
    return (f'<img{style} src="{address(figure.name)}.png" alt="{esc(figure.heading)}" loading=lazy>'
            + (f"<p>For print: {links}.</p>" if links else ""))


def figure_section(figure, anchored, views, formats):
    a = figure.attributes
    config = f'<pre>{esc(pretty(a["config"]))}</pre>' if a.get("config") else ""
    return f"""<section id="{esc(figure.name)}">
<h2>{typeset_html(in_mm(figure.heading))}</h2>
<p>{typeset_html(in_mm(a.get("caption", "")))}</p>
{picture(figure, formats)}
{view_links(views)}
{claim_table(anchored)}
<details><summary>Command and configuration</summary>
<pre>{esc(a.get("command", ""))}</pre>
{config}
<p>digest {esc(a.get("digest", ""))}</p></details>
</section>"""


def provenance(figures):
    """One line for each build that made some of the figures; ordinarily one."""
    builds = {}
    for figure in figures:
        a = figure.attributes
        dirty = a.get("git_dirty", "").lower() in ("1", "true", "yes", "dirty")
        build = (f'version {a.get("version", "?")}, commit {a.get("git_commit", "?")}'
                 f'{" with local changes" if dirty else ""}, {a.get("compiler", "?")}, '
                 f'{a.get("isa", "?")}, flags {a.get("flags", "?")}')
        builds.setdefault(build, []).append(figure.name)
    if len(builds) == 1:
        return f"<p>{esc(next(iter(builds)))}</p>"
    return "\n".join(f"<p>{esc(build)}: {esc(', '.join(names))}</p>" for build, names in builds.items())


def state_words(entry):
    if entry["state"] == "running":
        return f"is being made, {duration(entry['left_s'])} left" if entry["left_s"] else "is being made"
    return "waits"


def progress_box(progress):
    """What is still to be made. A page without it is complete."""
    if not progress:
        return ""
    done = sum(entry["state"] == "done" for entry in progress.figures)
    rows = "\n".join(f"<li>Figure {esc(entry['name'])}, {esc(entry['summary'])}: {state_words(entry)}</li>"
                     for entry in progress.figures if entry["state"] != "done")
    left = f", {duration(progress.left_s)} left" if progress.left_s else ""
    return f"""<div class=progress><p>{done} of {len(progress.figures)} figures are made{left}. \
The others appear here as soon as they are made; this page reloads every few seconds.</p>
<ul>
{rows}
</ul></div>"""


def page(figures, claims, progress=None, views=None, formats=()):
    """progress: None when nothing more will come. views: of each figure by its name, addresses of pages. formats: of the
    pictures for print."""
    to_come = progress.to_come() if progress else set()
    figures = [figure for figure in figures if figure.name not in to_come]
    anchored = [(f"{figure_of(claim)}-claim{i}", claim) for i, claim in enumerate(claims)
                if figure_of(claim) not in to_come]
    of = {figure.name: [one for one in anchored if figure_of(one[1]) == figure.name] for figure in figures}
    views = views or {}
    sections = [figure_section(figure, of[figure.name], views.get(figure.name, []), formats) for figure in figures]
    homeless = [one for one in anchored if figure_of(one[1]) not in of]
    if homeless and not progress:  # a claim is never dropped
        sections.append(f"<section><h2>Claims without a figure</h2>{claim_table(homeless)}</section>")
    body = "\n".join(sections)
    again = '<meta http-equiv="refresh" content="5">' if progress else ""
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">{again}
<title>Remote Touch: figures and claims</title><style>{CSS}</style></head><body>
<h1>Remote Touch: figures and claims</h1>
<p>{INTRODUCTION}</p>
{progress_box(progress)}
{gallery(figures, of, views)}
{overview(anchored) if anchored else ""}
{body}
<footer>{provenance(figures)}</footer>
</body></html>
"""


def write_page(path, text):
    """Whoever reads it meanwhile sees the old page or the new one. Half of a character, which JSON may have, is shown
    as a question mark."""
    partial = path.with_name(f"{path.name}.partial-{os.getpid()}")
    partial.write_text(text, encoding="utf-8", errors="replace")
    partial.replace(path)
