"""The gallery at the top of index.html: each figure with a small picture, one sentence, and its verdict."""
import re

from .claims import address, esc, is_set_up, verdict
from .typeset import in_mm, typeset_html

SMALL = ".small"  # at the end of the names of the pictures
LONGEST = 170  # letters of a sentence
WORDS = {"pass": "hold", "differs": "differ", "FAIL": "failed", "open": "open", "not run": "not run"}  # in this order
STYLES = {"FAIL": "fail", "differs": "differs", "pass": "pass"}  # the first that occurs gives the colour


def first_sentence(caption):
    """Ends with a full stop before a capital letter, but not after an abbreviation."""
    found = re.match(r".*?[^.]{4,}?(?<!Fig)(?<!Eq)(?<!e\.g)(?<!i\.e)[.:](?= [A-Z]|$)", caption, re.S)
    sentence = (found[0] if found else caption).rstrip(":.").strip()
    if len(sentence) > LONGEST:
        sentence = sentence[:LONGEST].rpartition(" ")[0].rstrip(",;:") + " ..."
    return sentence if sentence.endswith("...") or not sentence else f"{sentence}."


def sentence_about(figure):
    """Files of earlier versions have no summary."""
    summary = figure.attributes.get("summary", "")
    return f"{summary[:1].upper()}{summary[1:]}." if summary else first_sentence(figure.attributes.get("caption", ""))


def verdict_words(claims):
    """How many claims of a figure hold, and how many do not."""
    words = [verdict(claim)[1] for claim in claims if not is_set_up(claim)]
    counts = {word: words.count(word) for word in WORDS if word in words}
    if not counts:
        return "<p class=none>No claims.</p>"
    style = next((STYLES[word] for word in STYLES if word in counts), "none")
    if list(counts) == ["pass"]:
        said = "1 claim holds" if len(words) == 1 else f"all {len(words)} claims hold"
    else:
        one = {"pass": "holds", "differs": "differs"}
        parts = [f"{count} {one.get(word, WORDS[word]) if count == 1 else WORDS[word]}" for word, count in counts.items()]
        said = f"of {len(words)} claim{'s' * (len(words) > 1)} {', '.join(parts)}"
    return f"<p class={style}>{said}</p>"


def item(figure, anchored, views):
    there = f"#{esc(figure.name)}"
    image = f'<img src="{address(figure.name)}{SMALL}.png" alt="" loading=lazy>' if figure.panels else "not drawn"
    view = f'<p><a href="{address(views[0])}">in 3-D</a></p>' if views else ""
    return (f'<li><a href="{there}" tabindex="-1" aria-hidden="true">{image}</a>'
            f'<b><a href="{there}">{typeset_html(in_mm(figure.heading))}</a></b>'
            f'<p>{typeset_html(in_mm(sentence_about(figure)))}</p>'
            f"{verdict_words([claim for _, claim in anchored])}{view}</li>")


def gallery(figures, anchored, views):
    """anchored and views: of each figure by its name."""
    items = "\n".join(item(figure, anchored[figure.name], views.get(figure.name, [])) for figure in figures)
    return f"<ul class=gallery>\n{items}\n</ul>" if figures else ""
