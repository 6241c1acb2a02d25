"""Settings of all tests."""

from __future__ import annotations

import os
import signal
import tempfile

from hypothesis import settings

# The same examples each time, so that a failure is the change's own. EXPLORE=1 looks for new ones.
settings.register_profile("same", derandomize=True, deadline=None)
settings.register_profile("explore", deadline=None)
settings.load_profile("explore" if os.environ.get("EXPLORE") else "same")

# Tests leave the user's cache and key alone.
os.environ["XDG_CACHE_HOME"] = os.environ["XDG_DATA_HOME"] = tempfile.mkdtemp(prefix="actr3d-tests-")

# A shell ignores SIGINT for what it starts in the background, and what the tests start would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
