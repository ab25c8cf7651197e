"""Runs of Grainpipe as NumPy arrays.

All numbers are in SI units.  The columns are those of the topics of a run
(docs/reference/files.md).  A run that was not finished, or was stopped, can be
read as far as it goes: see `Run.is_complete` and `Run.stopped`.
"""

from ._call import RunError, run
from ._run import Run, Surface
from ._messages import IncompleteError

__all__ = ["IncompleteError", "Run", "RunError", "Surface", "run"]
__version__ = "0.1.0"
