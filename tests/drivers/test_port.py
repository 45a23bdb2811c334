"""Ports on real pseudo-terminals."""

import os

import pytest

from drivers.dynamixel import port as port_module
from drivers.dynamixel.port import Port, latency_warning, read_latency_timer_ms
from hil.clock import MonotonicClock
from hil.errors import BackendError, PortError


@pytest.fixture
def pty():
    master, slave = os.openpty()
    yield master, os.ttyname(slave)
    for descriptor in (master, slave):
        try:
            os.close(descriptor)
        except OSError:
            continue


def test_bytes_go_both_ways_without_waiting(pty):
    master, path = pty
    port = Port("left_leg", path, 4_000_000)
    port.write(b"\x01\xff\x0a\x0d\x00")
    assert os.read(master, 100) == b"\x01\xff\x0a\x0d\x00"
    assert port.read_available() == b""
    os.write(master, b"\x0d\x0a\xff\x00")
    clock = MonotonicClock()
    clock.wait_readable([port.stream], clock.now_ns() + 1_000_000_000)
    assert port.read_available() == b"\x0d\x0a\xff\x00"
    assert (port.sent_bytes, port.received_bytes) == (5, 4)
    port.close()
    port.close()


def test_a_second_opening_is_refused(pty):
    port = Port("left_leg", pty[1], 1_000_000)
    with pytest.raises(PortError, match="right_leg: cannot open port"):
        Port("right_leg", pty[1], 1_000_000)
    port.close()


def test_a_port_that_goes_away_is_an_error_with_its_name(pty):
    master, path = pty
    port = Port("left_leg", path, 1_000_000)
    os.close(master)
    with pytest.raises(BackendError, match=rf"port left_leg \({path}\) is lost"):
        for _ in range(3):
            port.write(b"\x00")
            port.read_available()
    port.close()


@pytest.mark.parametrize("url", ["/dev/none", "nonsense://x", "virtual://nobody/left_leg"])
def test_what_cannot_be_opened_is_named_with_the_ports_there_are(url):
    with pytest.raises(PortError, match=f"left_leg: cannot open port '{url}'.*ports found: "):
        Port("left_leg", url, 1_000_000)


@pytest.mark.parametrize(("timer_ms", "warns"), [(16, True), (1, False)])
def test_an_adapter_that_holds_answers_back_is_named_with_the_cure(
    pty, tmp_path, monkeypatch, timer_ms, warns
):
    _, path = pty
    device = path.rpartition("/")[2]
    (tmp_path / device).mkdir()
    (tmp_path / device / "latency_timer").write_text(f"{timer_ms}\n")
    port = Port("left_leg", path, 4_000_000)
    assert port.latency_timer_ms is None
    assert latency_warning(port, 1) is None
    monkeypatch.setattr(port_module, "USB_SERIAL", tmp_path)
    port.latency_timer_ms = read_latency_timer_ms(path, tmp_path)
    assert port.latency_timer_ms == timer_ms
    warning = latency_warning(port, 1)
    port.close()
    assert (warning is not None) == warns
    if warning:
        assert f"holds answers back for {timer_ms} ms" in warning
        assert f"echo 1 | sudo tee {tmp_path}/{device}/latency_timer" in warning


def test_ports_are_suggested_by_names_that_last(pty, tmp_path, monkeypatch):
    _, path = pty
    (tmp_path / "usb-FTDI_42").symlink_to(path)
    monkeypatch.setattr(port_module, "BY_ID", tmp_path)
    found = [type("Found", (), {"device": path})()]
    monkeypatch.setattr(port_module.list_ports, "comports", lambda: found)
    with pytest.raises(PortError, match=f"ports found: {tmp_path}/usb-FTDI_42"):
        Port("left_leg", "/dev/none", 1_000_000)
