"""A ball of 5 kg at 5.4 m/s on the human's trunk: how soon the walk is its old self again."""

import numpy as np
import pytest

from hil.request import RunRequest
from hil.schedule import Ball, Schedules
from hil.studies.walks import step_starts, walk

THROWN_S = 6.0


def speed_errors(velocity):
    """Speed error over two steps in a row [m/s], from the one of the impact on."""
    ball = Ball(mass=5.0, velocity=velocity, start=THROWN_S)
    request = RunRequest(robot="human", duration_s=13.0, schedules=Schedules(balls=(ball,)))
    walked = walk(request)
    assert walked.stopped_s is None
    times, _ = step_starts(walked.trace)
    places = walked.trace.com[np.searchsorted(walked.trace.time_s, times), :2]
    means = (places[2:] - places[:-2]) / (times[2:] - times[:-2])[:, None]
    errors = np.abs(means - [0.5, 0.0]).max(axis=1)
    return errors[np.searchsorted(times[2:], THROWN_S) :]


@pytest.mark.parametrize("velocity", [(5.4, 0, 0), (-5.4, 0, 0), (0, 5.4, 0)])
def test_a_thrown_ball_is_forgotten_within_some_steps(velocity):
    errors = speed_errors(velocity)
    assert errors.max() > 0.1, "the ball missed"
    assert errors[6:].max() < 0.1
