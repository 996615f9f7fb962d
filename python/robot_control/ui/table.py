"""A table of texts."""

from collections.abc import Sequence


def table(rows: Sequence[tuple[str, ...]], left: int | None = None) -> list[str]:
    """A line per row; columns are as wide as their texts need, the first `left` flush left (None: all), others flush
    right.
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if left is None or column < left else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
