"""Which response model answers in a tick: by stance leg, and for M6 by contact."""

from controller.robot_model import RobotModel
from controller.walking.stabilizer.config import ModelName
from controller.walking.stabilizer.reduced_models import PARTS, build
from controller.walking.stabilizer.response import ResponseModel
from hil.description import RobotDescription

HELD_TICKS = 10
"""M6 keeps both legs for so many ticks after the swing foot's contact (stored code)."""


class ModelChoice:
    """The response models of one name; those without a swing leg exist once for each side."""

    def __init__(
        self, name: ModelName, description: RobotDescription, robot: RobotModel, dt: float
    ) -> None:
        def make(model: ModelName, swing: int) -> ResponseModel:
            return ResponseModel(
                robot, description, build(description, robot, PARTS[model], swing), dt
            )

        self._two_legs: ResponseModel | None = None
        self._by_stance: tuple[ResponseModel, ...] = ()
        if name == "M6" or "swing_leg" not in PARTS[name]:
            self._two_legs = make("M3" if name == "M6" else name, 1)
        if name == "M6" or "swing_leg" in PARTS[name]:
            single: ModelName = "M4" if name == "M6" else name
            self._by_stance = (make(single, 1), make(single, 0))
        self._since_contact = HELD_TICKS

    def choose(self, stance: int, swing_contact: bool) -> ResponseModel:
        """The model of this tick; `swing_contact`: the swing foot is on the ground."""
        self._since_contact = 0 if swing_contact else self._since_contact + 1
        if self._two_legs is not None and (not self._by_stance or self._since_contact < HELD_TICKS):
            return self._two_legs
        return self._by_stance[stance]
