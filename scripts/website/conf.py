"""Settings of Sphinx for the site; scripts/site calls it."""
import pathlib
import sys

from docutils import nodes

project = html_title = "Remote Touch"
author = "The Remote Touch authors"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "runners/interfaces/python"))
autodoc_mock_imports = ["remote_touch._core", "numpy", "xarray"]  # so that the docstrings are read without a build
autodoc_member_order = "bysource"
autodoc_typehints = "description"
root_doc = "index"
myst_heading_anchors = 6  # as code hosts make them
myst_enable_extensions = ["deflist"]
suppress_warnings = ["myst.header"]  # a page may begin below a title
highlight_language = "none"
html_theme = "furo"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = html_show_sphinx = html_show_copyright = html_use_index = False
html_show_search_summary = False  # a page that was opened from a disk may not read another one
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#9a3412", "color-brand-content": "#1d4f91"},
    "dark_css_variables": {"color-brand-primary": "#fdba74", "color-brand-content": "#8ab8f0"},
}


def lead_to_files(app, doctree, docname):
    """Links to files that Sphinx does not know are written site:PATH, with the path from the top of the site."""
    for node in doctree.findall(nodes.reference):
        if node.get("refuri", "").startswith("site:"):
            node["refuri"] = "../" * docname.count("/") + node["refuri"].removeprefix("site:")


def indented_is_code(app, what, name, thing, options, lines):
    for i in range(len(lines) - 1, 0, -1):
        if lines[i].startswith("    ") and not lines[i - 1] and not lines[max(i - 2, 0)].startswith("    "):
            lines[i:i] = ["::", ""]


def setup(app):
    app.connect("autodoc-process-docstring", indented_is_code)
    app.connect("doctree-resolved", lead_to_files)
