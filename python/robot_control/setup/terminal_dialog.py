"""Questions on a terminal that a signal can interrupt; input() would go on waiting after Ctrl-C was only noted."""

import os
import select
import sys
from collections.abc import Callable
from typing import TypeVar

Answer = TypeVar("Answer")
POLL_PERIOD = 0.1
"""s between two looks at signals"""


class NoAnswerError(RuntimeError):
    """There is no answer: the input has ended, or a signal came."""


class Questions:
    """Asks on stdout, reads lines of stdin."""

    def __init__(self, going_on: Callable[[], bool], descriptor: int | None = None) -> None:
        self._going_on = going_on
        self._descriptor = sys.stdin.fileno() if descriptor is None else descriptor
        self._buffer = b""

    def line(self, question: str) -> str:
        """One line, as it was typed.

        Raises:
            NoAnswerError: none comes.
        """
        print(question, end=" ", flush=True)
        while b"\n" not in self._buffer:
            if not self._going_on():
                raise NoAnswerError("interrupted")
            if not select.select([self._descriptor], [], [], POLL_PERIOD)[0]:
                continue
            more = os.read(self._descriptor, 4096)
            if not more:
                raise NoAnswerError(f"no answer to {question!r}: there is no terminal, and no option answers it")
            self._buffer += more
        text, _, self._buffer = self._buffer.partition(b"\n")
        return text.decode(errors="replace").strip()

    def yes(self, question: str) -> bool:
        """Asks until y or n was typed."""
        while True:
            word = self.line(f"{question} [y/n]").lower()
            if word in ("y", "yes"):
                return True
            if word in ("n", "no"):
                return False
            print("  y or n, please")

    def value(self, question: str, read: Callable[[str], Answer], objection: Callable[[Answer], str]) -> Answer:
        """Asks until `read` accepts an answer (else ValueError) that has no `objection`, or that was typed twice."""
        refused: Answer | None = None
        while True:
            try:
                answer = read(self.line(question))
            except ValueError as error:
                print(f"  not taken: {error}")
                continue
            why = objection(answer)
            if not why or answer == refused:
                return answer
            print(f"  {why}\n  Type it again if it is right.")
            refused = answer
