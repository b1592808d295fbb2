"""Writes index.html: every figure with its caption and claims."""
import json

from plotting.claims import claim_table, esc, figure_of, overview

CSS = """
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 62rem;
       margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 3rem; border-top: 1px solid #ddd; padding-top: 1rem; }
img { max-width: 100%; height: auto; }
a { color: #1f4e79; }
.table { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; }
th, td { text-align: left; vertical-align: top; padding: .35rem .6rem; border-bottom: 1px solid #e3e3e3; }
th { color: #555; font-weight: 600; }
td.number { text-align: right; font-variant-numeric: tabular-nums; } th.number { text-align: right; }
tr:target { background: #fff3cd; }
.pass { color: #1d6b37; font-weight: 600; } .fail { color: #b3141c; font-weight: 700; } .none { color: #666; }
td.verdict, td.short { white-space: nowrap; }
.count { font-size: 1.15rem; }
details { margin-top: .6rem; font-size: .9rem; color: #444; } pre { white-space: pre-wrap; overflow-wrap: anywhere; }
footer { margin-top: 3rem; border-top: 1px solid #ddd; padding-top: 1rem; font-size: .85rem; color: #555; }
"""


def pretty(config):
    try:
        return json.dumps(json.loads(config), indent=2, ensure_ascii=False)
    except ValueError:
        return config


def figure_section(figure, anchored):
    a = figure.attributes
    image = f'<img src="{esc(figure.name)}.png" alt="{esc(figure.heading)}">' if figure.panels else ""
    config = f'<pre>{esc(pretty(a["config"]))}</pre>' if a.get("config") else ""
    return f"""<section id="{esc(figure.name)}">
<h2>{esc(figure.heading)}</h2>
<p>{esc(a.get("caption", ""))}</p>
{image}
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


def page(figures, claims):
    anchored = [(f"{figure_of(claim)}-claim{i}", claim) for i, claim in enumerate(claims)]
    of = {figure.name: [one for one in anchored if figure_of(one[1]) == figure.name] for figure in figures}
    contents = " \u00b7 ".join(f'<a href="#{esc(f.name)}">{esc(f.name.removeprefix("fig"))}</a>' for f in figures)
    sections = [figure_section(figure, of[figure.name]) for figure in figures]
    homeless = [one for one in anchored if figure_of(one[1]) not in of]
    if homeless:  # a claim is never dropped
        sections.append(f"<section><h2>Claims without a figure</h2>{claim_table(homeless)}</section>")
    body = "\n".join(sections)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Remote Touch: figures and claims</title><style>{CSS}</style></head><body>
<h1>Remote Touch: figures and claims</h1>
{overview(anchored)}
<p>Figures: {contents}</p>
{body}
<footer>{provenance(figures)}</footer>
</body></html>
"""
