"""`stride study ceiling`: walks vibrate above the closed form and not below it; figures; input."""

import csv

import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.studies.ceiling import CeilingStudy
from hil.studies.ceiling_rows import CeilingCase, ceiling_of
from hil.studies.gain_sets import gain_overrides, scaled, stored_sets, total_of
from hil.studies.range_file import read_ranges
from hil.studies.vibration import VibrationCase, vibration_of


def study(*arguments):
    return CliRunner().invoke(app, ["study", "ceiling", *map(str, arguments)])


def write_ranges(path, rates=(300, 225), columns=None):
    """A CSV as of `study gains`: 0.6 to 1.05 of the stored sets, and a rate without a range."""
    stored = stored_sets(load_robot("human"))
    rows = [
        {"rate_hz": rate, "joint_group": joint, "kp_min": 0.6 * kp, "kp_max": 1.05 * kp,
         "kd_min": 0.6 * kd, "kd_max": 1.05 * kd}
        for rate in rates
        for joint, (kp, kd) in stored[rate].items()
    ]  # fmt: skip
    rows.append({"rate_hz": 200, "joint_group": "hip"})
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns or list(rows[0]), extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)


def test_a_joint_vibrates_above_its_ceiling_and_not_below():
    """The neck, whose ceiling no other joint disturbs."""
    robot = load_robot("human")
    request = RunRequest.checked(robot="human", rate_hz=300).resolved(robot)
    gains = stored_sets(robot)[300]
    case = CeilingCase(
        request=request,
        gains=tuple((joint, *pair) for joint, pair in gains.items()),
        poses=4,
        walk_s=2.0,
    )
    rows = {row["joint_group"]: row for row in ceiling_of(case)["rows"]}
    factor = rows["neck"]["factor"]
    assert 2.0 < factor < 3.0
    assert rows["neck"]["kd_ceiling"] == pytest.approx(factor * gains["neck"][1])
    found = []
    for share in (0.9, 1.15):
        changes = gain_overrides(robot, 300, scaled(gains, {"neck": share * factor}))
        walk = request.model_copy(update={"duration_s": 1.5, "overrides": changes})
        found.append(vibration_of(VibrationCase(request=walk)))
    below, above = found
    assert below["vibration"] < 1.0 < 3.0 < above["vibration"]
    assert above["joint"].startswith("neck") and above["ending"] is None


def test_both_figures_of_the_seed_are_drawn_from_the_csv_of_the_gain_study(tmp_path):
    file, out = tmp_path / "gains.csv", tmp_path / "out"
    write_ranges(file)
    result = study(
        "human", "--range", file, "--no-check", "--poses", 4, "--duration", 1.5, "--jobs", 1,
        "--out", out,
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    assert (out / "ceiling.png").read_bytes().startswith(b"\x89PNG")
    with (out / "ceiling.csv").open(newline="") as ceilings:
        rows = list(csv.DictReader(ceilings))
    assert {row["rate_hz"] for row in rows} == {"300", "225"}
    neck = next(row for row in rows if (row["rate_hz"], row["joint_group"]) == ("300", "neck"))
    assert float(neck["kp"]) == pytest.approx(1.05 * 300.0)


def test_sums_of_the_stored_sets_are_those_of_the_published_files():
    robot = load_robot("human")
    sums = {rate: total_of(robot, gains) for rate, gains in stored_sets(robot).items()}
    assert sums == {
        225: 5350.0, 250: 7460.0, 300: 7760.0, 500: 8960.0, 750: 8990.0, 1000: 16030.0,
        2000: 24180.0,
    }  # fmt: skip


def test_a_servo_robot_is_told_what_bus_and_registers_allow(tmp_path):
    out = tmp_path / "out"
    result = study(
        "minibiped", "--backend", "mujoco", "--quick", "--duration", 1.5, "--jobs", 1,
        "--out", out,
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    with (out / "ceiling.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 6
    for row in rows:
        assert float(row["kd_register"]) < float(row["kd_ceiling"])
        assert float(row["kp_register"]) < float(row["kp_ceiling"])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("rate_hz,joint_group\n300,hip\n", "no column kp_min"),
        ("", "no column rate_hz"),
        ("rate_hz,joint_group,kp_min,kp_max,kd_min,kd_max\n300,hip,,,,\n", "no rate in it"),
    ],
)
def test_other_files_are_refused(text, told, tmp_path):
    file = tmp_path / "other.csv"
    file.write_text(text)
    result = study("human", "--range", file, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and told in result.stderr
    assert study("human", "--range", tmp_path / "none.csv").exit_code == 2


def test_rates_do_not_go_with_a_file(tmp_path):
    write_ranges(tmp_path / "gains.csv")
    result = study("human", "--range", tmp_path / "gains.csv", "-r", 300)
    assert result.exit_code == 2 and "--rate" in result.stderr


def test_a_range_needs_both_ends(tmp_path):
    write_ranges(tmp_path / "gains.csv")
    ranges = read_ranges(tmp_path / "gains.csv")
    assert [found.rate_hz for found in ranges] == [300, 225]
    kp, kd = ranges[0].middle("knee")
    assert (kp, kd) == (pytest.approx(0.825 * 300.0), pytest.approx(0.825 * 20.0))


def test_ceilings_need_a_robot_that_walks():
    request = RunRequest.checked(robot="human").resolved(load_robot("human"))
    study_ = CeilingStudy(request=request, rates_hz=(300,), poses=2, walk_s=1.0, check=False)

    def falls(function, cases, counter=None):
        return [{"error": "fell at 0.50 s"} for _ in cases]

    with pytest.raises(Exception, match=r"fell at 0\.50 s"):
        study_.conduct(falls)
