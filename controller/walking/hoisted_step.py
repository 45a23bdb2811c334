"""One step of a servo robot that hangs: on schedule, with a body that is imagined."""

from controller.robot_model import RobotModel
from controller.walking.imagined_pendulum import ImaginedPendulum
from controller.walking.servo_config import ServoWalkingConfig
from controller.walking.servo_step import ServoStep
from hil.interface import Estimate


class HoistedStep(ServoStep):
    """The gait of the ground, with the motion that the body would have there.

    In the air a stance leg that is free to follow the body would follow nothing. So the body moves
    as the steady walk's pendulum (`ImaginedPendulum`), and the stance foot is where that puts
    it. Timing and placement are those of the ground, and find the steady walk that they want.
    """

    def __init__(
        self, config: ServoWalkingConfig, model: RobotModel, rate_hz: int, ankle_limit: bool
    ) -> None:
        super().__init__(config, model, rate_hz, ankle_limit)
        lead = config.latency + self._dt / 2
        self.state: ImaginedPendulum = ImaginedPendulum(model, config.gait.period, lead)

    def base_velocity(self, estimate: Estimate) -> tuple[float, float, float]:
        """The imagined one, world axes [m/s]."""
        del estimate  # A robot that hangs goes nowhere.
        return (*self.frame.to_world(self.state.velocity), 0.0)

    def _observe(self) -> None:
        """Put the stance ankle where the imagined body has it."""
        gait, state = self.gait, self.state
        sway = -gait.stance_sign * self._width
        state.imagine(gait.phase, self._speed, sway, self._config.balance.ahead)
        away_x, away_y = self.frame.to_world(state.seen)
        x, y, _ = self._model.com.tolist()
        self.ankle = [x - away_x, y - away_y, float(self._model.ankles[gait.stance][2])]

    def _watch_fall(self, swing_load: float) -> None:
        """In the air nothing falls, and nothing can be learnt from it."""
