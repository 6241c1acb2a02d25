# Names only what needs a type here; the rest of the package is `Any`.
from typing import Any

def __getattr__(name: str) -> Any: ...
