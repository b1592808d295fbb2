"""The gallery: every stored experiment as a page that one can turn, with a picture of its scene."""
import concurrent.futures
import json
import os
import pathlib
import re
import shutil

import PIL.Image

from website import scenes

ROOT = pathlib.Path(__file__).resolve().parents[2]
GROUPS = json.loads(pathlib.Path(__file__).with_name("gallery.json").read_text())
SIZE = {"width": 800, "height": 500}
SMALL = (400, 250)
OF_A_RECORDING = ("README*", "LICENSE*", "LICENCE*", "COPYING*")


class Experiment:
    def __init__(self, file):
        self.name, self.configuration = file.stem, json.loads(file.read_text())
        scenario = self.configuration["scenario"]
        self.recording = scenario["path"] if scenario["name"] == "recording" else None

    def papers(self):
        """Returns the files beside a recording that state its source and licence."""
        place = pathlib.Path(os.environ.get("REMOTE_TOUCH_DATA", ".")) / self.recording
        found = sorted({file for pattern in OF_A_RECORDING for file in (place if place.is_dir() else place.parent).glob(pattern)})
        if not found:
            raise OSError(f"{self.name}: {place} has no README and no LICENSE, which the site has to show")
        return found


def experiments():
    found = {file.stem: Experiment(file) for file in sorted((ROOT / "data/experiments").glob("*.json"))}
    grouped = [name for group in GROUPS for name in group["experiments"]]
    if wrong := set(found) ^ set(grouped) | {name for name in grouped if grouped.count(name) > 1}:
        raise ValueError(f"gallery.json has not each experiment once: {', '.join(sorted(wrong))}")
    return found


def make(wanted, folder):
    """Makes pages and pictures of the experiments, except those that are newer than the program."""
    views, thumbs = folder / "views", folder / "thumbs"
    views.mkdir(parents=True, exist_ok=True)
    thumbs.mkdir(exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda name: scenes.page_of(name, views, "--max-mb", "6"), older(wanted, views, "html")))
    left = older(wanted, thumbs, "webp")
    scenes.shoot([{"page": views / f"{name}.html", "size": SIZE, "style": scenes.PICTURE_ONLY, "shown": "body",
                   "pictures": [(None, thumbs / f"{name}.png")]} for name in left])
    for name in left:
        with PIL.Image.open(thumbs / f"{name}.png") as image:
            image.convert("RGB").resize(SMALL, PIL.Image.Resampling.LANCZOS).save(thumbs / f"{name}.webp", quality=70, method=6)


def older(names, folder, kind):
    made_s = scenes.PROGRAM.stat().st_mtime
    return [name for name in names if not (file := folder / f"{name}.{kind}").exists() or file.stat().st_mtime < made_s]


def page(shown):
    """Returns the page of the gallery in Markdown; experiments that are not shown lead to their files."""
    known = experiments()
    text = ["---\nhide-toc: true\n---\n# Gallery\n", "Every stored experiment" + (
        " as a page that you can turn and play. Each page is one file: send it, or show it in a talk. Its address ends in the tick that it "
        "shows. The figures of the dissertation, with their claims, are on [one page](site:figures/index.html); so is the "
        "[stored scorecard](site:scorecard/index.html).\n" if shown else ".\n")]
    for group in GROUPS:
        text.append(f"## {group['title']}\n\n{group['text']}\n")
        text += [card(known[name], name in shown) for name in group["experiments"] if not shown or name in shown]
        text.append("")
    if shown and (hidden := sorted(set(known) - set(shown))):
        text.append(f"## Not here\n\nThese replay recordings, which have licences of their own; `scripts/site --recordings NAME` shows them: "
                    f"{', '.join(hidden)}.\n")
    return "\n".join(text)


def card(experiment, is_shown):
    name = experiment.name
    title = re.sub(r"([\\*_`<\[\]])", r"\\\1", experiment.configuration["title"])
    line = f"- [{f'![](thumbs/{name}.webp) ' if is_shown else ''}**{name}** {title}](../data/experiments/{name}.json)"
    if is_shown and experiment.recording:
        line += f" Recorded: {experiment.recording}; " + ", ".join(
            f"[{file.name}](site:gallery/recordings/{experiment.recording}/{file.name})" for file in experiment.papers())
    return line


def finish(shown, folder, site):
    """Copies what Sphinx does not know into the finished site."""
    known = experiments()
    for name in shown:
        for file in [folder / f"views/{name}.html", *(known[name].papers() if known[name].recording else ())]:
            to = site / "gallery" / ("views" if file.suffix == ".html" else f"recordings/{known[name].recording}")
            to.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, to / file.name)
