"""Draws the figures of a folder: all that are there, or each as it comes."""
import concurrent.futures
import re
import select
import signal
import sys

from .claims import is_set_up, read_claims, verdict
from .drawable import read_drawable
from .figure_file import SCHEMA, schema_of
from .gallery import SMALL
from .layout import draw_figure, draw_small
from .page import page, write_page
from .plot_error import PlotError
from .progress import read_progress

LOOK_EVERY_S = 0.5


def sort_key(path):
    """4.9 before 4.11, and 4.16 before 4.16-recorded."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", path.stem)]


def is_figure(path):
    """A note about every file that is none."""
    schema = schema_of(path)
    if schema != SCHEMA:
        print(f"plot: {path} skipped: schema {schema!r}, expected {SCHEMA!r}", file=sys.stderr)
    return schema == SCHEMA


def plot_file(path, files, titled=False, wanted=(), small=None):
    """One figure, in a process of its own. Returns what the page says about it, without the curves. files: the pictures,
    of several formats. wanted: slices of a sweep. small: the picture for the gallery."""
    figure = read_drawable(path, wanted)
    if figure.panels:
        figure.width_in = draw_figure(figure, files, titled).get_figwidth()
        if small:
            draw_small(figure, small)
    else:
        for file in filter(None, [*files, small]):
            file.unlink(missing_ok=True)  # of an earlier run
    for panel in figure.panels:
        panel.curves.clear()
        panel.scene = None
    return figure


def views_of(folder, names):
    """Of each figure the pages in views/ that show its runs: fig4.16-boxes.html belongs to fig4.16-boxes, or to fig4.16."""
    found = {}
    for path in sorted((folder / "views").glob("*.html"), key=sort_key):
        owners = [name for name in names if path.stem == name or path.stem.startswith(f"{name}-")]
        if owners:
            found.setdefault(max(owners, key=len), []).append(f"views/{path.name}")
    return found


def ignore_interruption():
    signal.signal(signal.SIGINT, signal.SIG_IGN)


class Folder:
    """Draws what is new in a folder, and writes the page about all that is drawn."""

    def __init__(self, directory, out, pool, extra):
        """extra: the format that is written beside PNG, which the page shows, or "png"."""
        self.directory, self.out, self.pool = directory, out, pool
        self.formats = list(dict.fromkeys(["png", extra]))
        self.stamps = {}  # of the files taken so far
        self.drawing = {}  # path -> future
        self.figures = {}  # path -> figure, of the drawn ones

    def take(self, but=()):
        """The new and the changed ones, the largest first: they tend to take the longest. but: names to leave."""
        found = [(path, path.stat()) for path in self.directory.glob("fig*.h5") if path.stem not in but]
        for path, stat in sorted(found, key=lambda each: -each[1].st_size):
            stamp = (stat.st_mtime_ns, stat.st_ino)
            if self.stamps.get(path) == stamp or path in self.drawing:
                continue
            self.stamps[path] = stamp
            if is_figure(path):
                files = [self.out / f"{path.stem}.{each}" for each in self.formats]
                self.drawing[path] = self.pool.submit(plot_file, path, files, small=self.out / f"{path.stem}{SMALL}.png")

    def collect(self):
        """The drawn ones; whether there was one."""
        done = [path for path, future in self.drawing.items() if future.done()]
        for path in done:
            self.figures[path] = self.drawing.pop(path).result()
        return bool(done)

    def finish(self):
        concurrent.futures.wait(self.drawing.values())
        self.collect()

    def write(self, progress=None):
        """Returns the claims."""
        file = self.directory / "claims.json"
        claims = read_claims(file) if file.exists() or not progress else []
        figures = [self.figures[path] for path in sorted(self.figures, key=sort_key)]
        views = views_of(self.out, [figure.name for figure in figures])
        write_page(self.out / "index.html", page(figures, claims, progress, views, self.formats[1:]))
        return claims


def end(folder):
    if not folder.figures:
        raise PlotError(f"{folder.directory}: no figure files (fig*.h5) and no scorecard")
    claims = folder.write()
    words = [verdict(claim)[1] for claim in claims if not is_set_up(claim)]
    checks = sum(verdict(claim)[1] == "FAIL" for claim in claims if is_set_up(claim))
    failed = f", {checks} check(s) of the set-up FAILED" if checks else ""
    print(f"plot: {len(folder.figures)} figure(s), {words.count('pass')} of {len(words)} claims pass, "
          f"{words.count('differs')} differ{failed}: {folder.out / 'index.html'}")


def plot(directory, out, extra="png"):
    out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ProcessPoolExecutor() as pool:
        folder = Folder(directory, out, pool, extra)
        folder.take()
        folder.finish()
        end(folder)


def ends_within(stream, seconds):
    """Waits so long for the end of the stream; what it says does not matter."""
    ready, _, _ = select.select([stream], [], [], seconds)
    return bool(ready) and not stream.read(4096)


def follow(directory, out, stream, extra="png"):
    """Until the stream ends: then everything is there that will be."""
    out.mkdir(parents=True, exist_ok=True)
    ignore_interruption()  # a figure that is there when the program is stopped is still drawn
    with concurrent.futures.ProcessPoolExecutor(initializer=ignore_interruption) as pool:
        folder, shown, ended = Folder(directory, out, pool, extra), None, False
        while not ended:
            progress = read_progress(directory / "progress.json")
            if progress:  # before that, what is there is of an earlier run
                folder.take(but=progress.to_come())
                if folder.collect() or shown != progress:
                    folder.write(progress)
                shown = progress
            ended = ends_within(stream, LOOK_EVERY_S)
        folder.take()
        folder.finish()
        end(folder)
