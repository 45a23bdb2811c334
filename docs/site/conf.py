"""Settings of the documentation site; `build.py` beside this file makes it."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

from hil import __version__  # noqa: E402  (the version of the checkout this file is in)

project = "StrideBridge"
author = "the StrideBridge authors"
copyright = f"{author}; Apache-2.0"
version = release = __version__

extensions = ["myst_parser", "equations"]
myst_enable_extensions = ["deflist", "dollarmath"]
myst_dmath_double_inline = True
myst_fence_as_directive = ["math"]
myst_heading_anchors = 5
source_suffix = {".md": "markdown"}
nitpicky = True
smartquotes = False
highlight_language = "text"

html_theme = "furo"
html_title = f"StrideBridge {version}"
html_static_path = [str(HERE / "static")]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
pygments_style = "friendly"
pygments_dark_style = "monokai"
