"""The step of a simulated body that may stand in a liquid, or on dry land."""

import mujoco

from hil.description import RobotDescription
from hil.robot_facts import robot_facts
from sim_backends.water.drag_torque import DragTorque
from sim_backends.water.hydrodynamics import Hydrodynamics

CELLS_A_LEG = 47
"""Surface elements along a leg: 2 cm on the seed's character, whose legs are 0.94 m long."""


class Immersion:
    """Steps a model: with the forces of the liquid where there is one, plainly where not.

    With a liquid the step is MuJoCo's in two halves, so that the forces belong to the state from
    which the step begins. On dry land it is `mj_step`, and nothing is computed.
    """

    def __init__(
        self,
        description: RobotDescription,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        root: int,
    ) -> None:
        self._description, self._root = description, root
        self._model, self._data = model, data
        self.water: Hydrodynamics | None = None
        """The liquid; none on dry land."""
        self._hydrodynamics: Hydrodynamics | None = None
        self._drag_torque: DragTorque | None = None

    def set_medium(self, level: float, density: float, viscosity: float) -> None:
        """A liquid up to a level above the floor [m], its density [kg/m³] and viscosity factor.

        Level 0 is dry land. The first call, whatever its level, cuts the robot into elements,
        which takes many ticks: give it before anything moves. Raises InputError for a robot with
        other shapes than boxes, capsules and spheres.
        """
        if self._hydrodynamics is None:
            description = self._description
            leg = robot_facts(description).leg_length
            cell = description.plant.water_cell or leg / CELLS_A_LEG
            self._hydrodynamics = Hydrodynamics(self._model, self._data, self._root, cell)
        self._hydrodynamics.set_medium(level, density, viscosity)
        self.water = self._hydrodynamics if level > 0.0 else None

    def drag_torque(self) -> float:
        """Torques of the last step's drag about the joints of the limbs, summed [N·m]."""
        if self.water is None:
            return 0.0
        if self._drag_torque is None:
            self._drag_torque = DragTorque(self._model, self._data, self._root, self.water)
        return self._drag_torque.total()

    def step(self) -> None:
        """One step of the physics."""
        if self.water is None:
            mujoco.mj_step(self._model, self._data)
            return
        mujoco.mj_step1(self._model, self._data)
        self.water.act()
        mujoco.mj_step2(self._model, self._data)
        self.water.withdraw()
