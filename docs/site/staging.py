"""Copies the pages of the repository into one tree that the site builder reads.

Pages are written for the code host, where `../controller/x.py` is a link that works. In the site
a link to another page leads to that page, and one to anything else becomes the path as text.
"""

import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
NAVIGATION = Path(__file__).with_name("navigation.yaml")
COMMANDS, DECISIONS = "commands", "docs/decisions"
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
FENCED = re.compile(r"^( *)(`{3,}|~{3,})[^\n]*\n.*?^\1\2[ ]*$", re.DOTALL | re.MULTILINE)
ELSEWHERE = re.compile(r"^([a-z]+:|#)")


def navigation() -> dict[str, dict[str, str]]:
    """Groups of the sidebar: group, then title and path from the root of the repository."""
    groups: dict[str, dict[str, str]] = yaml.safe_load(NAVIGATION.read_text(encoding="utf-8"))
    return groups


def site_path(source: str) -> str:
    """Where a page of the repository is in the site, relative to its root."""
    path = Path(source)
    if path.name == "README.md":
        return "index.md" if path == Path("README.md") else f"robots/{path.parent.name}.md"
    return str(path.relative_to("docs")) if path.parts[0] == "docs" else path.name.lower()


def pages() -> dict[str, str]:
    """Every page by its path in the repository, with its path in the site."""
    listed = [page for group in navigation().values() for page in group.values()]
    decisions = sorted((ROOT / DECISIONS).glob("*.md"))
    sources = ["docs/index.md", *(str(path.relative_to(ROOT)) for path in decisions)]
    sources += [page for page in listed if page not in (COMMANDS, DECISIONS)]
    return {source: site_path(source) for source in sources}


def linked_pages() -> list[tuple[str, str, str]]:
    """Title, path in the repository and path in the site of every page of the sidebar."""
    entries = [entry for group in navigation().values() for entry in group.items()]
    known = pages()
    return [(title, page, known[page]) for title, page in entries if page in known]


def rewritten(text: str, source: str, known: dict[str, str]) -> str:
    """The text of a page with its links as the site needs them; code blocks stay as they are."""
    return "".join(
        part if code else LINK.sub(lambda match: _link(match, source, known), part)
        for part, code in _parts(text)
    )


def _parts(text: str) -> Iterator[tuple[str, bool]]:
    """Code blocks, and what is between them."""
    end = 0
    for block in FENCED.finditer(text):
        yield text[end : block.start()], False
        yield block[0], True
        end = block.end()
    yield text[end:], False


def _link(match: re.Match[str], source: str, known: dict[str, str]) -> str:
    image, label, target = match.groups()
    if ELSEWHERE.match(target):
        return match[0]
    path, _, anchor = target.partition("#")
    place = os.path.normpath(Path(source).parent / path)
    if place == "README.md":
        place = "docs/index.md"
    here = Path(site_path(source)).parent
    if place in known:
        return f"[{label}]({os.path.relpath(known[place], here)}{'#' + anchor if anchor else ''})"
    if image:
        return f"![{label}]({os.path.relpath(site_path(place), here)})"
    if place == DECISIONS:
        return f"[{label}]({os.path.relpath('decisions/index.md', here)})"
    label = " ".join(label.split())
    bare = label.strip("`")
    if bare in (place, Path(place).name):
        return f"`{bare}`"
    before = match.string[: match.start()].rpartition("\n\n")[2]
    within = before.count("(") > before.count(")")
    return f"{label} `{place}`" if within else f"{label} (`{place}`)"


def stage(target: Path) -> None:
    """Write every page, its pictures and the sidebar's lists into `target`, made anew.

    Raises LookupError for a page under docs/ that the navigation does not list.
    """
    shutil.rmtree(target, ignore_errors=True)
    known = pages()
    forgotten = {str(p.relative_to(ROOT)) for p in (ROOT / "docs").rglob("*.md")} - set(known)
    if forgotten:
        raise LookupError(f"docs/site/navigation.yaml does not list {', '.join(sorted(forgotten))}")
    for source, page in known.items():
        path = target / page
        path.parent.mkdir(parents=True, exist_ok=True)
        text = (ROOT / source).read_text(encoding="utf-8")
        path.write_text(rewritten(text, source, known), encoding="utf-8")
    shutil.copytree(ROOT / "docs" / "images", target / "images")
    names = sorted(Path(page).stem for page in known.values() if page.startswith("decisions/"))
    decisions = "# Decisions\n\nWhy it is as it is, one page each.\n\n"
    (target / "decisions" / "index.md").write_text(decisions + toctree(names), encoding="utf-8")
    with (target / "index.md").open("a", encoding="utf-8") as index:
        index.writelines(_groups(known))


def toctree(entries: list[str], *options: str) -> str:
    """A list of pages as the builder wants it: `Title <page>` or `page`."""
    return "\n".join(["```{toctree}", ":maxdepth: 1", *options, "", *entries, "```", ""])


def _groups(known: dict[str, str]) -> Iterator[str]:
    for group, entries in navigation().items():
        lines = [f"{title} <{_docname(page, known)}>" for title, page in entries.items()]
        yield "\n" + toctree(lines, ":hidden:", f":caption: {group}")


def _docname(page: str, known: dict[str, str]) -> str:
    if page in (COMMANDS, DECISIONS):
        return f"{Path(page).name}/index"
    return known[page].removesuffix(".md")
