"""How every figure looks: colours and matplotlib settings."""

LEFT, RIGHT, BODY = "#d9722b", "#2a6f97", "#4a4e54"
"""Colours of the left side, the right side and the rest; of two runs, the first and the second."""
WARNING = "#c1272d"
"""Of what was commanded, and of what went wrong."""
LIMIT = "#6b7078"
"""Of lines that mark a limit, and of what is written beside them."""
WATER = "#7fb2cf"

STYLE = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#9a9ea4",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e6e8ea",
    "legend.frameon": False,
    "text.color": "#2b2e33",
    "axes.labelcolor": "#2b2e33",
}
