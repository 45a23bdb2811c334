"""Everything that one recording says of its robot."""

from dataclasses import dataclass

import numpy as np

from hil.after.load_model import LoadModel
from hil.after.mechanics import Mechanics, mechanics
from hil.after.motor_signs import MotorSigns, motor_signs
from hil.after.recorded import RecordedRun
from hil.after.sole_signs import SoleSigns, sole_signs
from hil.after.supply_signs import SupplySigns, supply_signs
from hil.compose import driver_motors
from hil.errors import InputError


@dataclass(frozen=True, slots=True)
class Signs:
    """One run's."""

    run: RecordedRun
    model: LoadModel
    motors: MotorSigns
    mechanics: Mechanics
    supply: SupplySigns
    soles: SoleSigns


def require_registers(run: RecordedRun) -> None:
    """Raise InputError for a run in which no causes can be looked for."""
    description = run.description
    if description.actuation != "servo":
        raise InputError(f"{run.name}: causes are looked for in servos, and a {description.name} "
                         "has none")  # fmt: skip
    other = [joint.name for joint in description.joints if joint.mode != "position"]
    if other:
        raise InputError(f"{run.name}: joint {other[0]} is not driven in mode position")
    names = run.recording.rows["applied"].dtype.names or ()
    if "goal" not in names or not np.any(run.recording.rows["applied"]["p_gain"]):
        raise InputError(f"{run.name}: recorded before recordings had the servos' registers")


def read_signs(run: RecordedRun) -> Signs:
    """Measure a run. Raises InputError where it cannot be."""
    require_registers(run)
    constants = driver_motors(run.description)
    model = LoadModel(run.description)
    motors = motor_signs(run, constants)
    return Signs(
        run,
        model,
        motors,
        mechanics(run, model, motors),
        supply_signs(run, constants),
        sole_signs(run, model),
    )
