from typing import Any

from jedi.inference.compiled.subprocess import InferenceStateSameProcess

class InterpreterEnvironment:
    def get_inference_state_subprocess(self, inference_state: Any) -> InferenceStateSameProcess: ...
