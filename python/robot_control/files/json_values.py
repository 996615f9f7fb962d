"""Values that JSON can hold."""

import math
from collections.abc import Iterable
from typing import Any


def finite(value: Any, digits: int | None = None) -> Any:  # noqa: ANN401 (any value of JSON)
    """The same with null for numbers that are not finite; `digits`: decimals of the others, None: all."""
    if isinstance(value, float):
        return (value if digits is None else round(value, digits)) if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(item, digits) for key, item in value.items()}
    if isinstance(value, str) or not isinstance(value, Iterable):
        return value
    return [finite(each, digits) for each in value]
