"""`stride bench bus` and `--budget`: figures that add up, on the virtual robot."""

import json

import pytest
from typer.testing import CliRunner

from hil.budget import baud_table
from hil.bus_report import measure_buses, rows_of
from hil.cli.main import app
from hil.errors import InputError, PortError
from hil.robot_files import load_robot


def rows(baud=None):
    return rows_of(measure_buses("minibiped", None, baud, [], 60, False, ()))


def test_the_parts_of_a_cycle_add_up_to_what_is_measured():
    left, right = rows()
    assert (left["bus"], right["bus"]) == ("left_leg", "right_leg")
    for row in (left, right):
        assert row["read"] == "fast"
        assert row["timeouts"] == row["crc_errors"] == row["lost_pct"] == 0
        assert row["limit"] == "latency timer"
        assert row["waiting ms"] < 0.1
        assert row["p50_ms"] <= row["p90_ms"] <= row["p99_ms"] <= row["max_ms"]
        assert row["rate_hz"] == pytest.approx(1e3 / row["p99_ms"])


def test_a_slow_wire_is_named_as_the_limit():
    slow = rows(1_000_000)
    assert {row["limit"] for row in slow} == {"bytes on the wire"}
    assert slow[0]["rate_hz"] < rows()[0]["rate_hz"]


def test_a_port_that_is_not_there_and_a_robot_without_bus_are_refused():
    with pytest.raises(PortError):
        measure_buses("minibiped", "/dev/none", 1_000_000, [], 10, False, ())
    with pytest.raises(InputError):
        measure_buses("human", None, None, [], 10, False, ())


def test_the_command_prints_json():
    result = CliRunner().invoke(app, ["bench", "bus", "--cycles", "20", "--json"])
    assert result.exit_code == 0, result.output
    assert [row["servos"] for row in json.loads(result.stdout)] == [6, 6]


def test_faster_wires_and_more_ports_leave_more_of_the_period():
    table = {(row.baud, row.ports): row for row in baud_table(load_robot("minibiped"), 300)}
    for ports in (1, 2):
        free = [table[baud, ports].free_pct for baud in sorted({baud for baud, _ in table})]
        assert free == sorted(free)
    assert all(table[b, 2].free_pct > table[b, 1].free_pct for b in {baud for baud, _ in table})
    assert table[4_000_000, 2].bus_free_pct >= 30
    assert table[1_000_000, 1].highest_rate_hz < 300
