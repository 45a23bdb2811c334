"""Algorithm 1 on two rates with walks of 1.4 s, and a program that runs it."""

import sys
from pathlib import Path

from hil.cli.study_conduct import resolved_request
from hil.studies.gain_range import GainRangeStudy
from hil.studies.run import run_study
from hil.studies.search.budget import SearchBudget


def tiny(rates_hz=(300, 275), **settings):
    """Two joints, one iteration of four candidates."""
    values = {
        "request": resolved_request("human", None, None, pd="explicit"),
        "rates_hz": rates_hz,
        "joints": ("knee", "toe"),
        "budget": SearchBudget(iterations=1, population=4),
        "runs": 1,
        "warm_s": 0.48,
        "leg_s": 0.32,
    }
    return GainRangeStudy(**values | settings)


if __name__ == "__main__":
    run_study(tiny(), Path(sys.argv[1]), jobs=1)
