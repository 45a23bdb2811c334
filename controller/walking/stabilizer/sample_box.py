"""The box of extra torques that is searched: ankle pitch, ankle roll and knee of the stance leg.

Seed 000_bd1305a0ae731442, section 3.1.1; widths and centres of its stored code as fractions of
m·g·L, so that they fit any robot. Torques act on the child: pitch positive toe down, roll
positive right edge down, knee positive in flexion.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from controller.walking.stabilizer.config import StabilizerConfig
from controller.walking.stabilizer.distribution import Distribution

Sample = tuple[float, float, float]
"""Extra torques of ankle pitch, ankle roll and knee [N·m]."""
NO_TORQUE: Sample = (0.0, 0.0, 0.0)
UNLOADED = 1e-3
"""Share below which a side counts as unloaded."""
CODED_PITCH = (0.0154, 0.0154)
"""Centre and least half width of the stored code's pitch after foot-flat, 10 N·m at human size."""
CODED_PITCH_REAR = (-0.077, 0.0462)
"""The same when the rear carries nothing: −50 ± 30 N·m."""
CODED_KNEE = (0.0539, 0.077)
"""Centre of the stored code's knee before and after foot-flat."""


@dataclass(frozen=True, slots=True)
class SampleBox:
    """Axis-aligned box: centre ± half width [N·m], cut to what the joints may still take."""

    low: Sample
    high: Sample

    @property
    def centre(self) -> Sample:
        """Middle of the box [N·m]."""
        a, b = self.low, self.high
        return (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]))

    def at(self, unit: Sequence[float]) -> Sample:
        """Sample of normalised coordinates, the box being [−1, 1]³; what is outside is clamped."""
        values = []
        for low, high, part in zip(self.low, self.high, unit, strict=True):
            share = 0.5 * (min(max(part, -1.0), 1.0) + 1.0)
            values.append(low + share * (high - low))
        return (values[0], values[1], values[2])

    def clamped(self, sample: Sequence[float]) -> Sample:
        """The nearest sample in the box."""
        a, b = self.low, self.high
        return (
            min(max(sample[0], a[0]), b[0]),
            min(max(sample[1], a[1]), b[1]),
            min(max(sample[2], a[2]), b[2]),
        )


def sample_box(
    config: StabilizerConfig,
    scale: float,
    initial: Distribution,
    flat: bool,
    room: tuple[Sample, Sample],
) -> SampleBox:
    """The box for a foot with the distribution `initial`; `scale` is m·g·L [N·m].

    `room` is the least and largest extra torque that the joints' limits leave [N·m].
    """
    late = int(flat)
    centres = [0.0, 0.0, 0.0]
    halves = [config.pitch[late], config.roll[late], config.knee[late]]
    if config.centre == "coded":
        centres[0], halves[0] = CODED_PITCH
        if flat and initial.rear < UNLOADED:
            centres[0], halves[0] = CODED_PITCH_REAR
        towards_right = (initial.right < UNLOADED) - (initial.left < UNLOADED)
        centres[1] = 0.5 * halves[1] * towards_right
        centres[2] = CODED_KNEE[late]
    low = [scale * (c - h) for c, h in zip(centres, halves, strict=True)]
    high = [scale * (c + h) for c, h in zip(centres, halves, strict=True)]
    a = [min(max(v, r), s) for v, r, s in zip(low, *room, strict=True)]
    b = [min(max(v, r), s) for v, r, s in zip(high, *room, strict=True)]
    return SampleBox((a[0], a[1], a[2]), (b[0], b[1], b[2]))
