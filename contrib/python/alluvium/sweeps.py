"""Run a scene for all combinations of some parameters."""

from __future__ import annotations

import concurrent.futures
import hashlib
import itertools
import json
import os
import shutil
import subprocess
from typing import Any, Mapping, NamedTuple, Optional, Sequence, Union

from .run import Run

Value = Union[str, float, int, bool]


class Point(NamedTuple):
    """One of a sweep: what was set, and the run; None if it failed, with what it said in `message`."""

    settings: dict[str, Value]
    run: Optional[Run]
    message: str = ""


def _text(value: Value) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return value if isinstance(value, str) else repr(value)


def program() -> str:
    """What ALLUVIUM names, or `alluvium` on the PATH."""
    found = os.environ.get("ALLUVIUM") or shutil.which("alluvium")
    if not found:
        raise FileNotFoundError("there is no program 'alluvium' on the PATH; name it with the environment variable ALLUVIUM.")
    return found


def command(scene: str, settings: Mapping[str, Value], folder: str, ranks: int = 1, alluvium: Optional[str] = None) -> list[str]:
    """What runs a scene with settings ('Section/Name': value) into a folder, in silence."""
    words = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    words += [alluvium or program(), scene]
    all_settings: dict[str, Value] = {**settings, "Output/Output folder": folder, "Output/Overwrite output folder": True, "Output/Progress": "silent"}
    for name, value in all_settings.items():
        words += ["--set", "%s=%s" % (name, _text(value))]
    return words


def environment() -> dict[str, str]:
    """One thread a rank, unless somebody wants otherwise."""
    return {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", **os.environ}


def execute(scene: str, settings: Mapping[str, Value], folder: str, ranks: int = 1, alluvium: Optional[str] = None) -> Point:
    """Run a scene with settings ('Section/Name': value) into a folder, unless it holds a finished run of just that."""
    with open(scene, "rb") as file:
        recipe = json.dumps([hashlib.sha256(file.read()).hexdigest(), sorted((name, _text(value)) for name, value in settings.items())])
    recipe_file = folder + ".recipe"
    if os.path.exists(recipe_file):
        with open(recipe_file) as file:
            is_known = file.read() == recipe
        if is_known and Run(folder).has_finished:
            return Point(dict(settings), Run(folder))
        os.remove(recipe_file)

    result = subprocess.run(command(scene, settings, folder, ranks, alluvium), stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                            text=True, env=environment())
    if result.returncode != 0:
        return Point(dict(settings), None, result.stderr.strip())
    with open(recipe_file, "w") as file:
        file.write(recipe)
    return Point(dict(settings), Run(folder))


def sweep(scene: str, values: Mapping[str, Sequence[Any]], folder: str, settings: Optional[Mapping[str, Value]] = None,
          at_once: int = 1, ranks: int = 1, alluvium: Optional[str] = None) -> list[Point]:
    """Run `scene` for all combinations of `values` ('Section/Name': [value, ...]), `at_once` at a time, in folders below `folder`.

    `settings` are the same for all. The last of the names varies fastest. What an earlier call has finished with the same scene (included
    files aside) and settings is read, not run.
    """
    os.makedirs(folder, exist_ok=True)
    points = [dict(zip(values, combination)) for combination in itertools.product(*values.values())]
    digits = len(str(len(points) - 1))

    def one(i: int) -> Point:
        point = execute(scene, {**(settings or {}), **points[i]}, os.path.join(folder, "run-%0*d" % (digits, i)), ranks, alluvium)
        return Point(points[i], point.run, point.message)

    with concurrent.futures.ThreadPoolExecutor(max(1, at_once)) as pool:
        return list(pool.map(one, range(len(points))))
