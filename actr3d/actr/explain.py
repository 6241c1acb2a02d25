from typing import Any
class Explanation: pass
def explain(system: Any, at: float | None) -> Explanation: raise NotImplementedError
