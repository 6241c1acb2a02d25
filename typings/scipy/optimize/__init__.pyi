from collections.abc import Callable, Sequence
from typing import Any

class Result:
    x: Sequence[float]

def minimize(fun: Callable[[Any], float], x0: Sequence[float], *, bounds: Sequence[tuple[float, float]], method: str) -> Result: ...
