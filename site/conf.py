"""Sphinx's settings of the site; `./dev site` runs it. Design: docs/decisions/0702-studio-and-reports.md"""
import os
import pathlib
import re
import sys

from docutils import nodes

SOURCE = pathlib.Path(os.environ["JOULEPATH_SOURCE"])
sys.path.insert(0, str(SOURCE / "python"))

project = "joulepath"
copyright = "the joulepath authors, BSD-3-Clause"  # noqa: A001  (Sphinx's name)
release = re.search(r"project\(joulepath VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "sphinx.ext.autodoc"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
html_math_renderer = "katex"
html_static_path = ["_static"]
html_css_files = ["katex/katex.min.css", "site.css"]
html_js_files = ["katex/katex.min.js", "formulas.js"]

autodoc_mock_imports = ["joulepath._core", "ortools"]  # the compiled part is not needed to read docstrings
autodoc_member_order = "bysource"
autodoc_typehints = "signature"

pygments_style, pygments_dark_style = "default", "github-dark"  # contrasts of 4.5 on the theme's grounds
html_theme = "furo"
html_favicon = "_static/icon.svg"
html_title = f"joulepath {release}"
html_show_sphinx = False
html_copy_source = False
html_extra_path = ["extra"]
html_theme_options = {"light_css_variables": {"color-brand-primary": "#0b5cad", "color-brand-content": "#0b5cad"},
                      "dark_css_variables": {"color-brand-primary": "#7db7f0", "color-brand-content": "#7db7f0"}}
suppress_warnings = ["myst.header"]  # pages of results may skip a level


def formula(tag):
    def visit(self, node):
        self.body.append(self.starttag(node, tag, "", CLASS="math") + self.encode(node.astext()) + f"</{tag}>")
        raise nodes.SkipNode
    return visit


def setup(app):
    app.add_html_math_renderer("katex", (formula("span"), None), (formula("div"), None))
