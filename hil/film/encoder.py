"""Pictures into a film file: H.264, whole or not at all."""

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Self

from hil.errors import InputError
from hil.film.offscreen import Pixels

if TYPE_CHECKING:
    from av.container import OutputContainer

SUFFIXES = (".mp4", ".mkv", ".mov")
QUALITY: dict[str, object] = {"crf": "20", "preset": "veryfast"}


class Encoder:
    """Writes frames of one size; a context manager.

    The file appears under its name when it is finished: what is broken off leaves nothing.
    """

    def __init__(self, path: Path, width: int, height: int, fps: float) -> None:
        """Raises InputError without the package `av`, or if the file cannot be written."""
        if path.suffix not in SUFFIXES:
            raise InputError(f"--out {path}: ends in none of {', '.join(SUFFIXES)}")
        try:
            import av
        except ImportError as error:
            raise InputError(
                "the package av is missing: pip install 'stridebridge[video]'"
            ) from error
        self._path, self._part = path, path.with_name(f".{path.stem}.part{path.suffix}")
        self._frame_of = av.VideoFrame.from_ndarray
        try:
            self._container: OutputContainer = av.open(str(self._part), "w")
        except OSError as error:
            raise InputError(f"--out {path}: cannot be written: {error.strerror}") from error
        stream = self._container.add_stream("libx264", rate=Fraction(fps).limit_denominator(1000))
        stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
        stream.options = QUALITY
        self._stream = stream

    def add(self, pixels: Pixels) -> None:
        """The next picture, (height, width, 3)."""
        frame = self._frame_of(pixels, format="rgb24")
        self._container.mux(self._stream.encode(frame))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, *exc_info: object) -> None:
        if kind is None:
            self._container.mux(self._stream.encode(None))
        self._container.close()
        if kind is None:
            self._part.replace(self._path)
        else:
            self._part.unlink(missing_ok=True)
