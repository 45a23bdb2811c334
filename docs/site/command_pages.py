"""One page a command, made from the command line itself, so that it cannot tell yesterday's."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer
from staging import ROOT, linked_pages

from hil.cli.main import app

BOLD = re.compile(r"\[bold\](.*?)\[/(?:bold)?\]", re.DOTALL)
PAGE = re.compile(r"(?<![\w/])docs/([\w-]+)\.md")
MOST_GUIDES = 6
OPTION = re.compile(r"(?<![\w`-])(--[a-z][\w-]*)")
DEFAULT = re.compile(r"\s*\[default: \(?(.*?)\)?\]$")


def write_commands(folder: Path) -> None:
    """Write a page for each command into `folder`, and `index.md` that lists them."""
    folder.mkdir(parents=True)
    root: Any = typer.main.get_command(app)
    for name, command in root.commands.items():
        page = "\n".join([*_page(f"stride {name}", command, "#"), *_guides(f"stride {name}")])
        (folder / f"{name}.md").write_text(page, encoding="utf-8")
    (folder / "index.md").write_text("\n".join(_index(root)), encoding="utf-8")


def _guides(title: str) -> Iterator[str]:
    """The pages that speak of a command, those that do most first."""
    counts = {
        (text, page): len(re.findall(rf"{title}\b", (ROOT / source).read_text(encoding="utf-8")))
        for text, source, page in linked_pages()
    }
    found = sorted((one for one in counts if counts[one]), key=lambda one: -counts[one])
    if found:
        yield "## Read on\n"
        yield ", ".join(f"[{text}](../{page})" for text, page in found[:MOST_GUIDES]) + "\n"


def _index(root: Any) -> Iterator[str]:
    yield from ("# Commands", "", _prose(root.help), "")
    yield from ("Every page here is what `stride COMMAND --help` says, and made from it.", "")
    yield from ("| command | what it does |", "|---|---|")
    for name, command in root.commands.items():
        yield f"| [`stride {name}`]({name}.md) | {_cell(_first(command))} |"
    yield from ("", "## Options before the command", "", *_options("stride", root))
    yield from ("```{toctree}", ":hidden:", "", *root.commands, "```", "")


def _page(title: str, command: Any, mark: str) -> Iterator[str]:
    context = typer.Context(command, info_name=title)
    usage = " ".join([title, *command.collect_usage_pieces(context)])
    yield from (f"{mark} {title}", "", _prose(command.help), "", "```sh", usage, "```", "")
    yield from _examples(command.epilog or "", mark)
    inner = getattr(command, "commands", {})
    if inner:
        yield from (f"{mark}# Commands", "")
        for name, below in inner.items():
            anchor = f"{title} {name}".replace(" ", "-")
            yield f"- [`{title} {name}`](#{anchor}): {_prose(_first(below))}"
        yield ""
    yield from (f"{mark}# Options", "", *_options(title, command))
    for name, below in inner.items():
        yield from _page(f"{title} {name}", below, mark + "#")


def _options(title: str, command: Any) -> Iterator[str]:
    context = typer.Context(command, info_name=title)
    for parameter in [p for p in command.get_params(context) if not getattr(p, "hidden", False)]:
        record = parameter.get_help_record(context)
        if record is None:
            continue
        text = DEFAULT.sub("", record[1])
        default = "".join(f" *Default: {_escaped(found)}.*" for found in DEFAULT.findall(record[1]))
        yield from (f"`{record[0]}`", f": {_prose(text)}{default}", "")


def _examples(epilog: str, mark: str) -> Iterator[str]:
    blocks = [block.strip() for block in epilog.split("\n\n") if block.strip()]
    if blocks and re.fullmatch(r"\[bold\]Examples?\[/(bold)?\]", blocks[0]):
        yield from (f"{mark}# Examples", "")
        blocks = blocks[1:]
    shown = [block for block in blocks if block.startswith(("stride ", "echo "))]
    if shown:
        yield from ("```sh", "\n\n".join(_example(block) for block in shown), "```", "")
    yield from (line for block in blocks if block not in shown for line in (_prose(block), ""))


def _example(block: str) -> str:
    """A line as typed, its explanation, which stands beside it in the terminal, above it."""
    line, *note = re.split(r" {2,}", block, maxsplit=1)
    return f"# {' '.join(note[0].split())}\n{line}" if note else line


def _first(command: Any) -> str:
    """The first sentence of a command's help."""
    paragraph = " ".join((command.help or "").split("\n\n")[0].split())
    return paragraph.split(". ")[0].rstrip(".") + "."


def _prose(text: str | None) -> str:
    """Rich markup as Markdown; options as code, named pages as links."""
    parts = BOLD.split(text or "")
    plain = [_escaped(part) for part in parts[::2]]
    strong = [f"`{part}`" if part.startswith("stride") else f"**{part}**" for part in parts[1::2]]
    joined = "".join(a + b for a, b in zip(plain, [*strong, ""], strict=True))
    return PAGE.sub(r"[\1](../\1.md)", joined)


def _escaped(text: str) -> str:
    return OPTION.sub(r"`\1`", re.sub(r"([*_<>|])", r"\\\1", text))


def _cell(text: str) -> str:
    return " ".join(_prose(text).split())
