"""A Foxglove layout for a robot's recordings: which numbers are drawn where, by joint names.

Foxglove reads `session.mcap` without it (schemas `ros2msg`, messages `cdr`); the layout saves the
picking. Its format is the one that Foxglove's "Import from file" takes: panels by id, and a tree of
splits and tabs. A path is `/topic.field[index]`.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from hil.figure_style import BODY, LEFT, RIGHT, WARNING
from hil.interface import CORNERS, SIDES
from hil.joint_gains import kinds

Series = Mapping[str, Any]
COLOURS = (LEFT, RIGHT, "#e9b872", "#7fb2cf", BODY, "#8a9a5b", "#a05195", "#5fa8a0")
STEPS = ("safety.severity", "safety.walking", "status.stance", "status.foot_flat")
PARTS = ("cycle_ns", "read_ns", "estimate_ns", "control_ns", "write_ns", "late_ns")


def foxglove_layout(joints: Sequence[str], *, truth: bool) -> dict[str, Any]:
    """The layout for a robot of these joints, in the order of the recording's arrays."""
    panels = {
        **_walk(truth),
        **_each_kind(joints, "Position", (("/applied.position", "goal"),
                                          ("/frame.joint_position", ""))),
        **_each_kind(joints, "Torque", (("/frame.joint_torque", ""),)),
        "Plot!temperature": _plot("Heat [°C]", _by_joint("/frame.joint_temperature", joints)),
        "Plot!voltage": _plot("Supply [V]", _by_joint("/frame.joint_voltage", joints)),
        "Plot!timing": _plot(
            "Parts of a tick [ns]", [_series(f"/timing.{part}", part) for part in PARTS]
        ),
    }  # fmt: skip
    tabs = {
        "Walk": ["StateTransitions!steps", "Plot!speed", "Plot!left", "Plot!right"],
        "Joints": [name for name in panels if name.startswith("Plot!Position")],
        "Torque": [name for name in panels if name.startswith("Plot!Torque")],
        "Servos": ["Plot!temperature", "Plot!voltage"],
        "Timing": ["Plot!timing"],
    }
    pages = [{"title": title, "layout": _column(names)} for title, names in tabs.items()]
    return {
        "configById": {**panels, "Tab!run": {"activeTabIdx": 0, "tabs": pages}},
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": "Tab!run",
    }


def _walk(truth: bool) -> dict[str, Any]:
    """Speed, state and corner forces."""
    speed = [
        _series("/estimate.com_velocity[0]", "estimated, x", BODY),
        _series("/estimate.com_velocity[1]", "estimated, y", "#8a9a5b"),
        _series("/reference.speed", "asked for, ahead", WARNING),
    ]
    if truth:
        speed.append(_series("/truth.com_velocity[0]", "true, x", RIGHT))
    panels = {
        "StateTransitions!steps": {
            "paths": [_series(f"/{path}", path) for path in STEPS],
            "isSynced": True,
        },
        "Plot!speed": _plot("Centre of mass [m/s]", speed),
    }
    for foot, side in enumerate(SIDES):
        corners = [
            _series(f"/frame.foot_force[{4 * foot + place}]", corner.replace("_", " "), colour)
            for place, (corner, colour) in enumerate(zip(CORNERS, COLOURS, strict=False))
        ]
        panels[f"Plot!{side}"] = _plot(f"{side.capitalize()} foot, corner forces [N]", corners)
    return panels


def _each_kind(
    joints: Sequence[str], what: str, fields: Sequence[tuple[str, str]]
) -> dict[str, Any]:
    """A plot for every kind of joint, the sides together."""
    panels = {}
    for kind, places in kinds(joints).items():
        series = [
            _series(f"{field}[{place}]", f"{joints[place]} {suffix}".replace("_", " ").strip())
            for place in places
            for field, suffix in fields
        ]
        panels[f"Plot!{what}-{kind}"] = _plot(f"{what}: {kind.replace('_', ' ')}", series)
    return panels


def _by_joint(field: str, joints: Sequence[str]) -> list[Series]:
    return [
        _series(f"{field}[{place}]", joint.replace("_", " ")) for place, joint in enumerate(joints)
    ]


def _series(path: str, label: str, colour: str | None = None) -> dict[str, Any]:
    series: dict[str, Any] = {
        "value": path, "label": label, "enabled": True, "timestampMethod": "receiveTime",
    }  # fmt: skip
    return series if colour is None else {**series, "color": colour}


def _plot(title: str, series: Sequence[Series]) -> dict[str, Any]:
    coloured = [{"color": COLOURS[place % len(COLOURS)], **one} for place, one in enumerate(series)]
    return {
        "title": title,
        "foxglovePanelTitle": title,
        "paths": coloured,
        "showXAxisLabels": True,
        "showYAxisLabels": True,
        "showLegend": True,
        "legendDisplay": "floating",
        "showPlotValuesInLegend": True,
        "isSynced": True,
        "xAxisVal": "timestamp",
    }


def _column(names: Sequence[str]) -> Any:
    """Panels of one height, one below the other."""
    if len(names) == 1:
        return names[0]
    share = 100.0 / len(names)
    return {
        "first": names[0],
        "second": _column(names[1:]),
        "direction": "column",
        "splitPercentage": share,
    }
