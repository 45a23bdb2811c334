"""A value kept within a limit on either side."""


def clip(value: float, limit: float) -> float:
    """The value within ±limit."""
    return max(-limit, min(value, limit))
