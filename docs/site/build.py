"""Builds the documentation site: `python docs/site/build.py [FOLDER]`, without network.

A warning is an error: a link that leads nowhere, an anchor that is not there, a page that is not
in `navigation.yaml`, a picture that is missing.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE), str(ROOT)]

from command_pages import write_commands  # noqa: E402
from sphinx.cmd.build import main as sphinx  # noqa: E402
from staging import COMMANDS, stage  # noqa: E402


def build(out: Path) -> int:
    """Make the site in `out`; the exit code of the builder, 0 when nothing was wrong."""
    pages, cache = out / "pages", out / "cache"
    try:
        stage(pages)
    except LookupError as problem:
        sys.stderr.write(f"{problem.args[0]}\n")
        return 1
    write_commands(pages / COMMANDS)
    strict = ["-W", "--keep-going", "--quiet"]
    folders = ["-c", str(HERE), "-d", str(cache), str(pages), str(out / "html")]
    code = sphinx(["-b", "html", *strict, *folders])
    if code == 0:
        sys.stdout.write(f"{out / 'html' / 'index.html'}\n")
    return code


if __name__ == "__main__":
    sys.exit(build(Path(sys.argv[1]) if sys.argv[1:] else ROOT / "build" / "site"))
