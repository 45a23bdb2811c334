"""The theory pages: beside every equation its module, and numbers that are those of the code."""

import re
from pathlib import Path

import pytest
import yaml

from controller.search import gain_objective, gait_objective
from controller.walking.stabilizer import cma_solver, config, evaluation
from hil.robot_files import load_robot
from hil.studies import gain_algorithm

ROOT = Path(__file__).parents[2]
PAGES = [*sorted((ROOT / "docs" / "theory").glob("*.md")), ROOT / "docs" / "jumping.md"]
MODULE = re.compile(r"\]\((?:\.\./)+((?:controller|hil|sim_backends|drivers)/[\w/]+\.py)\)")
SECTION = re.compile(r"^#+ (.*)$", re.MULTILINE)


def sections():
    for page in PAGES:
        _, *parts = SECTION.split(page.read_text(encoding="utf-8"))
        for title, body in zip(parts[::2], parts[1::2], strict=True):
            if "$$" in body:
                yield pytest.param(body, id=f"{page.stem}: {title}")


@pytest.mark.parametrize("section", list(sections()))
def test_every_equation_has_its_module(section):
    modules = MODULE.findall(section.split("$$")[0])
    assert modules
    assert all((ROOT / module).is_file() for module in modules)


def test_a_page_per_seed_names_most_of_the_walking_modules():
    text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    seeds = {"000_bd1305a0ae731442", "003_73fecd8ec8927aad", "004_2880d7939e94ed85"}
    assert seeds <= set(re.findall(r"`(\d+_\w+)`", text))
    named = {Path(module).name for module in MODULE.findall(text)}
    there = {path.name for path in (ROOT / "controller" / "walking").glob("*.py")}
    assert len(named & there) > 25


def figures():
    """Page, and what it must say with the figures that the code has."""
    low, immersed = "low-frequency-walking", "immersed-walking"
    human = load_robot("human", ())
    gait, settings = human.walking["gait"], config.StabilizerConfig()
    yield low, f"$T = {gait['period']}$ s"
    yield low, rf"$\varphi_{{\min}} = {gait['min_phase']}$"
    yield low, rf"$\varphi_{{\max}} = {gait['max_phase']}$"
    yield low, f"touch}} = {gait['touch_down_load'] * 70.4 * 9.81:.0f}$ N"
    yield low, f"$T_r = {human.walking['heading']['ramp_time']}$ s"
    yield low, f"a share falls below {settings.trigger_band}; it aims at $l = {settings.band}$"
    yield low, rf"{evaluation.QUALITY_WEIGHT:.0f} \displaystyle"
    yield low, rf"f_\text{{distance}} = {evaluation.DISTANCE_WEIGHT:.0f} \sum"
    yield low, rf"$\lambda = {cma_solver.POPULATION}$ samples"
    yield low, f"at most {('', 'one', 'two', 'three', 'four', 'five')[cma_solver.GENERATIONS]} gen"
    share = gain_algorithm.LARGE_SHARE
    yield low, f"${1.0 - share:g}\\,S_{{\\min}} + {share}\\,S_"
    yield low, rf"is ${gain_objective.GAINS_WEIGHT:.0f}\,\mu$"
    weights = gait_objective.WEIGHTINGS["3-6-1"].values()
    yield immersed, f"= ({', '.join(f'{weight:.0f}' for weight in weights)})$"
    yield immersed, rf"= {gait_objective.REFERENCE_SHARE} \sum_i \ddot"
    yield immersed, f"$k = {human.walking['learned_velocity']['knots']}$ knots"


@pytest.mark.parametrize(("page", "says"), list(figures()))
def test_figures_are_those_of_the_code(page, says):
    text = (ROOT / "docs" / "theory" / f"{page}.md").read_text(encoding="utf-8")
    assert says in " ".join(text.split())


def test_pages_of_results_show_their_commands():
    navigation = yaml.safe_load((ROOT / "docs/site/navigation.yaml").read_text(encoding="utf-8"))
    for page in navigation["Results"].values():
        text = (ROOT / page).read_text(encoding="utf-8")
        assert re.search(r"stride \w+|python benchmarks/", text), page
        assert re.search(r"(?i)emulated|modelled|simulated|derived", text), page
