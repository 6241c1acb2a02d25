from collections.abc import Sequence

class Test:
    pvalue: float

def ttest_ind(a: Sequence[float], b: Sequence[float], *, equal_var: bool, alternative: str) -> Test: ...
def ttest_1samp(a: Sequence[float], popmean: float, *, alternative: str) -> Test: ...
