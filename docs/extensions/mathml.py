"""Formulas as MathML, which browsers draw by themselves: no script, no fonts, no network."""

from collections.abc import Callable
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx


def _renderer(display: str) -> Callable[[Any, nodes.Element], None]:
    def visit(translator: Any, node: nodes.Element) -> None:
        formula = convert(node.astext(), display=display)
        if display == "block":
            formula = translator.starttag(node, "div", CLASS="math") + formula + "</div>\n"
        translator.body.append(formula)
        raise nodes.SkipNode

    return visit


def setup(app: Sphinx) -> dict[str, bool]:
    """Add the renderer of formulas."""
    app.add_html_math_renderer("mathml", (_renderer("inline"), None), (_renderer("block"), None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
