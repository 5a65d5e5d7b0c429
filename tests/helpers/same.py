"""What is the same in two files of one result, whatever the time that it took."""

from __future__ import annotations

import io

import h5py


def bits(result: bytes) -> bytes:
    """All that a result.h5 holds, but for when it was run and the times that the computer took."""
    found: list[bytes] = []

    def add(name: str, item: h5py.Dataset | h5py.Group) -> None:
        if isinstance(item, h5py.Dataset) and name not in ("took", "ran_at"):
            found.extend((name.encode(), str(item.dtype).encode(), item[()].tobytes()))

    with h5py.File(io.BytesIO(result), "r") as file:
        file.visititems(add)
        found.extend(f"{key}: {value}".encode() for key, value in sorted(file.attrs.items()))
    return b"\n".join(found)
