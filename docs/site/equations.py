"""Equations of the site: written as TeX, set in the browser by the KaTeX beside this file.

Nothing is asked of another host, and a browser without scripts shows the TeX.
"""

from docutils import nodes
from sphinx.application import Sphinx

FILES = ("katex/katex.min.js", "equations.js")


def _inline(writer: nodes.NodeVisitor, node: nodes.math) -> None:
    writer.body.append(_element(writer, "span", node.astext()))
    raise nodes.SkipNode


def _block(writer: nodes.NodeVisitor, node: nodes.math_block) -> None:
    writer.body.append(_element(writer, "div", node.astext()))
    raise nodes.SkipNode


def _element(writer: nodes.NodeVisitor, tag: str, tex: str) -> str:
    return f'<{tag} class="equation">{writer.encode(tex.strip())}</{tag}>'


def _files(
    app: Sphinx, page: str, template: str, context: dict[str, object], tree: nodes.document | None
) -> None:
    del page, template, context
    if tree is not None and any(tree.findall(_is_equation)):
        app.add_css_file("katex/katex.min.css")
        for file in FILES:
            app.add_js_file(file, loading_method="defer")


def _is_equation(node: nodes.Node) -> bool:
    return isinstance(node, nodes.math | nodes.math_block)


def setup(app: Sphinx) -> dict[str, bool]:
    """Make this the renderer of equations; called by the builder."""
    app.add_html_math_renderer("katex", (_inline, None), (_block, None))
    app.connect("html-page-context", _files)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
