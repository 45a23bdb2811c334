"""Bipeds as somebody else would write them: other names, orders, signs and zero poses."""

from dataclasses import dataclass

ROLES = {
    "yaw": "0 0 {s}",
    "roll": "{s} 0 0",
    "pitch": "0 {s} 0",
}


@dataclass
class Foreign:
    """A small biped of 2.9 kg whose every habit can be chosen."""

    hip_order: tuple[str, ...] = ("yaw", "roll", "pitch")
    names: str = "{side}_{joint}"
    sides: tuple[str, str] = ("l", "r")
    sign: int = -1
    """Of the left leg's roll, yaw and ankle pitch axes; the other axes are positive."""
    knee_bend: float = 0.0
    """Angle that the knee has in the zero pose [rad]."""
    hip_gap: float = 0.0
    """By which the hip axes pass each other [m]."""
    facing: str = ""
    """Attributes of a body around everything that turn it."""
    waist: bool = True
    ankle_roll: bool = True
    ankle_pitch: bool = True
    foot: str = '<geom type="box" size=".06 .035 .01" pos=".012 0 -.03" mass=".1"/>'
    extra_legs: int = 0
    after: str = ""
    free: str = "<freejoint/>"
    limits: str = 'range="-2.6 2.6"'
    motors: bool = True

    def text(self) -> str:
        legs = self._leg(0, 0.04) + self._leg(1, -0.04)
        for number in range(self.extra_legs):
            legs += self._leg(0, 0.04, f"x{number}_", -0.2)
        pelvis = f'<geom type="box" size=".03 .06 .03" mass=".4"/>{legs}'
        if self.waist:
            pelvis = (
                '<body name="pelvis" pos="0 0 -.1"><joint name="waist" axis="0 0 1"/>'
                f"{pelvis}</body>"
            )
        return (
            '<mujoco model="foreign"><compiler angle="radian" autolimits="true"/>'
            '<default><joint armature=".02" frictionloss=".05"/></default><worldbody>'
            f'<body name="chest" pos="0 0 .5" {self.facing}>{self.free}'
            '<geom type="box" size=".04 .06 .06" pos="0 0 .04" mass="1.1"/>'
            f"{pelvis}</body></worldbody>{self._actuators()}{self.after}</mujoco>"
        )

    def _actuators(self) -> str:
        if not self.motors:
            return ""
        joint = self.names.format(side=self.sides[0], joint="knee")
        return f'<actuator><motor joint="{joint}" ctrlrange="-3 3" gear="2"/></actuator>'

    def _joint(self, side: str, joint: str, kind: str, sign: int, position: str = "0 0 0") -> str:
        axis = ROLES[kind].format(s=sign)
        name = self.names.format(side=side, joint=joint)
        return f'<joint name="{name}" axis="{axis}" pos="{position}" {self.limits}/>'

    def _leg(self, index: int, y: float, prefix: str = "", x: float = 0.0) -> str:
        side = prefix + self.sides[index]
        sign = self.sign if index == 0 else 1
        text, ends = "", ""
        for place, kind in enumerate(self.hip_order):
            at = f"{x} {y} 0" if place == 0 else f"0 0 {self.hip_gap}"
            own = sign if kind != "pitch" else 1
            text += (
                f'<body pos="{at}">{self._joint(side, f"hip_{kind}", kind, own)}'
                f'<geom type="sphere" size=".02" pos=".01 0 .02" mass=".09"/>'
            )
            ends += "</body>"
        bend = f'euler="0 {self.knee_bend} 0"'
        unbend = f'euler="0 {-self.knee_bend} 0"'
        text += (
            '<geom type="capsule" size=".015" fromto="0 0 0 0 0 -.1" mass=".11"/>'
            f'<body pos="0 0 -.12" {bend}>{self._joint(side, "knee", "pitch", 1)}'
            '<geom type="capsule" size=".015" fromto="0 0 0 0 0 -.1" mass=".1"/>'
        )
        ends += "</body>"
        if self.ankle_pitch:
            text += (
                f'<body pos="0 0 -.11" {unbend}>{self._joint(side, "ank_p", "pitch", sign)}'
                '<geom type="sphere" size=".02" mass=".08"/>'
            )
            ends += "</body>"
        if self.ankle_roll:
            text += f"<body>{self._joint(side, 'ank_r', 'roll', 1)}"
            ends += "</body>"
        return text + self.foot + ends
