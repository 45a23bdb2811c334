"""A smooth way from 0 to 1."""


def smoothstep(share: float) -> float:
    """s²·(3 − 2s) of a share s from 0 to 1: at rest at both ends of the way."""
    return share * share * (3.0 - 2.0 * share)
