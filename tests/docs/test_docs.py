"""The documentation cannot rot: links lead somewhere, files are there, commands are commands."""

import importlib
import re
import shlex
from pathlib import Path

import pytest
import typer

from hil.cli.main import app
from hil.robot_files import load_robot

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    path
    for pattern in ("*.md", "docs/**/*.md", "hil/**/*.md", "drivers/**/*.md")
    for path in ROOT.glob(pattern)
)
LINK = re.compile(r"\]\(([^)#]+)(#[^)]*)?\)")
ANCHORED = re.compile(r"\]\(([^)#]*)#([^)]+)\)")
FENCE = re.compile(r"^```[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
INDENTED = re.compile(r"(?<=\n\n)((?: {4}[^\n]*\n)+)")
LINE = re.compile(r"^\s*(?:\$ )?((?:stride|python benchmarks)\b[^\n]*)", re.MULTILINE)
INLINE = re.compile(r"(?<!`)`((?:stride|python benchmarks)\b[^`]*)`(?!`)")
SOURCE = re.compile(
    r"`((?:\.\./)*(?:controller|hil|drivers|sim_backends|benchmarks|tests)/[\w/.-]*)`"
)
SHELL = re.compile(r"[|>;&#]|\s{2,}")
"""Where a command ends: the shell's own signs, a comment, or a column of explanations."""
RUNS = ("walk", "jump", "stand", "sit")
STRIDE = typer.main.get_command(app)
AT_ONCE = {"--help", "--version", "--install-completion", "--show-completion"}
"""Options that act while they are parsed."""


def commands() -> list[tuple[str, str]]:
    """Page and command of every command line in a block or in the text."""
    found = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        blocks = FENCE.findall(text) + INDENTED.findall(FENCE.sub("", text))
        blocks = [re.sub(r"\\\n\s*", "", block) for block in blocks]
        shown = [line for block in blocks for line in LINE.findall(block)]
        shown += [" ".join(code.split()) for code in INLINE.findall(FENCE.sub("", text))]
        name = str(page.relative_to(ROOT))
        found += [(name, SHELL.split(line)[0].strip()) for line in shown]
    return list(dict.fromkeys(found))


def stride_commands() -> list[tuple[str, str]]:
    """Those of this program."""
    return [(page, line) for page, line in commands() if line.split()[0] == "stride"]


def words_of(line):
    """Its words, but for what acts at once; a capital letter stands for a number, `…` for more."""
    words = [re.sub(r"^[A-Z]$", "1", word) for word in shlex.split(line)[1:]]
    pairs = zip(["", *words], words, strict=False)
    more = [word for last, word in pairs if word != "…" or last.startswith("-")]
    return [word for word in more if word not in AT_ONCE]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_files(page):
    for target, _ in LINK.findall(page.read_text(encoding="utf-8")):
        if not target.startswith(("http://", "https://")):
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


def anchors(page):
    """Anchors of its headings, as the code host makes them."""
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    titles = re.findall(r"^#+ +(.*)$", text, re.MULTILINE)
    plain = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title) for title in titles]
    return {re.sub(r"[^\w\- ]", "", title).strip().lower().replace(" ", "-") for title in plain}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_headings(page):
    for target, anchor in ANCHORED.findall(page.read_text(encoding="utf-8")):
        place = page.parent / target if target else page
        if place.suffix == ".md" and "://" not in target:
            assert anchor in anchors(place), f"{page.name} links to {target}#{anchor}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_lines_wrap_at_100(page):
    in_table = ("|", "![", "http", "- [", "[`")
    long = [
        line
        for line in page.read_text(encoding="utf-8").splitlines()
        if len(line) > 100 and not line.lstrip().startswith(in_table)
    ]
    assert not long, f"{page.name}: {long[0]}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_named_files_are_there(page):
    for path in SOURCE.findall(page.read_text(encoding="utf-8")):
        assert "NAME" in path or (ROOT / path).exists(), f"{page.name} names {path}"


def parse(command, name, words):
    """Parse a command and those below it; an argument that the text leaves out may be missing."""
    left_out = ("MissingParameter", "NoArgsIsHelpError", "BadOptionUsage")
    try:
        context = command.make_context(name, list(words))
    except Exception as error:
        if type(error).__name__ in left_out:
            return
        raise
    rest = [*context._protected_args, *context.args]
    if hasattr(command, "commands") and rest:
        inner_name, inner, rest = command.resolve_command(context, rest)
        parse(inner, inner_name, rest)


@pytest.mark.parametrize(("page", "line"), stride_commands())
def test_shown_commands_parse(page, line):
    parse(STRIDE, "stride", words_of(line))


@pytest.mark.parametrize(
    ("page", "line"),
    [one for one in stride_commands() if one[1].split()[1:2] and one[1].split()[1] in RUNS],
)
def test_shown_runs_would_start(page, line, monkeypatch):
    """Speeds, pushes, faults and settings are checked as for a run; robots of one's own are not."""
    words = words_of(line)
    if any(word.endswith((".yaml", "ROBOT")) or word == "…" for word in words):
        pytest.skip("a robot file that does not ship")
    started = []

    def resolve(request, **_):
        started.append(request.resolved(load_robot(request.robot, request.overrides)))

    monkeypatch.setattr(importlib.import_module(f"hil.cli.{words[0]}"), "conduct", resolve)
    app(words, standalone_mode=False)
    assert started


@pytest.mark.parametrize(
    ("page", "line"), [one for one in commands() if one[1].startswith("python")]
)
def test_shown_benchmarks_are_there(page, line):
    assert (ROOT / line.split()[1]).is_file(), page


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_shown_make_targets_are_there(page):
    targets = re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    shown = re.findall(r"(?:`|^)make (\w+)", page.read_text(encoding="utf-8"), re.MULTILINE)
    assert set(shown) <= set(targets)


def test_the_readme_shows_commands():
    assert any(page == "README.md" for page, _ in stride_commands())
