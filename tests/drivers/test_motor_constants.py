"""Motor constants of joints whose servo nobody has filled in yet."""

import numpy as np
import pytest
import yaml

from drivers.dynamixel.servo_models import servo_model_of
from drivers.motor_constants import motor_parameters
from hil.compose.sessions import ideal_calibration
from hil.errors import DescriptionError, InputError
from hil.robot_files import find_robot_file, load_robot


@pytest.fixture
def nameless(tmp_path):
    """minibiped whose left knee has no servo, and the limits of an XM430-W350."""
    data = yaml.safe_load(find_robot_file("minibiped").read_text())
    data["joints"][3].update(servo=None, velocity_limit=4.817108735504349)
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(data))
    return load_robot(str(file))


def test_its_motor_stalls_and_idles_at_the_limits_of_the_joint(nameless):
    found = motor_parameters(nameless, ideal_calibration(nameless, {}))
    known = motor_parameters(load_robot("minibiped"), ideal_calibration(nameless, {}))
    for key in ("torque_constant", "resistance", "gain_divisor"):
        np.testing.assert_allclose(getattr(found, key)[3], getattr(known, key)[3], rtol=1e-6)
    np.testing.assert_allclose(found.size, 1.0)
    assert known.size is None
    assert np.isnan(found.current_unit[3])


def test_twice_the_power_is_twice_the_size(nameless):
    knee = nameless.joints[3].model_copy(update={"torque_limit": 8.2})
    strong = nameless.model_copy(
        update={"joints": (*nameless.joints[:3], knee, *nameless.joints[4:])}
    )
    sizes = motor_parameters(strong, ideal_calibration(strong, {})).size
    assert sizes[3] == pytest.approx(2.0) and sizes[2] == 1.0


def test_no_bus_knows_it(nameless):
    with pytest.raises(InputError, match="left_knee: servo is missing"):
        servo_model_of(nameless.joints[3])
    with pytest.raises(DescriptionError, match=r"joints\.left_knee: servo not filled in"):
        nameless.require_servos()
    load_robot("minibiped").require_servos()
