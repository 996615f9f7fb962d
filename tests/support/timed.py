"""The bound on the processor time that one input from outside may take."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from typing import Any

LONGEST = 0.1
"""s of the thread's processor time"""
longest = [0.0]
"""s, of the calls so far"""


def timed(function: Callable[..., Any], *given: Any) -> Any:
    """The result or the exception of the call, which fails where it takes LONGEST. Without collections of garbage: they
    take 0.06 s and more, by what other tests hold, and would fall on any call.
    """
    enabled = gc.isenabled()
    gc.disable()
    began = time.thread_time()
    try:
        return function(*given)
    finally:
        took = time.thread_time() - began
        if enabled:
            gc.enable()
        longest[0] = max(longest[0], took)
        assert took < LONGEST, f"{took:.3f} s for {str(given)[:300]}"
