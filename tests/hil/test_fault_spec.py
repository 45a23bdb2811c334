"""Faults as they are written: what they mean, and what one line says of a mistake."""

import pytest

from hil.errors import InputError
from hil.fault_kinds import all_kinds
from hil.fault_spec import gather_faults, parse_fault, read_fault_plan
from hil.request import RunRequest
from hil.robot_files import load_robot


@pytest.fixture(scope="module")
def minibiped():
    return load_robot("minibiped")


@pytest.mark.parametrize(
    ("text", "kind", "values", "start", "duration"),
    [
        ("servo:left_knee:silent@2+0.5", "silent", (1.0,), 2.0, 0.5),
        ("bus:left_leg:drop=0.01@3", "drop", (0.01, 0.0), 3.0, None),
        ("bus:left_leg:drop=0.01,tx", "drop", (0.01, 1.0), None, None),
        ("bus:*:delay=0.2,1.5,rx@0+1e1", "delay", (0.2, 1.5, 2.0), 0.0, 10.0),
        ("servo:left_knee:alert=overheating@1", "alert", (4.0,), 1.0, None),
        ("board:left_foot:open_cell=rear_left", "open_cell", (2.0,), None, None),
        ("board:left_foot:stuck@.5", "stuck", (), 0.5, None),
    ],
)
def test_a_text_says_what_where_how_much_and_when(text, kind, values, start, duration):
    fault = parse_fault(text)
    assert (fault.kind, fault.values, fault.start, fault.duration) == (
        kind, values, start, duration,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("left_knee:silent", "is not of the form PLANE:NAME:KIND"),
        ("wheel:left_knee:silent", "unknown plane in --fault 'wheel'; valid: servo, board, bus"),
        ("servo:left_knee:drop", "unknown servo fault in --fault 'drop'; valid: silent, frozen"),
        ("bus:left_leg:drop=2", "P must be 0 to 1"),
        ("bus:left_leg:drop=nan", "P must be 0 to 1"),
        ("bus:left_leg:drop=x", "'x' is not a number"),
        ("bus:left_leg:drop=1,up", "unknown 'up'; valid: both, tx, rx"),
        ("servo:left_knee:frozen=1", "too many values; the form is frozen"),
        ("servo:left_knee:reboot@1+2", "happens at one moment"),
        ("servo:left_knee:silent@1+0", "DT above 0"),
        ("servo:left_knee:silent@-1", "is not of the form"),
    ],
)
def test_a_mistake_is_told_in_one_line_with_what_is_valid(text, message):
    with pytest.raises(InputError, match=message) as caught:
        parse_fault(text)
    assert "\n" not in str(caught.value)
    assert caught.value.exit_code == 2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("servo:left_nee:silent", "unknown joint in --fault 'left_nee'; valid: left_hip_yaw"),
        ("bus:left_arm:drop", "unknown bus in --fault 'left_arm'; valid: left_leg, right_leg"),
        ("board:hand:stale", "unknown board in --fault 'hand'; valid: left_foot"),
        ("board:imu:open_cell", "imu has no load cells"),
    ],
)
def test_names_are_checked_against_the_robot(minibiped, text, message):
    with pytest.raises(InputError, match=message):
        RunRequest(faults=gather_faults([text], None)).resolved(minibiped)


def test_a_star_means_all_that_can_have_it(minibiped):
    assert parse_fault("bus:*:drop").targets(minibiped) == ("left_leg", "right_leg")
    assert parse_fault("board:*:open_cell").targets(minibiped) == ("left_foot", "right_foot")
    assert "imu" in parse_fault("board:*:stale").targets(minibiped)


def test_a_plan_file_holds_more_of_them(tmp_path):
    plan = tmp_path / "plan.yaml"
    plan.write_text("faults:\n  - servo:left_knee:silent@1+2\n  - bus:*:drop=0.01@0\n")
    faults = gather_faults(["board:imu:stale@3"], plan)
    assert [fault.kind for fault in faults] == ["stale", "silent", "drop"]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("faults: 3\n", "must hold one key, faults"),
        ("fault:\n  - a\n", "must hold one key, faults"),
        ("faults:\n  - servo:left_knee:sulk\n", "plan.yaml: faults 'sulk'; valid: silent"),
    ],
)
def test_a_bad_plan_names_its_file(tmp_path, content, message):
    plan = tmp_path / "plan.yaml"
    plan.write_text(content)
    with pytest.raises(InputError, match=message):
        read_fault_plan(plan)


@pytest.mark.parametrize(
    "values", [{"backend": "mujoco"}, {"live": True}], ids=["mujoco", "real servos"]
)
def test_only_a_virtual_robot_has_faults(values):
    with pytest.raises(InputError, match="--fault is for a virtual robot"):
        RunRequest.checked(faults=gather_faults(["bus:left_leg:drop"], None), **values)


def test_every_fault_can_be_written_without_values():
    for plane, kind in all_kinds():
        fault = parse_fault(f"{plane}:*:{kind.name}@1")
        assert len(fault.values) == len(kind.values)
