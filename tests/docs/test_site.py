"""The built site: whole, without a dead link, and without a request to any other host."""

import json
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlparse

import pytest
import typer
import yaml

from hil.cli.main import app

ROOT = Path(__file__).parents[2]
KATEX = ROOT / "docs" / "site" / "static" / "katex" / "katex.min.js"
LOADED = {"script": "src", "link": "href", "img": "src", "iframe": "src", "source": "src"}
NOT_LOADED = {"canonical", "next", "prev", "search", "index"}


class Page(HTMLParser):
    """Ids, links, what a browser loads, and the text of equations."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.ids, self.links, self.loads, self.equations = set(), [], [], []
        self._equation = None
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        if "id" in given:
            self.ids.add(given["id"])
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        loaded = given.get(LOADED.get(tag, ""))
        if loaded and given.get("rel") not in NOT_LOADED:
            self.loads.append(loaded)
        if given.get("class") == "equation":
            self._equation = ""

    def handle_data(self, data):
        if self._equation is not None:
            self._equation += data

    def handle_endtag(self, tag):
        if self._equation is not None and tag in ("span", "div"):
            self.equations.append(self._equation)
            self._equation = None


@pytest.fixture(scope="session")
def site_pages(site):
    return {path: Page(path) for path in site.rglob("*.html") if "_static" not in path.parts}


def test_every_page_of_the_navigation_is_there(site):
    navigation = yaml.safe_load((ROOT / "docs/site/navigation.yaml").read_text(encoding="utf-8"))
    sidebar = (site / "index.html").read_text(encoding="utf-8")
    for group, pages in navigation.items():
        assert f">{group}<" in sidebar
        for title in pages:
            assert f">{title}</a>" in sidebar
    assert len(list(site.rglob("*.html"))) > 40


def test_nothing_is_asked_of_another_host(site, site_pages):
    for path, page in site_pages.items():
        foreign = [target for target in page.loads if urlparse(target).netloc]
        assert not foreign, f"{path.relative_to(site)} loads {foreign}"
    for path in site.rglob("*.css"):
        sheet = path.read_text(encoding="utf-8")
        assert not re.search(r"(url\(|@import)\s*[\"']?(https?:)?//", sheet), path.name


def test_links_and_anchors_lead_somewhere(site, site_pages):
    for path, page in site_pages.items():
        for link in page.links:
            parts = urlparse(link)
            if parts.scheme or parts.netloc:
                continue
            place = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            where = f"{path.relative_to(site)} links to {link}"
            assert place.is_file(), where
            if parts.fragment and place in site_pages:
                assert unquote(parts.fragment) in site_pages[place].ids, where


def test_what_a_page_loads_is_there(site, site_pages):
    for path, page in site_pages.items():
        for target in page.loads:
            place = path.parent / unquote(urlparse(target).path)
            assert place.is_file(), f"{path.relative_to(site)} loads {target}"


def test_fonts_of_equations_are_there(site):
    sheet = site / "_static" / "katex" / "katex.min.css"
    fonts = re.findall(r"url\(([^)]+)\)", sheet.read_text(encoding="utf-8"))
    assert len(fonts) == 20
    assert all((sheet.parent / font).is_file() for font in fonts)


def test_search_knows_the_pages(site):
    index = (site / "searchindex.js").read_text(encoding="utf-8")
    assert "quick-start" in index and "commands/walk" in index


def leaves(command, title):
    yield title, command
    for name, inner in getattr(command, "commands", {}).items():
        yield from leaves(inner, f"{title} {name}")


def test_every_command_and_option_has_its_place(site):
    for title, command in leaves(typer.main.get_command(app), "stride"):
        page = [*title.split(), "index"][1]
        text = (site / "commands" / f"{page}.html").read_text(encoding="utf-8")
        assert title in text
        for parameter in [one for one in command.params if not one.hidden]:
            for option in [one for one in parameter.opts if one.startswith("-")]:
                assert option in text, f"{page}.html lacks {option}"


def test_equations_are_written_in_tex_that_katex_knows(site_pages, tmp_path):
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed")
    equations = [tex for page in site_pages.values() for tex in page.equations]
    assert len(equations) > 100
    check = tmp_path / "check.js"
    check.write_text(
        f"const katex = require({str(KATEX)!r});\n"
        "const texts = JSON.parse(require('fs').readFileSync(0));\n"
        "for (const tex of texts) katex.renderToString(tex, {displayMode: true, strict: 'error'});",
        encoding="utf-8",
    )
    done = subprocess.run(
        [node, check], input=json.dumps(equations), text=True, capture_output=True
    )
    assert done.returncode == 0, done.stderr


def test_links_to_code_become_its_path(site_tools):
    from staging import rewritten

    known = {"docs/a.md": "a.md", "CONTRIBUTING.md": "contributing.md", "docs/t/b.md": "t/b.md"}

    def shown(text):
        return rewritten(text, "docs/t/b.md", known)

    assert shown("[A](../a.md#x)") == "[A](../a.md#x)"
    assert shown("[how](../../CONTRIBUTING.md)") == "[how](../contributing.md)"
    assert shown("[`c.py`](../../hil/c.py)") == "`c.py`"
    assert shown("see [the loop](../../hil/c.py)") == "see the loop (`hil/c.py`)"
    assert shown("(see [it](../../hil/c.py))") == "(see it `hil/c.py`)"
    assert shown("![p](../images/p.png)") == "![p](../images/p.png)"
    assert shown("[w](https://example.org)") == "[w](https://example.org)"
    assert shown("```\n[A](../../hil/c.py)\n```") == "```\n[A](../../hil/c.py)\n```"


def test_a_page_that_is_not_in_the_navigation_is_refused(site_tools, monkeypatch, tmp_path):
    import staging

    groups = staging.navigation()
    monkeypatch.setattr(staging, "navigation", lambda: groups | {"Results": {}})
    with pytest.raises(LookupError, match=r"navigation\.yaml does not list .*docs/robustness\.md"):
        staging.stage(tmp_path / "pages")
