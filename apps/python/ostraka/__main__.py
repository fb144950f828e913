"""`python3 -m ostraka stubs FOLDER` writes the type stubs to the folder; by default to the folder of this file."""

import pathlib
import sys

from ._stubs import write_stubs

if len(sys.argv) not in (2, 3) or sys.argv[1] != "stubs":
    sys.exit("usage: python3 -m ostraka stubs [FOLDER]")
write_stubs(pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else pathlib.Path(__file__).resolve().parent)
