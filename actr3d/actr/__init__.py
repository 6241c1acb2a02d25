"""The cognitive architecture: Python ACT-R's models, buffers, productions and modules, under the same names.

The core (`kernel`, `chunks`, `procedural`, `declarative`, `modules`) does not know what stands above it. The checks of models and
the explanations are connected to it here.
"""

from __future__ import annotations

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.compat.display import display
from actr3d.actr.compat.log_files import finished
from actr3d.actr.declarative.activation import DMBaseLevel, DMFixed, DMNoise, MemorySubModule
from actr3d.actr.declarative.association import DMAssociate, DMInhibition
from actr3d.actr.declarative.blending import BlendingMemory
from actr3d.actr.declarative.memory import Memory
from actr3d.actr.declarative.partial_matching import Partial
from actr3d.actr.declarative.spreading import DMSalience, DMSpreading
from actr3d.actr.explain.explain import explain
from actr3d.actr.kernel import model
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.log import log, log_everything
from actr3d.actr.kernel.model import Model
from actr3d.actr.lint.checks import check_agent, check_classes
from actr3d.actr.loading.sweep import run
from actr3d.actr.modules import MODULES
from actr3d.actr.modules.imaginal import ImaginalModule
from actr3d.actr.modules.motor import Motor
from actr3d.actr.modules.port import BodyPort
from actr3d.actr.modules.sos_vision import SOSVision
from actr3d.actr.modules.text import TextOutput
from actr3d.actr.modules.timer import Timer
from actr3d.actr.modules.vision import Vision
from actr3d.actr.procedural import production_system
from actr3d.actr.procedural.actr import ACTR
from actr3d.actr.procedural.compilation import PMCompile
from actr3d.actr.procedural.production_system import ProductionSystem
from actr3d.actr.procedural.utility import PMPGC, PMTD, PMNew, PMNoise, PMPGCMixedWeighted, PMPGCSuccessWeighted, ProceduralSubModule

model.BEFORE_FIRST_RUN[:] = [check_classes]
production_system.BEFORE_FIRST_CYCLE[:] = [check_agent]
production_system.EXPLAINERS[:] = [explain]

__all__ = [
    "ACTR",
    "PMPGC",
    "PMTD",
    "BlendingMemory",
    "BodyPort",
    "Buffer",
    "Chunk",
    "DMAssociate",
    "DMBaseLevel",
    "DMFixed",
    "DMInhibition",
    "DMNoise",
    "DMSalience",
    "DMSpreading",
    "ImaginalModule",
    "Memory",
    "MemorySubModule",
    "Model",
    "Motor",
    "PMCompile",
    "PMNew",
    "PMNoise",
    "PMPGCMixedWeighted",
    "PMPGCSuccessWeighted",
    "Partial",
    "ProceduralSubModule",
    "ProductionSystem",
    "SOSVision",
    "TextOutput",
    "Timer",
    "Vision",
    "display",
    "finished",
    "log",
    "log_everything",
    "run",
]

globals().update(MODULES)  # those above are imported by name for type checkers and readers
__all__ += [name for name in MODULES if name not in __all__]  # pyright: ignore[reportUnsupportedDunderAll]
