"""Finds what is wrong with the links of a finished site: no page, no such anchor, or something from another server."""
import html.parser
import pathlib
import re
import urllib.parse

ELSEWHERE = re.compile(r"(https?:)?//")
EMBEDDED = re.compile(r"(data|blob|mailto|javascript):")


class Page(html.parser.HTMLParser):
    """The anchors and the links of a page; `loaded` are those that a browser follows without a click."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.clicked, self.loaded = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.anchors.update(attributes[name] for name in ("id", "name") if attributes.get(name))
        for name in ("href", "src", "poster", "data"):
            if attributes.get(name):
                (self.clicked if tag == "a" else self.loaded).append(attributes[name])
        self.loaded += [choice.split()[0] for choice in (attributes.get("srcset") or "").split(",") if choice.strip()]
        self.loaded += in_styles(attributes.get("style") or "")


def in_styles(text):
    return [found[1] for found in re.finditer(r"(?:url\(|@import\s+(?!url))\s*['\"]?([^'\")\s;]+)", text)]


def problems(site):
    """Returns a line for each broken link, and the number of links."""
    site = pathlib.Path(site).resolve()
    pages = {file: Page(file.read_text(errors="replace")) for file in sorted(site.rglob("*.html"))}
    links = [(file, link, False) for file, page in pages.items() for link in page.clicked]
    links += [(file, link, True) for file, page in pages.items() for link in page.loaded]
    links += [(file, link, True) for file in sorted(site.rglob("*.css")) for link in in_styles(file.read_text())]
    found = [f"{file.relative_to(site)}: {link}: {wrong}" for file, link, is_loaded in links
             if (wrong := fault(site, pages, file, link, is_loaded))]
    return found, len(links)


def fault(site, pages, file, link, is_loaded):
    if ELSEWHERE.match(link):
        return "is loaded from another server" if is_loaded else None
    if EMBEDDED.match(link):
        return None
    path, _, anchor = link.partition("#")
    path = urllib.parse.unquote(path.partition("?")[0])
    target = (file.parent / path).resolve() if path else file
    if site not in target.parents:
        return "leads out of the site"
    if not target.is_file():
        return "not there"
    if anchor and target in pages and urllib.parse.unquote(anchor) not in pages[target].anchors | {"top"} and not is_run(target):
        return "no such anchor"
    return None


def is_run(page):
    """The anchors of the page of a run are ticks."""
    return page.parent.name == "views"
