"""Scales of a structure by hand: a frame of two joined beams, and a beam by itself."""

import numpy as np

from tsm.sizes import joined_extents, sizes_of


def test_sizes_of_a_frame_and_of_a_beam_beside_it() -> None:
    """The frame is as large as its diagonal, 5, and the beam as its own length, though it ends where it begins."""
    nodes = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [9.0, 9.0], [9.0, 9.5]])
    lengths = np.array([4.0, 3.0, 2.0])
    extents = joined_extents(np.array([[0, 1], [1, 2], [3, 4]]), np.array([0, 1, 3]), nodes, lengths)
    assert extents.tolist() == [5.0, 5.0, 2.0]
    found = sizes_of(lengths, extents, np.array([160.0, 45.0, 4.0]))
    assert found == (4.0, 5.0, 10.0, 6.4)
