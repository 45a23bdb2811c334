"""URDF as MuJoCo can read it: meshes found or left out, nothing merged away."""

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

MESHES = (".stl", ".obj")
"""Mesh formats that MuJoCo reads."""
STL_HEADER, STL_TRIANGLE = 84, 50
"""Bytes of a binary STL: its header with the number of triangles, and each of them."""


def readable_urdf(path: Path, root: Element, notes: list[str]) -> tuple[str, dict[str, float]]:
    """The text for MuJoCo's URDF reader, and the speed limit of every joint that has one [rad/s].

    `package://` names are looked for in the folders above the file. A mesh that is not there, or
    is of a kind that MuJoCo does not read, is left out and noted; masses are the URDF's own.
    """
    dropped: list[str] = []
    for link in root.iter("link"):
        for kind in ("visual", "collision"):
            for shape in link.findall(kind):
                mesh = shape.find("geometry/mesh")
                if mesh is None:
                    continue
                found = _find_mesh(path, mesh.get("filename", ""))
                if found is None:
                    link.remove(shape)
                    dropped.append(mesh.get("filename", "?"))
                else:
                    mesh.set("filename", str(found))
    if dropped:
        notes.append(
            f"{len(dropped)} meshes left out, not found or neither binary STL nor OBJ (first: "
            f"{dropped[0]})"
        )
    for old in root.findall("mujoco"):
        root.remove(old)
    compiler = ElementTree.SubElement(ElementTree.SubElement(root, "mujoco"), "compiler")
    compiler.attrib.update(
        strippath="false", fusestatic="false", discardvisual="false", balanceinertia="true",
        boundmass="1e-6", boundinertia="1e-9",
    )  # fmt: skip
    speeds = {}
    for joint in root.findall("joint"):
        limit = joint.find("limit")
        speed = float(limit.get("velocity", 0.0)) if limit is not None else 0.0
        if speed > 0.0:
            speeds[joint.get("name", "")] = speed
    return ElementTree.tostring(root, encoding="unicode"), speeds


def _find_mesh(path: Path, name: str) -> Path | None:
    """The file of a mesh: from the URDF's folder, or below any folder above it."""
    if not name.lower().endswith(MESHES):
        return None
    if "://" not in name:
        direct = path.parent / name
        return direct.resolve() if _is_readable(direct) else None
    inside = Path(name.partition("://")[2])
    tails = [Path(*inside.parts[start:]) for start in range(len(inside.parts) - 1)]
    for folder in path.resolve().parents:
        for tail in tails:
            if _is_readable(folder / tail):
                return folder / tail
    return None


def _is_readable(mesh: Path) -> bool:
    """Whether a mesh is there, and no STL in plain text, which MuJoCo does not read."""
    if not mesh.is_file():
        return False
    if mesh.suffix.lower() != ".stl":
        return True
    with mesh.open("rb") as file:
        head = file.read(STL_HEADER)
    if len(head) < STL_HEADER:
        return False
    triangles = int.from_bytes(head[-4:], "little")
    return mesh.stat().st_size == STL_HEADER + STL_TRIANGLE * triangles
