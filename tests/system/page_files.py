"""The pages of the project, and what is in them."""
import os
import pathlib
import re

FOLDERS_WITHOUT_PAGES = {"build", "node_modules", "out"}
LANGUAGES = {"sh", "json", "text", "cmake", "cpp", "python"}


class PageError(Exception):
    pass


def pages(root):
    """Every .md below the root, in order. Folders with a dot are those of programs, except .github."""
    for folder, subfolders, files in os.walk(root):
        subfolders[:] = sorted(name for name in subfolders if name not in FOLDERS_WITHOUT_PAGES
                               and (name[0] != "." or name == ".github"))
        yield from (pathlib.Path(folder, name) for name in sorted(files) if name.endswith(".md"))


def blocks(page):
    """(line, language, name, lines) of each fenced block. Code that is indented instead is refused: no test finds it."""
    inside, before = None, ""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("```"):
            if inside:
                yield inside
                inside = None
            else:
                language, _, name = line[3:].partition(" ")
                if language not in LANGUAGES:
                    raise PageError(f"{page}:{number}: a block of {language or 'no language'};"
                                    f" expected one of {', '.join(sorted(LANGUAGES))}")
                inside = (number, language, name.strip(), [])
        elif inside:
            inside[3].append(line)
        elif line.startswith("    ") and not before.strip():
            raise PageError(f"{page}:{number}: indented code; write a block ```sh, ```json or ```text")
        before = line
    if inside:
        raise PageError(f"{page}:{inside[0]}: the block has no end")


def without_blocks(page):
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
