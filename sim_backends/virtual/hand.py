"""The hand of a virtual robot's builder: moves limp joints, holds and tilts the torso, loads cells.

A real robot's builder does these things; nothing of it is on the serial lines.
"""

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from hil.errors import InputError, UnknownNameError
from hil.interface import CORNERS, SIDES
from hil.smoothstep import smoothstep
from sim_backends.model import SUPPORT, named
from sim_backends.virtual.robot import VirtualRobot
from sim_backends.virtual.steering import Steering

MOVE_S = 0.4
"""How long every movement takes [s]."""
SETTLE_S = 0.35
"""Until what was moved has come to rest [s]."""
LIFT = 0.3
"""How high the robot is held in the air [m]."""
_STEP_NS = 5_000_000
"""Between two steps of a movement [ns]."""
STIFFNESS, DAMPING = 120.0, 4.0
"""Of fingers that hold a joint [N·m/rad, N·m·s/rad]: a leg's weight bends them by less than 1°."""


class Hand:
    """Holds joints with springs, and the torso with the weld that supports it.

    A robot that is released stands on its feet, and `Steering` leans it. Targets move from where
    they are to where they shall be along s(x) = 3x² − 2x³ in `MOVE_S`.
    A joint stays held, at its place, from the first time that it was moved.
    """

    def __init__(self, robot: VirtualRobot) -> None:
        self._robot, self._plant = robot, robot.world
        model, path = self._plant.model, robot.description.model_path
        kind = mujoco.mjtObj.mjOBJ_JOINT
        self._joints = {name: named(model, kind, name, path)
                        for name in robot.description.joint_names}  # fmt: skip
        self._support = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_EQUALITY, SUPPORT)
        self._held: set[str] = set()
        self._damping: dict[str, float] = {}
        self._tilt = np.zeros(2)
        self._steering = Steering(robot.clock)
        self._ground: float | None = None
        """Height of the root body when it was first touched [m]."""
        self._busy_until_ns = 0

    def do(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """One deed, as `hil.bringup.deed.Deed` writes it; every key is optional.

        Returns how long the hand is still busy, on the robot's clock; an empty deed only asks.
        Raises InputError for what the robot does not have.
        """
        joints = {str(k): float(v) for k, v in dict(request.get("joints", {})).items()}
        free = [str(name) for name in request.get("free", ())]
        for name in (*joints, *free):
            if name not in self._joints:
                raise UnknownNameError("joint", name, self._joints)
        if request.get("load") is not None:
            self._load(request["load"])
        tilt, lifted = request.get("tilt"), request.get("lifted")
        if request.get("released"):
            self._release()
        if tilt is not None or lifted is not None:
            self._move_torso(tilt, lifted)
        for name in free:
            self._held.discard(name)
            self._spring(name, 0.0, 0.0)
        self._hold_joints(joints)
        if request.keys() - {"do"}:
            self._busy_until_ns = self._robot.clock.now_ns() + round((MOVE_S + SETTLE_S) * 1e9)
        busy_ns = max(0, self._busy_until_ns - self._robot.clock.now_ns())
        return {"seconds": 1e-9 * busy_ns}

    def _hold_joints(self, goals: Mapping[str, float]) -> None:
        model, data = self._plant.model, self._plant.data
        begin = {}
        for name in goals:
            joint = self._joints[name]
            address = model.jnt_qposadr[joint]
            begin[name] = float(data.qpos[address])
            if name in self._held:
                begin[name] = float(model.qpos_spring[address])
            self._held.add(name)
            model.qpos_spring[address] = begin[name]
            self._spring(name, STIFFNESS, DAMPING)

        def place(share: float) -> None:
            for name, goal in goals.items():
                address = model.jnt_qposadr[self._joints[name]]
                model.qpos_spring[address] = begin[name] + share * (goal - begin[name])

        if goals:
            self._move(place)

    def _spring(self, name: str, stiffness: float, damping: float) -> None:
        model, joint = self._plant.model, self._joints[name]
        model.jnt_stiffness[joint] = stiffness
        model.dof_damping[model.jnt_dofadr[joint]] += damping - self._damping.get(name, 0.0)
        self._damping[name] = damping

    def _release(self) -> None:
        if self._plant.data.eq_active[self._support]:
            self._plant.set_support(False)
            self._tilt = np.zeros(2)
            self._steering.begin()

    def _move_torso(self, tilt: Any, lifted: bool | None) -> None:
        begin = self._tilt.copy()
        goal = begin if tilt is None else np.array(tilt, dtype=float)
        if goal.shape != (2,) or not np.isfinite(goal).all():
            raise InputError(f"tilt: needs roll and pitch [rad], got {tilt!r}")
        if lifted is not None and not self._plant.data.eq_active[self._support]:
            self._steering.end()
            self._plant.set_support(True)
        pose = self._plant.model.eq_data[self._support]
        if self._ground is None:
            self._ground = float(pose[5])
        z = float(pose[5])
        goal_z = z if lifted is None else self._ground + (LIFT if lifted else 0.0)

        def place(share: float) -> None:
            self._tilt = begin + share * (goal - begin)
            self._steering.goal = self._tilt
            pose[5] = z + share * (goal_z - z)
            pose[6:10] = _tilted(*self._tilt)

        self._move(place)

    def _move(self, place: Any) -> None:
        """Call `place` with rising shares of a way until it is 1."""
        clock = self._robot.clock
        begin_ns = clock.now_ns()

        def step() -> None:
            x = min(1.0, (clock.now_ns() - begin_ns) / (MOVE_S * 1e9))
            place(smoothstep(x))
            if x < 1.0:
                clock.schedule(clock.now_ns() + _STEP_NS, step)

        step()

    def _load(self, load: Mapping[str, float]) -> None:
        forces = {side: [0.0] * len(CORNERS) for side in SIDES}
        for cell, force in load.items():
            side, _, corner = str(cell).partition(":")
            if side not in SIDES or corner not in CORNERS:
                valid = [f"{one}:{other}" for one in SIDES for other in CORNERS]
                raise UnknownNameError("cell", str(cell), valid)
            forces[side][CORNERS.index(corner)] = float(force)
        for side, values in forces.items():
            self._robot.cells[side].pressed = values


def _tilted(roll: float, pitch: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Quaternion of a torso leant about the horizontal axis that roll and pitch span together."""
    angle = float(np.hypot(roll, pitch))
    if angle == 0.0:
        return np.array([1.0, 0.0, 0.0, 0.0])
    x, y = np.sin(0.5 * angle) * np.array([roll, pitch]) / angle
    return np.array([np.cos(0.5 * angle), x, y, 0.0])
