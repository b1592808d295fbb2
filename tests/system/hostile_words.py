"""What tests of pages share: words that would run a script where they are not escaped, put into every field of an input,
one after the other."""
import copy
import html.parser

WORDS = """"'></td></title></style></script><script>alert(1)</script><img src=x onerror=alert(1)>&lt;$\\frac{$ \ud800"""
HARMLESS = "words of more than two dozen letters"


class Tags(html.parser.HTMLParser):
    """The tags of a page with the names of their attributes, and all words between them."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.words = [], ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, *(name for name, _ in attributes)))

    def handle_endtag(self, tag):
        self.tags.append((f"/{tag}",))

    def handle_data(self, data):
        self.words += data


def places(value, path=()):
    """Of each field that is no list and no object the path to it."""
    if isinstance(value, (dict, list)):
        keys = value if isinstance(value, dict) else range(len(value))
        return [place for key in keys for place in places(value[key], (*path, key))]
    return [path]


def with_field(value, path, words):
    changed = copy.deepcopy(value)
    part = changed
    for key in path[:-1]:
        part = part[key]
    part[path[-1]] = words
    return changed


def dangerous_fields(value, page_of):
    """Those of whose words the page makes tags, and how many were tried. page_of: makes a page, or None of what it
    refuses."""
    found, tried = [], 0
    for path in places(value):
        hostile, harmless = (page_of(with_field(value, path, words)) for words in (WORDS, HARMLESS))
        tried += 1
        if hostile is not None and (harmless is None or Tags(hostile).tags != Tags(harmless).tags):
            found.append(path)
    return found, tried
