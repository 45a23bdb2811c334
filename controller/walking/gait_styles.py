"""The trajectories of the present step, mixed from gait styles when the step begins."""

import numpy as np

from controller.walking.combiner import PATH, Combiner, KnotList, StyleConfig
from controller.walking.key_poses import CurveTable, tabulated
from controller.walking.torque_config import TorqueWalkingConfig
from hil.interface import Floats


class GaitStyles:
    """Key poses, and the swing foot's way before the take-over, for a speed and a liquid.

    A trajectory that a style leaves out is the standard controller's. Without styles the standard
    controller's own tables stand, and nothing is mixed.
    """

    def __init__(self, config: TorqueWalkingConfig) -> None:
        self._end = config.gait.max_phase
        standard = dict(config.key_poses)
        self.standard = self.curves = CurveTable(config.key_poses.curves(), self._end)
        """Key poses in the order of `KeyPoses`: of the standard controller, and of this step."""
        self.path: CurveTable | None = None
        """Parts of the swing foot's way: ahead, aside and how much of it a style gives."""
        self._parts: dict[int, float] = {}
        self._combiner: Combiner | None = None
        styles = config.chosen_styles
        if styles:
            self._combiner = Combiner(styles, config.style_law)
            self._poses = [self._pose_table(standard, style) for style in styles]
            self._paths = [self._path_table(style) for style in styles]
            self._has_path = any(table.any() for table in self._paths)

    def choose(self, speed: float, level: float, resistance: float = 1.0) -> None:
        """Mix for a step at a sagittal speed [m/s] in a liquid of a level [m].

        `resistance` is its drag over that of water.
        """
        if self._combiner is None:
            return
        parts = self._combiner.parts(speed, level, resistance)
        if parts == self._parts:
            return
        self._parts = parts
        self.curves = CurveTable.of(_mixed(self._poses, parts), self._end)
        if self._has_path:
            self.path = CurveTable.of(_mixed(self._paths, parts), self._end)

    def _pose_table(self, standard: dict[str, KnotList], style: StyleConfig) -> Floats:
        return tabulated([style.poses.get(name, standard[name]) for name in standard], self._end)

    def _path_table(self, style: StyleConfig) -> Floats:
        """Zero where the style says nothing: the foot then stays where it left the floor."""
        given = [style.poses.get(name) for name in PATH]
        knots = [((0.0, 0.0),) if one is None else one for one in given]
        said = 0.0 if given == [None, None] else 1.0
        return tabulated([*knots, ((0.0, said),)], self._end)


def _mixed(tables: list[Floats], parts: dict[int, float]) -> Floats:
    total = np.zeros_like(tables[0])
    for index, part in parts.items():
        total += part * tables[index]
    return total
