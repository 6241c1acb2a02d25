"""Rendered pictures of a camera at the eye: depth and colour, drawn off screen with EGL."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from actr3d.errors import WorldError
from actr3d.world.body import Body, sensor
from actr3d.world.command_registry import checked_whole
from actr3d.world.physics import Physics

MAX_PIXELS = 4096
"""Greatest number of rows or columns of a picture."""


@dataclass(frozen=True, kw_only=True)
class Picture:
    """Pixels in rows from the top, each row from the left."""

    kind: Literal["image", "depth"]
    """`image`: red, green, blue, one byte each. `depth`: the distance along the line of sight [m], four-byte floats."""
    width: int
    """Pixels in a row."""
    height: int
    """Rows."""
    pixels: bytes
    """All of them."""

    def as_array(self) -> NDArray[Any]:
        """Returns the pixels: (height, width, 3) of 0 to 255, or (height, width) [m]. Read-only."""
        if self.kind == "image":
            return np.frombuffer(self.pixels, dtype=np.uint8).reshape(self.height, self.width, 3)
        return np.frombuffer(self.pixels, dtype=np.float32).reshape(self.height, self.width)

    def with_noise(self, sd: Any, random: np.random.Generator) -> Picture:
        """Returns the same picture with noise on every pixel; `sd` is in the unit of the pixels: steps of 255, or [m] for depth.

        Raises:
            WorldError: If `sd` is not one number.
        """
        if isinstance(sd, Mapping):
            raise WorldError(f"noise of {self.kind}: a picture has no fields; give one number")
        noisy = self.as_array() + float(sd) * random.standard_normal(self.as_array().shape)
        noisy = np.clip(np.rint(noisy), 0, 255).astype(np.uint8) if self.kind == "image" else noisy.astype(np.float32)
        return Picture(kind=self.kind, width=self.width, height=self.height, pixels=noisy.tobytes())


_if_eye = sensor.if_body(lambda body: body.eye is not None)


@_if_eye
def image(body: Body, width: int = 320, height: int = 240) -> Picture:
    """Senses a colour picture from the eye, of a size in pixels.

    Raises:
        WorldError: If a size is not a whole number of pixels in 1 to 4096, or EGL cannot be used.
    """
    return _picture(body, "image", width, height)


@_if_eye
def depth(body: Body, width: int = 320, height: int = 240) -> Picture:
    """Senses a depth picture: distances along the line of sight [m], of a size in pixels.

    Raises:
        WorldError: If a size is not a whole number of pixels in 1 to 4096, or EGL cannot be used.
    """
    return _picture(body, "depth", width, height)


def _picture(body: Body, kind: Literal["image", "depth"], width: int, height: int) -> Picture:
    width, height = (checked_whole(n, f"{kind}: {what}", 1, MAX_PIXELS) for n, what in ((width, "width"), (height, "height")))
    body.physics.refresh()
    if body.physics.renderer is None:
        body.physics.renderer = _Renderer(body.physics)
    pixels = body.physics.renderer.draw(body.eye, kind, width, height)
    return Picture(kind=kind, width=width, height=height, pixels=pixels.tobytes())


class _Renderer:
    """A frame buffer in which MuJoCo draws.

    Args:
        physics: The compiled scene and its state.

    Raises:
        WorldError: If EGL is not installed or has no device.
    """

    def __init__(self, physics: Physics) -> None:
        self._physics = physics
        try:
            egl: Any = importlib.import_module("mujoco.egl")
            self._gl_error: Any = importlib.import_module("OpenGL.error").Error
        except (ImportError, AttributeError, OSError) as error:
            raise WorldError(f"pictures need EGL, which is not installed here or cannot be used: {error}") from error
        try:
            self._context = egl.GLContext(MAX_PIXELS, MAX_PIXELS)
            self._context.make_current()
        except (self._gl_error, ImportError, RuntimeError, AttributeError, OSError) as error:
            raise WorldError(f"pictures need EGL, which has no device here that could draw: {error}") from error
        self._scene = mujoco.MjvScene(model=physics.mj_model, maxgeom=physics.mj_model.ngeom + 1000)
        self._option = mujoco.MjvOption()
        self._resources: Any = None
        self._size = (0, 0)

    def draw(self, camera: str | None, kind: str, width: int, height: int) -> NDArray[Any]:
        """Returns a picture from a camera: (height, width, 3) bytes, or (height, width) depths [m]."""
        model, data = self._physics.mj_model, self._physics.mj_data
        try:
            self._context.make_current()
        except self._gl_error as error:
            raise WorldError("a world draws its pictures in one thread, that of the first picture") from error
        if self._size != (width, height):
            if self._resources is not None:
                self._resources.free()
            drawing = model.vis.global_
            before = drawing.offwidth, drawing.offheight
            drawing.offwidth, drawing.offheight = width, height
            self._resources = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
            drawing.offwidth, drawing.offheight = before  # the state of a world is compared with the model at the start
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._resources)
            self._resources.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
            self._size = (width, height)
        mujoco.mj_camlight(model, data)
        view = mujoco.MjvCamera()
        view.type, view.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, model.camera(camera).id
        mujoco.mjv_updateScene(model, data, self._option, None, view, mujoco.mjtCatBit.mjCAT_ALL.value, self._scene)
        frame = mujoco.MjrRect(0, 0, width, height)
        mujoco.mjr_render(frame, self._scene, self._resources)
        if kind == "image":
            colours = np.empty((height, width, 3), dtype=np.uint8)
            mujoco.mjr_readPixels(colours, None, frame, self._resources)
            return np.flipud(colours)
        buffer = np.empty((height, width), dtype=np.float32)
        mujoco.mjr_readPixels(None, buffer, frame, self._resources)
        return np.flipud(self._metres(buffer.astype(np.float64))).astype(np.float32)

    def _metres(self, buffer: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns distances along the line of sight [m] from a reversed depth buffer, 1 at the near plane and 0 at the far one."""
        model: Any = self._physics.mj_model
        near, far = (plane * model.stat.extent for plane in (model.vis.map.znear, model.vis.map.zfar))
        return near * far / (near + buffer * (far - near))
