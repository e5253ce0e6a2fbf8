"""``python -m tests.fuzz``: see `tests.fuzz.command`, which worker processes can import; they pass over a ``__main__``."""

import sys

from comparisons.scene import to_toml
from tests.fuzz.command import main
from tests.fuzz.special import DRAW

if len(sys.argv) == 3:
    print(to_toml(DRAW[sys.argv[1]](int(sys.argv[2]))), end="")
else:
    sys.exit(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
