"""Test of contrib/vtu.py on every encoding of a .vtu, and of contrib/plot on a small output folder made here."""

import base64
import json
import os
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

contrib = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "contrib")
sys.path.insert(0, contrib)
sys.dont_write_bytecode = True
import vtu

TYPES = {"f8": "Float64", "f4": "Float32", "i4": "Int32", "u1": "UInt8"}
EMPTY = ('<Piece NumberOfPoints="0" NumberOfCells="0"><Cells><DataArray type="UInt8" Name="types"></DataArray></Cells>'
         '<PointData></PointData></Piece>')


def encoded(data, mode):
    """Bytes of an array as one of the modes has them; blocks of 64 bytes if compressed."""
    raw = data.tobytes()
    if "zlib" not in mode:
        content = struct.pack("<I", len(raw)) + raw
        return content if mode == "raw" else base64.b64encode(content)
    blocks = [zlib.compress(raw[i:i + 64]) for i in range(0, len(raw), 64)]
    header = struct.pack("<%dI" % (3 + len(blocks)), len(blocks), 64, len(raw) % 64, *map(len, blocks))
    content = b"".join(blocks)
    return header + content if mode == "raw zlib" else base64.b64encode(header) + base64.b64encode(content)


def write_vtu(name, points, cells, kind, fields, mode="base64 zlib", appended=False, n_pieces=1):
    store = []

    def entry(label, data):
        n = data.shape[1] if data.ndim > 1 else 1
        start = '<DataArray type="%s" Name="%s" NumberOfComponents="%d" ' % (TYPES[data.dtype.str[1:]], label, n)
        if mode == "ascii":
            return start + 'format="ascii">%s</DataArray>' % " ".join(map(repr, data.ravel().tolist()))
        if not appended:
            return start + 'format="binary">%s</DataArray>' % encoded(data, mode).decode()
        offset = sum(map(len, store))
        store.append(encoded(data, mode))
        return start + 'format="appended" offset="%d"/>' % offset

    piece = '<Piece NumberOfPoints="%d" NumberOfCells="%d"><Points>' % (len(points), len(cells))
    piece += entry("points", points) + "</Points><Cells>"
    piece += entry("connectivity", np.concatenate(cells).astype("<i4"))
    piece += entry("offsets", np.cumsum([len(cell) for cell in cells]).astype("<i4"))
    piece += entry("types", np.full(len(cells), kind, "u1")) + "</Cells><PointData>"
    piece += "".join(entry(label, data) for label, data in fields.items()) + "</PointData></Piece>"
    with open(name, "wb") as file:
        file.write(b'<?xml version="1.0"?><VTKFile type="UnstructuredGrid" byte_order="LittleEndian"')
        file.write(b' compressor="vtkZLibDataCompressor">' if "zlib" in mode else b">")
        file.write(b"<UnstructuredGrid>" + EMPTY.encode() + n_pieces * piece.encode() + b"</UnstructuredGrid>")
        if appended:
            file.write(b'<AppendedData encoding="%s">_' % (b"raw" if "raw" in mode else b"base64"))
            file.write(b"".join(store) + b"</AppendedData>")
        file.write(b"</VTKFile>")


def test_encodings(folder):
    random = np.random.default_rng(1)
    points, field = random.random((20, 3)), random.random((20, 3)).astype("<f4")
    cells = [np.array([i, i + 1, i + 2]) for i in range(10)] + [np.array([3, 4, 5, 6])]
    for mode in ("ascii", "base64", "base64 zlib", "raw", "raw zlib"):
        for appended in (False, True):
            if (mode == "ascii" and appended) or ("raw" in mode and not appended):
                continue
            for n_pieces in (1, 2):
                name = os.path.join(folder, "a.vtu")
                write_vtu(name, points, cells, 7, {"field": field}, mode, appended, n_pieces)
                grid = vtu.read_vtu(name)
                assert np.array_equal(grid.points, np.concatenate(n_pieces * [points])), mode
                assert np.array_equal(grid.fields["field"], np.concatenate(n_pieces * [field])), mode
                assert len(grid.cells) == n_pieces * len(cells)
                assert np.array_equal(grid.cells[-1], cells[-1] + 20 * (n_pieces - 1)), mode


def write_pvd(name, times):
    with open(name, "w") as file:
        entries = "".join('<DataSet timestep="%g" file="%s"/>' % entry for entry in times)
        file.write('<VTKFile type="Collection"><Collection>%s</Collection></VTKFile>' % entries)


def test_pictures(folder):
    x, y = [a.ravel() for a in np.meshgrid(np.linspace(0.001, 0.019, 10), np.linspace(0.001, 0.019, 10))]
    times, frames = [], []
    for step in range(4):
        moved = np.stack([0 * x, 0.1 * step * y, 0 * x], axis=1)
        points = np.stack([x, y, 0 * x], axis=1) + moved
        fields = {"id": np.arange(100.0), "radius": np.full(100, 1e-3), "displacement": moved}
        write_vtu(os.path.join(folder, "grains-%d.vtu" % step), points, np.arange(100).reshape(-1, 1), 1, fields)
        corners = 0.02 * np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0.0]])
        write_vtu(os.path.join(folder, "fluid-%d.vtu" % step), corners, [np.array([0, 1, 2, 3])], 9, {})
        times.append((0.1 * step, "grains-%d.vtu" % step))
        frames.append((0.1 * step, "fluid-%d.vtu" % step))
    write_pvd(os.path.join(folder, "grains.pvd"), times)
    write_pvd(os.path.join(folder, "fluid.pvd"), frames)
    with open(os.path.join(folder, "statistics.csv"), "w") as file:
        file.write("time_s,differential_head_m,moved_mass_fraction\n0,0,0\n0.1,,0\n0.2,0.2,0.5\n0.3,0.25,1\n0.4,0.")
    with open(os.path.join(folder, "summary.json"), "w") as file:
        json.dump({"first movement": {"time_s": 0.15, "differential_head_m": None}, "total heave": {"happened": False}}, file)

    subprocess.run([os.path.join(contrib, "plot"), folder], check=True)
    for picture in ("motion-and-head.png", "bed.png", "mesh.png"):
        assert os.path.getsize(os.path.join(folder, picture)) > 1000, picture


with tempfile.TemporaryDirectory() as temporary:
    test_encodings(temporary)
    test_pictures(temporary)
