"""Robot files: what a builder mistypes is named in one line."""

from pathlib import Path

import pytest
import yaml

from hil.errors import DescriptionError, InputError, UnknownNameError
from hil.robot_files import find_robot_file, load_robot, shipped_robots


def edited(tmp_path: Path, change) -> str:
    """A copy of minibiped's file with one change, as a builder would make."""
    data = yaml.safe_load(find_robot_file("minibiped").read_text())
    change(data)
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(data))
    return str(path)


def test_shipped_robots_load_and_agree_with_their_names():
    for name in shipped_robots():
        assert load_robot(name).name == name


def test_unknown_robot_lists_the_valid_ones():
    with pytest.raises(UnknownNameError, match="minibiped"):
        load_robot("nosuch")


def test_missing_file_is_named():
    with pytest.raises(InputError, match=r"nowhere/x\.yaml"):
        load_robot("nowhere/x.yaml")


@pytest.mark.parametrize(
    ("change", "key", "says"),
    [
        (lambda d: d.pop("supply"), "(top)", "supply"),
        (lambda d: d["noise"].pop("gyro"), "noise.gyro", "missing"),
        (lambda d: d["supply"].update(volts=12), "supply.volts", "resistance, voltage"),
        (lambda d: d["joints"][3].update(range="wide"), "joints.3.range", "wide"),
        (lambda d: d["joints"][3].update(range=[1.0, -1.0]), "(top)", "left_knee"),
        (lambda d: d["joints"][1].update(bus="left"), "(top)", "left_leg, right_leg"),
        (lambda d: d["joints"][1].update(id=1), "(top)", "left_hip_yaw and left_hip_roll"),
        (lambda d: d["feet"].pop("right"), "(top)", "left and right"),
        (lambda d: d["feet"]["left"].update(board="foot"), "(top)", "left_foot"),
        (lambda d: d["start"]["joints"].update(left_toe=0.1), "(top)", "left_toe"),
        (lambda d: d["supply"].update(voltage=float("nan")), "supply.voltage", "finite"),
        (lambda d: d.update(actuation="pneumatic"), "actuation", "servo"),
    ],
)
def test_a_mistake_names_file_key_and_choices(tmp_path, change, key, says):
    path = edited(tmp_path, change)
    with pytest.raises(DescriptionError) as caught:
        load_robot(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: {key}: ")
    assert says in message
    assert "\n" not in message
    assert "{" not in message


def test_broken_yaml_is_one_line(tmp_path):
    path = tmp_path / "broken.yaml"
    path.write_text("joints: [")
    with pytest.raises(InputError, match="not valid YAML") as caught:
        load_robot(str(path))
    assert "\n" not in str(caught.value)


def test_override_by_full_and_by_short_key():
    assert load_robot("minibiped", ("supply.voltage=10.5",)).supply.voltage == 10.5
    assert load_robot("minibiped", ("floor_friction=0.4",)).plant.floor_friction == 0.4


@pytest.mark.parametrize("key", ["walking.swing.height", "swing.height", "walking.gait.period"])
def test_override_of_a_nested_key(key):
    changed = load_robot("minibiped", (f"{key}=0.031",)).walking
    section, name = key.split(".")[-2:]
    assert changed[section][name] == 0.031
    same = load_robot("minibiped").walking
    changed[section][name] = same[section][name]
    assert changed == same


def test_an_end_of_a_key_that_two_sections_share_is_refused_and_the_whole_ones_listed():
    with pytest.raises(UnknownNameError, match=r"walking\.placement\.gain_x") as caught:
        load_robot("minibiped", ("gain_x=1.0",))
    assert "walking.balance.gain_x" in str(caught.value)


def test_a_whole_section_and_a_key_that_is_a_number_can_be_set():
    alteration = load_robot("minibiped", ("walking.alteration={gain: 0.5}",)).walking["alteration"]
    assert alteration == {"gain": 0.5}
    gains = load_robot("human", ("walking.gains.300.knee=[1.0, 2.0]",)).walking["gains"]
    assert gains[300]["knee"] == [1.0, 2.0]
    assert gains.keys() == load_robot("human").walking["gains"].keys()


def test_override_with_unknown_key_lists_the_known_ones():
    with pytest.raises(UnknownNameError, match=r"supply\.voltage"):
        load_robot("minibiped", ("volts=3",))


def test_override_with_wrong_type_names_the_key():
    with pytest.raises(DescriptionError, match=r"supply\.voltage"):
        load_robot("minibiped", ("voltage=low",))


@pytest.mark.parametrize("text", ["voltage", "voltage=", "=3"])
def test_override_of_wrong_form_is_refused(text):
    with pytest.raises(InputError, match="--set"):
        load_robot("minibiped", (text,))
