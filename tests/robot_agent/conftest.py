"""Tests of what a robot believes share `judging_helpers`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
