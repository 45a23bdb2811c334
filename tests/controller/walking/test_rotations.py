"""Rotation vectors against MuJoCo's quaternion functions."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.walking.rotations import (
    about_axis,
    about_x,
    about_y,
    about_z,
    heading_of,
    rotation_vectors,
    small_rotation_vector,
)

component = st.floats(-1.7, 1.7)


def matrix_of(vector):
    quaternion, matrix = np.empty(4), np.empty(9)
    angle = float(np.linalg.norm(vector))
    axis = vector / angle if angle > 0 else np.array([1.0, 0.0, 0.0])
    mujoco.mju_axisAngle2Quat(quaternion, axis, angle)
    mujoco.mju_quat2Mat(matrix, quaternion)
    return matrix.reshape(3, 3)


@given(component, component, component)
def test_logarithm_undoes_the_exponential(x, y, z):
    vector = np.array([x, y, z])
    batch = np.stack([matrix_of(vector), matrix_of(-0.5 * vector)])
    assert rotation_vectors(batch) == pytest.approx(np.stack([vector, -0.5 * vector]), abs=1e-6)


def test_no_rotation_is_zero():
    assert rotation_vectors(np.eye(3)[None]) == pytest.approx(np.zeros((1, 3)))


@pytest.mark.parametrize(("about", "axis"), [(about_x, 0), (about_y, 1), (about_z, 2)])
def test_single_axes(about, axis):
    expected = np.zeros(3)
    expected[axis] = 0.3
    assert about(0.3) == pytest.approx(matrix_of(expected))


@given(component, component, component)
def test_a_slanted_axis(x, y, z):
    vector = np.array([x, y, z])
    angle = float(np.linalg.norm(vector))
    axis = vector / angle if angle > 0 else np.array([0.0, 0.0, 1.0])
    assert np.array(about_axis(axis.tolist(), angle)) == pytest.approx(matrix_of(vector), abs=1e-9)


def test_small_rotation_and_heading():
    vector = np.array([0.01, -0.02, 0.015])
    assert small_rotation_vector(matrix_of(vector)) == pytest.approx(vector, abs=1e-5)
    assert heading_of(about_z(2.1) @ about_y(0.4)) == pytest.approx(2.1)
