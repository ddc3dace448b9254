"""How paths of peers are measured, and the graph of open cells."""

from __future__ import annotations

import numpy as np
import pytest

from roomba_bench.peers.paths.grids import links, path_facts


def test_path_facts_count_length_and_corners_cut() -> None:
    fits = np.array([[True, False], [True, True]])
    cut = path_facts(fits, np.array([[0, 0], [1, 1]]))
    assert cut == {"length": pytest.approx(2**0.5), "corners cut": 1.0}
    around = path_facts(fits, np.array([[0, 0], [1, 0], [1, 1]]))
    assert around == {"length": 2.0, "corners cut": 0.0}
    with pytest.raises(ValueError, match="closed cells"):
        path_facts(fits, np.array([[0, 0], [0, 1]]))


def test_links_cut_no_corners() -> None:
    first, second, cost = links(np.array([[True, False], [True, True]]))
    assert sorted(zip(first, second, cost, strict=True)) == [(0, 2, 1.0), (2, 3, 1.0)]
