"""Pictures of a MuJoCo scene without a window, by EGL or OSMesa."""

import ctypes.util
import os
from collections.abc import Sequence
from contextlib import ExitStack
from importlib import import_module
from typing import Any, Self

import mujoco
import numpy as np

from hil.errors import InputError
from hil.film.camera import Shot

Pixels = np.ndarray[Any, np.dtype[np.uint8]]
LIBRARIES = {"egl": "EGL", "osmesa": "OSMesa"}
"""Ways of drawing without a display, in the order of preference, and the library of each."""
MAX_GEOMS = 5000
HELP = "install one (apt-get install libegl1 libgl1-mesa-dri, or libosmesa6), or name it, MUJOCO_GL"


def gl_platform() -> str:
    """`egl` or `osmesa`: what MUJOCO_GL says, else the first that is installed.

    Raises InputError where there is none, or MUJOCO_GL names a way that needs a display.
    """
    wanted = os.environ.get("MUJOCO_GL", "").lower().strip()
    if wanted and wanted not in LIBRARIES:
        raise InputError(f"MUJOCO_GL={wanted} does not draw off screen; valid: egl, osmesa")
    for name in [wanted] if wanted else list(LIBRARIES):
        if ctypes.util.find_library(LIBRARIES[name]) is not None:
            return name
    raise InputError(f"no OpenGL that draws off screen ({wanted or 'EGL or OSMesa'}): {HELP}")


class Offscreen:
    """A framebuffer of a size [pixels] in which one model is drawn; a context manager."""

    def __init__(self, model: Any, width: int, height: int) -> None:
        """Raises InputError if the graphics library does not work here."""
        self._size = (width, height)
        model.vis.global_.offwidth, model.vis.global_.offheight = width, height
        platform = gl_platform()
        with ExitStack() as stack:
            try:
                self._gl = import_module(f"mujoco.{platform}").GLContext(width, height)
                stack.callback(self._gl.free)
                self._gl.make_current()
                self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
                stack.callback(self._context.free)
            except (ImportError, AttributeError, RuntimeError, mujoco.FatalError) as error:
                text = " ".join(str(error).split())
                raise InputError(f"{platform} does not draw off screen ({text}): {HELP}") from error
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
            self._closing = stack.pop_all()
        self._scene = mujoco.MjvScene(model, maxgeom=MAX_GEOMS)
        self._option, self._viewport = mujoco.MjvOption(), mujoco.MjrRect(0, 0, width, height)
        self._pixels: Pixels = np.empty((height, width, 3), dtype=np.uint8)

    def draw(self, model: Any, data: Any, shot: Shot, geoms: Sequence[Any], text: str) -> Pixels:
        """A picture, (height, width, 3); the array is filled again by the next call.

        `geoms`: decorative ones, drawn beside the model's; `text` stands in the upper left corner.
        """
        scene, everything = self._scene, mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(
            model, data, self._option, mujoco.MjvPerturb(), shot.camera(), everything.value, scene
        )
        for geom in geoms[: scene.maxgeom - scene.ngeom]:
            _copy(geom, scene.geoms[scene.ngeom])
            scene.ngeom += 1
        mujoco.mjr_render(self._viewport, scene, self._context)
        mujoco.mjr_overlay(
            mujoco.mjtFont.mjFONT_NORMAL.value, mujoco.mjtGridPos.mjGRID_TOPLEFT.value,
            self._viewport, text, "", self._context,
        )  # fmt: skip
        mujoco.mjr_readPixels(self._pixels, None, self._viewport, self._context)
        return self._pixels[::-1]  # OpenGL's first line is the lowest

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc_info: object) -> None:
        self._closing.close()


def _copy(source: Any, target: Any) -> None:
    """One decorative MjvGeom into a place of the scene."""
    size, place, axes = source.size, source.pos, source.mat.flatten()
    mujoco.mjv_initGeom(target, source.type, size, place, axes, source.rgba)
    target.size[:] = size  # the call above reads sizes as a model's geom has them
