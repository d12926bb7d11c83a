"""Marks tests that take too long for ci/test; ci/full runs them (tread_slow_parts in tests/CMakeLists.txt)."""

import os
import unittest

slow = unittest.skipUnless(os.environ.get("TREAD_SLOW_PARTS"), "slow; TREAD_SLOW_PARTS=1 runs it, as ci/full does")
