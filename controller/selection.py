"""Selections of an array: a slice where the indices are consecutive, so that nothing is copied."""

from hil.interface import Ints


def selection(indices: Ints) -> slice | Ints:
    """What selects the same entries as `indices`, shape (n,): a slice if they are consecutive."""
    first = int(indices[0]) if len(indices) else 0
    if indices.tolist() == list(range(first, first + len(indices))):
        return slice(first, first + len(indices))
    return indices
