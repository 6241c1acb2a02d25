"""The cognitive core: Python ACT-R's models, buffers, productions and modules, under the same names."""

from __future__ import annotations

from actr3d.actr.activation import DMBaseLevel, DMFixed, DMNoise, MemorySubModule
from actr3d.actr.association import DMAssociate, DMInhibition
from actr3d.actr.blending import BlendingMemory
from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import Chunk
from actr3d.actr.compilation import PMCompile
from actr3d.actr.display import display
from actr3d.actr.logger import finished, log, log_everything
from actr3d.actr.memory import Memory
from actr3d.actr.model import Model
from actr3d.actr.modules.imaginal import ImaginalModule
from actr3d.actr.modules.motor import Motor
from actr3d.actr.modules.sos_vision import SOSVision
from actr3d.actr.modules.text import TextOutput
from actr3d.actr.modules.timer import Timer
from actr3d.actr.modules.vision import Vision
from actr3d.actr.partial import Partial
from actr3d.actr.procedural import ACTR, ProductionSystem
from actr3d.actr.spreading import DMSalience, DMSpreading
from actr3d.actr.sweep import run
from actr3d.actr.utility import PMPGC, PMTD, PMNew, PMNoise, PMPGCMixedWeighted, PMPGCSuccessWeighted, ProceduralSubModule

__all__ = [
    "ACTR",
    "PMPGC",
    "PMTD",
    "BlendingMemory",
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
