"""Reports of experiments: one page with figures, tables and statistics, beside human data.

`analysis` adds sections to the reports of experiments of one kind.
"""

from actr3d.experiment.report.analyses import analysis
from actr3d.experiment.report.parts import Caution, Part, Plot, Section, Table

__all__ = ["Caution", "Part", "Plot", "Section", "Table", "analysis"]
