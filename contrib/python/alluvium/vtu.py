"""Read the .vtu, .pvtu and .pvd files that deal.II writes, with numpy alone.

    times = read_pvd("output/grains.pvd")       # [(time, [file, ...]), ...]
    grains = read_vtu(times[-1][1])             # grains.points, grains.cells, grains.fields["radius"]
"""

from __future__ import annotations

import base64
import os
import re
import sys
import xml.etree.ElementTree as xml
import zlib
from typing import Optional, Sequence, Union

import numpy as np

TYPES = {
    "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4",
    "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8",
}


class Grid:
    """points (n, 3), cells (list of arrays of point numbers, or one (n, k) array), fields by name at the points."""

    def __init__(self, points: np.ndarray, cells: Sequence[np.ndarray], fields: dict[str, np.ndarray]) -> None:
        self.points, self.cells, self.fields = points, cells, fields


def _attribute(entry: xml.Element, name: str) -> str:
    value = entry.get(name)
    if value is None:
        raise ValueError("<%s> has no attribute '%s': is the file whole?" % (entry.tag, name))
    return value


def _child(entry: xml.Element, name: str) -> xml.Element:
    found = entry.find(name)
    if found is None:
        raise ValueError("<%s> has no <%s>: is the file whole?" % (entry.tag, name))
    return found


def read_pvd(name: str) -> list[tuple[float, list[str]]]:
    """The times of a .pvd in order, each with its files."""
    folder = os.path.dirname(name)
    files: dict[float, list[str]] = {}
    for entry in xml.parse(name).iter("DataSet"):
        files.setdefault(float(_attribute(entry, "timestep")), []).append(os.path.join(folder, _attribute(entry, "file")))
    return sorted(files.items())


def read_vtu(names: Union[str, Sequence[str]]) -> Grid:
    """Read one .vtu or .pvtu, or several, into one Grid."""
    if isinstance(names, str):
        names = [names]
    pieces = [piece for name in names for piece in read_pieces(name)]
    if not pieces:
        return Grid(np.zeros((0, 3)), [], {})
    offset = 0
    cells: list[np.ndarray] = []
    for piece in pieces:
        cells.extend(cell + offset for cell in piece.cells)
        offset += len(piece.points)
    fields = {name: np.concatenate([piece.fields[name] for piece in pieces]) for name in pieces[0].fields}
    return Grid(np.concatenate([piece.points for piece in pieces]), cells, fields)


def read_pieces(name: str) -> list[Grid]:
    """The pieces of one .vtu or .pvtu, one for each rank that has something."""
    with open(name, "rb") as file:
        content = file.read()

    # Raw appended data is no XML: cut it out.
    appended, raw = b"", False
    match = re.search(rb"<AppendedData[^>]*>\s*_", content)
    if match:
        end = content.rindex(b"</AppendedData>")
        appended, raw = content[match.end():end], b'"raw"' in match.group(0)
        content = content[:match.end()] + content[end:]
    root = xml.fromstring(content)

    if root.get("type") == "PUnstructuredGrid":
        folder = os.path.dirname(name)
        return [piece for entry in root.iter("Piece") for piece in read_pieces(os.path.join(folder, _attribute(entry, "Source")))]

    order = "<" if root.get("byte_order", "LittleEndian") == "LittleEndian" else ">"
    header = np.dtype(order + TYPES[root.get("header_type", "UInt32")])
    compressed = root.get("compressor") is not None

    def array(entry: xml.Element) -> np.ndarray:
        kind = np.dtype(order + TYPES[_attribute(entry, "type")])
        form = entry.get("format", "ascii")
        if form == "ascii":
            data = np.array((entry.text or "").split(), dtype=kind)
        elif form == "appended" and raw:
            data = np.frombuffer(_decode_raw(appended[int(_attribute(entry, "offset")):], header, compressed), kind)
        else:
            text = appended[int(_attribute(entry, "offset")):] if form == "appended" else (entry.text or "").encode()
            data = np.frombuffer(_decode_base64(text.strip(), header, compressed), kind)
        n = int(entry.get("NumberOfComponents") or 1)
        return data.reshape(-1, n) if n > 1 else data

    result = []
    for piece in root.iter("Piece"):
        if int(_attribute(piece, "NumberOfPoints")) == 0:  # of a rank that has nothing: its arrays are not there
            continue
        cells = {_attribute(entry, "Name"): array(entry) for entry in _child(piece, "Cells").iter("DataArray")}
        ends = cells["offsets"].astype(int)
        connectivity = cells["connectivity"].astype(int)
        fields = piece.find("PointData")
        result.append(Grid(array(_child(_child(piece, "Points"), "DataArray")).reshape(-1, 3),
                           np.split(connectivity, ends[:-1]) if len(ends) else [],
                           {_attribute(entry, "Name"): array(entry) for entry in fields.iter("DataArray")}
                           if fields is not None else {}))
    return result


def _inflate(sizes: np.ndarray, data: bytes) -> bytes:
    """Compressed blocks, one after the other."""
    result, at = b"", 0
    for size in sizes:
        result += zlib.decompress(data[at:at + int(size)])
        at += int(size)
    return result


def _decode_raw(data: bytes, header: np.dtype, compressed: bool) -> bytes:
    width = header.itemsize
    first = int(np.frombuffer(data[:width], header)[0])
    if not compressed:
        return data[width:width + first]
    sizes = np.frombuffer(data[:width * (3 + first)], header)[3:]
    return _inflate(sizes, data[width * (3 + first):])


def _decode_base64(text: bytes, header: np.dtype, compressed: bool) -> bytes:
    """The header and the data are two base64 texts if compressed, one if not."""
    if not text:
        return b""
    width = header.itemsize

    def length(n_bytes: int) -> int:
        return (n_bytes + 2) // 3 * 4

    first = int(np.frombuffer(base64.b64decode(text[:length(width)])[:width], header)[0])
    if not compressed:
        return base64.b64decode(text[:length(width + first)])[width:width + first]
    at = length(width * (3 + first))
    sizes = np.frombuffer(base64.b64decode(text[:at])[:width * (3 + first)], header)[3:]
    return _inflate(sizes, base64.b64decode(text[at:at + length(int(sizes.sum()))]))


def main(names: Optional[Sequence[str]] = None) -> None:
    for name in sys.argv[1:] if names is None else names:
        grid = read_vtu(name)
        print(name, len(grid.points), "points,", len(grid.cells), "cells")
        for field, values in grid.fields.items():
            print("  %-20s %s  from %g to %g" % (field, values.shape, values.min(), values.max()))


if __name__ == "__main__":
    main()
