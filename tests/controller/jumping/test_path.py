import numpy as np
import pytest

from controller.jumping.path import JumpTarget, estimate_path
from hil.errors import InputError


def test_a_jump_on_the_spot_has_the_numbers_of_the_text_book():
    """0.4 s in the air: 1.962 m/s up, 0.1962 m high; pushed over 0.3 m with m·(g + v²/(2s))."""
    path = estimate_path(JumpTarget((0, 0, 0), 0.4, 0.3), 70.0, start=(0, 0, 0.7))
    assert path.take_off_velocity == pytest.approx((0, 0, 1.962))
    assert path.apex - path.take_off == pytest.approx((0, 0, 0.1962))
    assert path.force == pytest.approx((0, 0, 70.0 * (9.81 + 1.962**2 / 0.6)))
    assert path.take_off == pytest.approx((0, 0, 1.0))
    assert path.velocity(path.duration) == pytest.approx((0, 0, -1.962))


def integrated(path, step=1e-5):
    """The path again, from its force alone: m·ẍ = F + m·g⃗ while it pushes, m·ẍ = m·g⃗ after."""
    weight = path.mass * path.gravity * np.array((0, 0, 1.0))
    place, velocity = path.start.copy(), path.initial_velocity.copy()
    for tick in range(round(path.duration / step)):
        push = path.force if tick * step < path.push_time else 0.0
        velocity = velocity + (push - weight) / path.mass * step
        place = place + velocity * step
    return place, velocity


@pytest.mark.parametrize("displacement", [(0.4, 0.1, 0.12), (-0.1, -0.2, -0.15)])
def test_the_force_pushed_and_let_go_arrives_at_the_target_from_a_walk(displacement):
    target = JumpTarget(displacement, 0.5, 0.25)
    walk = (0.5, 0.05, 0.02)
    path = estimate_path(target, 60.0, start=(1.0, 2.0, 0.6), initial_velocity=walk)
    place, velocity = integrated(path)
    assert place == pytest.approx(path.take_off + displacement, abs=1e-3)
    assert velocity == pytest.approx(path.velocity(path.duration), abs=1e-3)
    assert path.take_off[2] - path.start[2] == pytest.approx(0.25)


def test_position_and_velocity_agree_at_many_times():
    path = estimate_path(
        JumpTarget((0.3, 0.1, 0.1), 0.4, 0.2), 50.0, posture_shift=(-0.1, 0, -0.05)
    )
    times = np.linspace(0.0, path.duration, 2001)
    places = path.position(times)
    slopes = np.gradient(places, times, axis=0)[5:-5]
    smooth = np.abs(times[5:-5] - path.push_time) > 0.001
    assert slopes[smooth] == pytest.approx(path.velocity(times)[5:-5][smooth], abs=2e-3)
    assert places[-1] - path.take_off == pytest.approx((0.2, 0.1, 0.05))
    assert path.apex[2] == pytest.approx(places[:, 2].max(), abs=1e-5)


def test_a_walk_forward_needs_less_forward_push():
    target = JumpTarget((0.4, 0, 0), 0.4, 0.3)
    still = estimate_path(target, 70.0)
    walking = estimate_path(target, 70.0, initial_velocity=(0.5, 0, 0))
    assert walking.force[0] == pytest.approx(0.5 * still.force[0])
    assert walking.force[2] == pytest.approx(still.force[2])


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"airtime": 0.15}, "--airtime: 0.15 m up"),
        ({"airtime": -1.0}, "--airtime"),
        ({"push_depth": 0.0}, "--push-depth"),
        ({"gravity": 0.0}, "--gravity"),
        ({"airtime": float("nan")}, "finite"),
    ],
)
def test_what_is_no_jump_is_refused_by_name(changes, what):
    values = {"displacement": (0.3, 0, 0.15), "airtime": 0.4, "push_depth": 0.2, "gravity": 9.81}
    with pytest.raises(InputError, match=what):
        JumpTarget(**(values | changes))


def test_a_push_that_would_not_rise_is_refused():
    with pytest.raises(InputError, match="would not rise"):
        estimate_path(JumpTarget((0, 0, 0), 0.2, 0.2), 60.0, initial_velocity=(0, 0, -1.5))
