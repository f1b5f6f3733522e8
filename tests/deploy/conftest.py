"""Tests of whole swarms share `swarm_helpers`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
