"""`python3 -m ostraka stubs FOLDER` writes the type stubs to the folder."""

import pathlib
import sys

from ._stubs import write_stubs

if len(sys.argv) != 3 or sys.argv[1] != "stubs":
    sys.exit("usage: python3 -m ostraka stubs FOLDER")
write_stubs(pathlib.Path(sys.argv[2]))
