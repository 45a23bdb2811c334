"""`stride scan`: who answers, where, and what cannot be believed."""

import json

import pytest

from drivers.commissioning.port_names import found_ports, latency_timer_ms
from drivers.commissioning.search import missing_features
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.servo_models import find_servo_model


def searched(bench, *arguments):
    result = bench.stride("scan", bench.url("left_leg"), "--json", *arguments)
    return result.exit_code, json.loads(result.stdout)[0]


def test_every_servo_is_found_with_its_speed_id_and_model(bench):
    servo = bench.servo("left_knee")
    servo.registers[Register.BAUD_RATE] = servo.baud_code = 1
    code, found = searched(bench, "--baud", "4000000", "--baud", "57600")
    assert code == 0
    where = [(one["baud"], one["id"]) for one in found["servos"]]
    assert where == [*((4_000_000, servo_id) for servo_id in (1, 2, 3, 5, 6)), (57_600, 4)]
    assert {one["model"] for one in found["servos"]} == {"XM430-W350"}
    assert found["suspicious"] == []


def test_a_line_without_servos_is_exit_1(bench):
    code, found = searched(bench, "--baud", "1000000")
    assert (code, found["servos"]) == (1, [])


def test_what_old_firmware_lacks_is_said(bench):
    bench.robot.inject("servo:left_knee:old_firmware=37")
    _, found = searched(bench, "--baud", "4000000")
    lacks = {one["id"]: one["lacks"] for one in found["servos"]}
    assert lacks[1] == []
    assert [feature.split(" (")[0] for feature in lacks[4]] == [
        "fast sync read", "bus watchdog", "startup configuration",
    ]  # fmt: skip


def test_a_model_that_measures_no_current_says_so():
    assert "current control and measurement" in missing_features(find_servo_model("XL430-W250"), 48)


@pytest.mark.parametrize("fault", ["bus:left_leg:collide=1,rx", "bus:left_leg:flip=0.7,rx"])
def test_garbled_answers_are_suspicious(bench, fault):
    bench.robot.inject(fault)
    code, found = searched(bench, "--baud", "4000000")
    assert code == 1
    assert "two servos with one id, a bad cable" in found["suspicious"][0]


def test_a_servo_that_answers_pings_only_is_suspicious(bench):
    servo = bench.servo("left_knee")
    servo.registers[Register.STATUS_RETURN_LEVEL] = servo.status_level = 0
    _, found = searched(bench, "--baud", "4000000")
    assert len(found["suspicious"]) == 1
    assert "id 4: answers pings, not reads" in found["suspicious"][0]


def test_an_impossible_speed_names_the_possible_ones(bench):
    result = bench.stride("scan", bench.url("left_leg"), "--baud", "9601")
    assert result.exit_code == 2
    assert "57600" in result.stderr


def test_without_a_port_nothing_is_sent(bench):
    result = bench.stride("scan", "--json")
    assert result.exit_code == 0
    assert isinstance(json.loads(result.stdout), list)
    assert bench.robot.clock.now_ns() == 0


def test_ports_have_the_names_that_last(tmp_path, monkeypatch):
    device = tmp_path / "ttyUSB0"
    device.touch()
    by_id = tmp_path / "by-id"
    by_id.mkdir()
    (by_id / "usb-FTDI_A-if00").symlink_to(device)

    class Found:
        description = "USB Serial"

        def __init__(self, path):
            self.device = str(path)

    listed = [Found(device), Found(tmp_path / "ttyS0")]
    monkeypatch.setattr("drivers.commissioning.port_names.list_ports.comports", lambda: listed)
    names = {port.device: port.by_id for port in found_ports(by_id)}
    assert names == {str(device): str(by_id / "usb-FTDI_A-if00"), str(tmp_path / "ttyS0"): None}


def test_the_latency_timer_is_found_behind_a_name_that_lasts(tmp_path):
    device = tmp_path / "ttyUSB0"
    device.touch()
    link = tmp_path / "usb-FTDI_A-if00"
    link.symlink_to(device)
    timer = tmp_path / "sys" / "class" / "tty" / "ttyUSB0" / "device"
    timer.mkdir(parents=True)
    (timer / "latency_timer").write_text("16\n")
    assert latency_timer_ms(str(link), tmp_path / "sys") == 16
    assert latency_timer_ms(str(tmp_path / "pts"), tmp_path / "sys") is None
