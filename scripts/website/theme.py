"""Makes furo as Debian packages it work without a web server. Each repair expects what the package has today."""
import pathlib

NORMALIZE = pathlib.Path("/usr/share/javascript/normalize.css/normalize.css")
IMPORTED_STYLE = "@import url(/javascript/normalize.css/normalize.css);"
IMPORTED_SCRIPT = 'import Gumshoe from "./gumshoe-patched.js";'


class ThemeChanged(ValueError):
    pass


def replace_once(file, old, new):
    text = file.read_text()
    if text.count(old) != 1:
        raise ThemeChanged(f"{file.name} has {text.count(old)} times {old!r}, expected once: furo has changed, see scripts/website/theme.py")
    file.write_text(text.replace(old, new))


def repair(site):
    """Puts what furo's style sheet and script import into them: a browser refuses modules and such paths in file://."""
    static = pathlib.Path(site) / "_static"
    replace_once(static / "styles/furo.css", IMPORTED_STYLE, NORMALIZE.read_text())
    scripts = static / "scripts"
    library = (scripts / "gumshoe-patched.js").read_text()
    if "root.Gumshoe = factory(root)" not in library:
        raise ThemeChanged("gumshoe-patched.js gives no global Gumshoe: furo has changed, see scripts/website/theme.py")
    replace_once(scripts / "furo.js", IMPORTED_SCRIPT, library)
