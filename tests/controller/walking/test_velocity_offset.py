"""The offset of the learned velocity curve."""

import pytest

from controller.walking.velocity_offset import VelocityOffset, VelocityOffsetConfig

CONFIG = VelocityOffsetConfig(gain=(0.28, 0.15), memory=0.1, limit=0.1)


def test_offset_by_hand():
    offset = VelocityOffset(CONFIG)
    offset.end_step(mean=(0.4, -0.1), wanted=(0.5, 0.0))
    assert offset.value == pytest.approx((0.028, 0.015))
    offset.end_step(mean=(0.5, 0.1), wanted=(0.5, 0.0))
    assert offset.value == pytest.approx((0.0028, 0.0015 - 0.015))


def test_offset_is_limited():
    offset = VelocityOffset(CONFIG)
    offset.end_step(mean=(-1.0, 1.0), wanted=(1.0, -1.0))
    assert offset.value == (0.1, -0.1)
