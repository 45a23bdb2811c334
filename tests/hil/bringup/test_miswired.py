"""Robots that were put together wrongly: each is refused, with the sentence that says why."""

import json

import pytest

from hil.errors import InputError
from hil.miswire import MISWIRE_KINDS, parse_miswires
from hil.robot_files import load_robot

CHECKED = {
    "swap=left_leg,right_leg": "the ports of left_leg and right_leg are swapped",
    "swap=left_foot,imu": "sends frames of an imu board",
    "model=left_knee,XL430-W250": "is XL430-W250, the robot file says XM430-W350",
    "firmware=right_knee,40": "has firmware 40, the other XM430-W350 have 48",
    "volts=16.8": "overvoltage destroys servos: cut the power now",
    "imu=180,0,0": "says that the torso is tilted by 180°",
    "offset=left_hip_roll,60": "left_hip_roll: stands at",
}


@pytest.mark.parametrize("miswire", CHECKED)
def test_check_refuses_it_with_the_right_sentence(calibrated, miswire):
    bench = calibrated(miswire=[miswire])
    result = bench.stride("check", bench.file, *bench.ports(), "--json")
    assert result.exit_code == 1, result.output
    said = [
        f"{row['where']}: {row['what']}: {row['advice']}"
        for row in json.loads(result.stdout)["findings"]
        if row["severity"] == "problem"
    ]
    assert any(CHECKED[miswire] in one for one in said), said


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("mirror", "mirror=JOINT"),
        ("twist=left_knee", "swap=A,B"),
        ("mirror=left_elbow", "valid: left_hip_yaw"),
        ("swap=left_leg,imu", "valid: left_leg, right_leg"),
        ("swap=left_leg", "needs 2 value(s)"),
        ("offset=left_knee,much", "'much' is not a number"),
        ("cells=left_foot,front_left,heel", "valid: front_left"),
        ("cells=imu,front_left,rear_left", "valid: left_foot, right_foot"),
        ("volts=-3", "above 0"),
    ],
)
def test_a_wrong_option_names_the_choices(text, says):
    with pytest.raises(InputError) as caught:
        parse_miswires([text], load_robot("minibiped"))
    assert says in str(caught.value)


def test_the_help_of_emulate_names_every_kind(bench):
    said = " ".join(bench.stride("emulate", "--help").stdout.replace("│", " ").split())
    assert all(kind.form.replace(" ", "") in said.replace(" ", "")
               for kind in MISWIRE_KINDS.values())  # fmt: skip
