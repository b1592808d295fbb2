"""Puts the Markdown pages of the project, and the source files to which they link, where Sphinx reads them."""
import os
import pathlib
import re
import shutil
import string
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLACES = {"README.md": "index.md",  # a site has no hidden folder
          **{f".github/{name}.md": f"{name}.md" for name in ("CONTRIBUTING", "RELEASES", "SECURITY", "CODE_OF_CONDUCT")}}
PICTURES = {".png", ".webp", ".svg"}
LANGUAGES = {".h": "cpp", ".cpp": "cpp", ".c": "c", ".py": "python", ".pyi": "python", ".json": "json", ".cff": "yaml", ".csv": "text"}
CODE_OR_LINK = re.compile(r"^```.*?^```|`[^`\n]*`|\]\(([^)\s]+)\)", re.DOTALL | re.MULTILINE)
ORPHAN = "---\norphan: true\nnosearch: true\n---\n"

PYTHON_INTERFACE = """# Python

[Remote Touch from Python](../runners/interfaces/python/README.md) has examples. The types of what is written in C++, such as `Cloud`, are in
[_core.pyi](../runners/interfaces/python/remote_touch/_core.pyi).

```{eval-rst}
.. automodule:: remote_touch
   :members:

.. automodule:: remote_touch.studies
   :members:
```
"""


class Pages:
    """The pages of the site. A link to a source file becomes one to a page that shows this file; `turned` has the pages
    of experiments that one can turn, to which links to their JSON files lead instead."""

    def __init__(self, folder, turned=()):
        self.folder, self.turned = folder, turned
        self.sources, self.missing = set(), []
        self.tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()

    def write(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text)

    def add(self, page, text):
        """Adds a page of Markdown whose links are relative to the place of `page` in the project."""
        place = PLACES.get(page, page)

        def with_place(found):
            target, hash_sign, anchor = (found[1] or "").partition("#")
            if not target or ":" in target:  # code, a heading of this page, or another server
                return found[0]
            to = self.place_of(os.path.normpath(os.path.join(os.path.dirname(page), target)), page)
            if not to.startswith("site:"):
                to = os.path.relpath(to, os.path.dirname(place) or ".")
            return f"]({to}{hash_sign}{anchor})"

        self.write(place, CODE_OR_LINK.sub(with_place, text))

    def place_of(self, path, page):
        """Returns where the site has what lies at `path`, and copies a picture to there."""
        file, name = ROOT / path, pathlib.PurePosixPath(path)
        if not file.exists() and not (self.folder / path).exists():
            self.missing.append(f"{page}: link to {path}: not there")
        if name.suffix == ".md":
            return PLACES.get(path, path)
        if name.suffix in PICTURES:
            (self.folder / path).parent.mkdir(parents=True, exist_ok=True)
            if file.exists():
                shutil.copyfile(file, self.folder / path)
            return path
        if path.startswith("data/experiments/") and name.stem in self.turned:
            return f"site:gallery/views/{name.stem}.html"
        self.sources.add(path)
        return f"source/{path}.md"

    def add_sources(self):
        """Adds the pages of all files and folders to which the pages that were added link."""
        for path in sorted(path for path in self.sources if (ROOT / path).exists()):
            if (ROOT / path).is_dir():
                body = "\n".join(name for name in self.tracked if name.startswith(f"{path}/"))
            else:
                body = (ROOT / path).read_text()
            language = LANGUAGES.get(pathlib.PurePosixPath(path).suffix, "text")
            self.write(f"source/{path}.md", f"{ORPHAN}# `{path}`\n\n``````{language}\n{body.rstrip()}\n``````\n")

    def add_all(self):
        """Adds every page of the project, the landing page, and the pages of the interfaces."""
        for page in self.tracked:
            if page.endswith(".md") and page != "README.md":
                self.add(page, (ROOT / page).read_text())
        opening, _, rest = (ROOT / "README.md").read_text().partition("\n## ")
        landing = string.Template((ROOT / "scripts/website/index.md.in").read_text())
        self.add("README.md", landing.substitute(opening=opening, rest=f"## {rest}"))
        self.add("api/cpp.md", cpp_interface())
        self.add("api/python.md", PYTHON_INTERFACE)
        self.add_sources()


def cpp_interface():
    """Returns a page of the public headers, each with its opening comment."""
    named = (ROOT / "scripts/cmake/public_headers.cmake").read_text()
    rows = []
    for header in sorted(set(re.findall(r"[\w/]+\.h\b", named))):
        comment = re.match(r"(//.*\n)*", (ROOT / header).read_text())[0]
        rows.append(f"[{header}](../{header})\n: {' '.join(comment.replace('//', '').split())}\n")
    return ("# C++\n\nThese headers are public; [your own program](../runners/interfaces/cli/own_program.md) says what they are for. "
            "What they include is installed with them.\n\n" + "\n".join(rows))
