import pytest

from hil.errors import InputError
from hil.request import RunRequest
from hil.robot_files import load_robot


def test_what_is_not_said_comes_from_the_robot():
    request = RunRequest().resolved(load_robot("minibiped"))
    assert (request.backend, request.bus, request.rate_hz) == ("bus", "virtual", 300)
    assert (request.estimator, request.ankle_limit, request.stabilizer) == ("sensors", True, False)
    assert request.lockstep


def test_what_is_said_stays():
    request = RunRequest.checked(backend="mujoco", rate_hz=225, ankle_limit=False)
    resolved = request.resolved(load_robot("minibiped"))
    assert (resolved.backend, resolved.bus, resolved.rate_hz) == ("mujoco", None, 225)
    assert resolved.ankle_limit is False


def test_live_alone_is_the_real_bus_and_has_deadlines():
    request = RunRequest.checked(live=True).resolved(load_robot("minibiped"))
    assert (request.backend, request.bus, request.lockstep) == ("bus", "real", False)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"rate_hz": 0}, "--rate"),
        ({"rate_hz": 5000}, "--rate"),
        ({"duration_s": 0}, "--duration"),
        ({"duration_s": float("nan")}, "--duration"),
        ({"duration_s": float("inf")}, "--duration"),
        ({"seed": -1}, "--seed"),
        ({"backend": "gazebo"}, "--backend"),
        ({"bus": "real"}, "--live"),
        ({"live": True, "bus": "virtual"}, "--live .* --bus virtual"),
        ({"live": True, "backend": "mujoco"}, "--live .* --backend mujoco"),
        ({"backend": "mujoco", "bus": "virtual"}, "--bus"),
        ({"bus": "real", "live": True, "estimator": "truth"}, "--estimator"),
        ({"live": True, "schedules": {"water": ((0.0, 0.1),)}}, "--water needs a simulated"),
        ({"schedules": {"water": ((0.0, -0.1),)}}, "--water: Input should be greater"),
        ({"schedules": {"density": ((0.0, 1100.0),)}}, "how high, --water H"),
        ({"priority": 50}, "--priority"),
        ({"schedules": {"step_width": -0.1}}, "--step-width"),
    ],
)
def test_requests_that_make_no_sense_name_the_option(values, says):
    with pytest.raises(InputError, match=says):
        RunRequest.checked(**values)


@pytest.mark.parametrize(
    ("robot", "values", "says"),
    [
        ("human", {"backend": "bus"}, "no servo bus"),
        ("minibiped", {"pd": "implicit"}, "has servos"),
        ("minibiped", {"backend": "mujoco", "realtime": True}, "--realtime"),
    ],
)
def test_requests_that_a_robot_cannot_meet_are_refused(robot, values, says):
    with pytest.raises(InputError, match=says):
        RunRequest.checked(**values).resolved(load_robot(robot))
