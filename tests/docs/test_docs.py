"""The documentation cannot rot: links lead somewhere, and commands are commands."""

import re
import shlex
from pathlib import Path

import pytest
import typer

from hil.cli.main import app

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    path
    for pattern in ("*.md", "docs/**/*.md", "hil/**/*.md", "drivers/**/*.md")
    for path in ROOT.glob(pattern)
)
LINK = re.compile(r"\]\(([^)#]+)(#[^)]*)?\)")
COMMAND = re.compile(r"^\s*(?:\$ )?(stride [^#\n]*)", re.MULTILINE)
FENCE = re.compile(r"```(?:sh|console)\n(.*?)```", re.DOTALL)


def commands() -> list[tuple[str, str]]:
    found = []
    for page in PAGES:
        for block in FENCE.findall(page.read_text(encoding="utf-8")):
            found += [(page.name, line.strip()) for line in COMMAND.findall(block)]
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_files(page):
    for target, _ in LINK.findall(page.read_text(encoding="utf-8")):
        if not target.startswith(("http://", "https://")):
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_lines_wrap_at_100(page):
    in_table = ("|", "![", "http", "- [")
    long = [
        line
        for line in page.read_text(encoding="utf-8").splitlines()
        if len(line) > 100 and not line.lstrip().startswith(in_table)
    ]
    assert not long, f"{page.name}: {long[0]}"


@pytest.mark.parametrize(("page", "line"), commands())
def test_shown_commands_parse(page, line):
    words = shlex.split(line)[1:]
    group = typer.main.get_command(app)
    with group.make_context("stride", words[:0], resilient_parsing=True) as context:
        name, command, rest = group.resolve_command(context, words)
        command.make_context(name, [word for word in rest if word != "--help"])


def test_the_readme_shows_commands():
    assert any(page == "README.md" for page, _ in commands())
