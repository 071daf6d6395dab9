"""Arrays as PNG images: colours from dark to light, transparent where there is nothing."""

from __future__ import annotations

import base64
import struct
import zlib

import numpy as np
from numpy.typing import NDArray

__all__ = ["COLOURS", "colours", "data_address", "png"]

COLOURS = np.array([
    [68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
    [92, 200, 99], [170, 220, 50], [253, 231, 37],
])  # fmt: skip
"""Viridis (Smith and van der Walt, 2015) at nine equal steps."""


def colours(values: NDArray[np.float64]) -> NDArray[np.uint8]:
    """(..., 3): of each value between 0 and 1."""
    place = np.clip(values, 0.0, 1.0) * (len(COLOURS) - 1)
    low = np.minimum(place.astype(int), len(COLOURS) - 2)
    part = (place - low)[..., None]
    mixed = np.rint(COLOURS[low] * (1 - part) + COLOURS[low + 1] * part)
    return np.asarray(mixed, dtype=np.uint8)


def png(values: NDArray[np.float64], enlarge: int = 1) -> bytes:
    """The image of `values` (rows, columns) between 0 and 1, each `enlarge` pixels wide and high; zero is
    transparent (PNG specification, W3C 2003)."""
    shown = (255 * (values > 0)[..., None]).astype(np.uint8)
    pixels = np.concatenate([colours(values), shown], axis=-1)
    pixels = pixels.repeat(enlarge, axis=0).repeat(enlarge, axis=1)
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    high, wide = pixels.shape[:2]
    head = struct.pack(">IIBBBBB", wide, high, 8, 6, 0, 0, 0)
    parts = ((b"IHDR", head), (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in parts)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def data_address(image: bytes) -> str:
    """The image as an address that holds it."""
    return f"data:image/png;base64,{base64.b64encode(image).decode()}"
