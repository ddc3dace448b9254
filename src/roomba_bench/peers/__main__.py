"""``python -m roomba_bench.peers MODULE``: be that peer until the input ends."""

from __future__ import annotations

import os
import sys

from roomba_bench.peers.protocol import serve

# Libraries may print when they are imported; that must not mix with the answers.
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
serve(sys.argv[1], sys.stdin, answers)
