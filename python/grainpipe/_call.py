"""Calls of dem-run."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from typing import Any, Mapping, Sequence

from ._messages import Name
from ._run import Run


class RunError(RuntimeError):
    """dem-run refused the scene, or failed."""

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text.strip() or f"dem-run ended with exit code {code}")
        self.code = code  #: exit code


_STOPPED = 3  # of dem-run: a guard or a signal has stopped the run, and its file is whole


def run(
    scene: Name,
    keys: "Mapping[str, Any] | None" = None,
    *,
    inputs: "Sequence[Name]" = (),
    output: "Name | None" = None,
    options: "Sequence[str]" = (),
    program: str = "dem-run",
) -> Run:
    """Runs a scene and reads the result.

    `keys` are set as with `--set`, such as {"time.until": 0.5, "contact.0.restitution": 0.3}; `inputs` are the
    walls and streams of the command line, `options` further options.  `output` is the scene's name with .mcap
    unless it is given.  A run that a guard stops is returned as far as it went, with `Run.stopped`.

    Raises RunError with the words of dem-run where it refuses the scene or fails, FileNotFoundError without
    the program.
    """
    if shutil.which(program) is None:
        raise FileNotFoundError(f"{program} is not on PATH: `make install` puts it there")
    scene = os.fspath(scene)
    out = os.fspath(output) if output is not None else os.path.splitext(scene)[0] + ".mcap"
    sets = [part for key, value in (keys or {}).items() for part in ("--set", f"{key}={_toml(value)}")]
    call = [program, scene, *map(os.fspath, inputs), "-o", out, *sets, *options]
    done = subprocess.run(call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode not in (0, _STOPPED):
        raise RunError(done.returncode, done.stderr)
    return Run(out)


def _toml(value: "Any") -> str:
    """A value as --set takes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(one)}" for key, one in value.items()) + " }"
    if hasattr(value, "tolist"):  # of NumPy
        return _toml(value.tolist())
    if isinstance(value, Sequence):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return repr(value)
