"""The software stop in virtual time: from every state with torque on, at any phase of a tick."""

import os
import signal

import pytest

from hil.compose import build
from hil.loop import Loop
from hil.request import RunRequest
from hil.signals import OperatorStop

BOUND_NS = 5_000_000
"""From the request to a torque-off frame on every bus."""
REQUEST = RunRequest(
    duration_s=1.0,
    overrides=("plant.draws=null", "plant.substeps=2"),
    schedules={"speed": ((0.0, 0.1),)},
)


class Stopped:
    """A dry run, its servos' journal, and a signal at a moment of virtual time."""

    def __init__(self, *requests):
        """`requests`: pairs of virtual time [ns] and signal."""
        session = build(REQUEST)
        self.robot = session.closers[0].__self__
        self.clock = self.robot.clock
        self.journal = self.robot.journal(self.clock.now_ns)
        for time_ns, number in requests:
            self.clock.schedule(time_ns, lambda number=number: os.kill(os.getpid(), number))
        session.backend.open()
        self.loop = Loop(session, ())

    def deeds(self, since_ns=0):
        return [deed for deed in self.journal.content()["deeds"] if deed[0] >= since_ns]

    def require_off(self, since_ns):
        """Frames on every bus in time, and every servo limp at the end."""
        first = {}
        for time_ns, joint, what in self.deeds(since_ns):
            if what == "torque off":
                first.setdefault(joint, time_ns - since_ns)
        last = {joint: what for _, joint, what in self.deeds()}
        assert set(last.values()) == {"torque off"}
        armed = {joint for time_ns, joint, what in self.deeds() if "on" in what}
        assert armed and max(first[joint] for joint in armed) <= BOUND_NS
        assert all(servo.registers.memory[64] == 0 for servo in self.robot.servos.values())


@pytest.fixture(scope="module")
def times():
    """When torque goes on, the robot is let go, and it sits [ns]: every dry run is the same."""
    whole = Stopped()
    whole.loop.run()
    on_ns = [time_ns for time_ns, _, what in whole.deeds() if what == "torque on"]
    off_ns = min(time_ns for time_ns, _, what in whole.deeds(max(on_ns)) if what == "torque off")
    return {"arming": min(on_ns), "armed": max(on_ns), "off": off_ns}


MOMENTS = [
    ("arming", 20_000),
    ("arming", 400_000),
    ("armed", 700_000),
    ("armed", 500_100_000),  # the ramp
    ("armed", 1_301_000_000),  # on its own feet
    ("armed", 1_900_300_000),  # walking, at five phases of a tick
    ("armed", 1_903_900_000),
    ("armed", 1_907_400_000),
    ("armed", 1_911_200_000),
    ("armed", 1_914_600_000),
    ("off", -700_000_000),  # sitting down
    ("off", -1_200_000),
]


@pytest.mark.parametrize(("state", "after_ns"), MOMENTS)
def test_torque_off_is_on_the_wire_in_five_milliseconds_whatever_the_robot_does(
    times, state, after_ns
):
    asked_ns = times[state] + after_ns
    stopped = Stopped((asked_ns, signal.SIGQUIT))
    with pytest.raises(OperatorStop, match="SIGQUIT") as caught:
        stopped.loop.run()
    assert caught.value.exit_code == 131
    assert not getattr(caught.value, "__notes__", [])  # torque off was read back
    stopped.require_off(asked_ns)
    assert [(f.source, f.name) for f in stopped.loop.outcome.faults] == [("operator", "SIGQUIT")]


def test_a_software_stop_while_it_sits_down_for_a_signal_does_not_wait(times):
    first_ns = times["armed"] + 1_800_000_000
    second_ns = first_ns + 200_300_000
    stopped = Stopped((first_ns, signal.SIGTERM), (second_ns, signal.SIGQUIT))
    with pytest.raises(OperatorStop):
        stopped.loop.run()
    stopped.require_off(second_ns)
    before = [what for time_ns, _, what in stopped.deeds() if time_ns < second_ns]
    assert set(before) == {"torque on"}


def test_signals_while_torque_goes_off_do_not_interrupt_it(times):
    asked_ns = times["armed"] + 1_700_000_000
    hammering = [(asked_ns + 100_000 * k, signal.SIGQUIT) for k in range(30)]
    stopped = Stopped(*hammering)
    with pytest.raises(OperatorStop):
        stopped.loop.run()
    stopped.require_off(asked_ns)
