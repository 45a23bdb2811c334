import pytest

from hil.smoothstep import smoothstep


def test_it_leaves_and_arrives_at_rest_and_is_halfway_in_the_middle():
    assert [smoothstep(share) for share in (0.0, 0.5, 1.0)] == [0.0, 0.5, 1.0]
    assert smoothstep(1e-6) / 1e-6 == pytest.approx(0.0, abs=1e-5)
    assert (1.0 - smoothstep(1.0 - 1e-6)) / 1e-6 == pytest.approx(0.0, abs=1e-5)
