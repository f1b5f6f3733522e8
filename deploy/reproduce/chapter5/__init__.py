"""The worked examples and experiments of chapter 5 (sections 5.2 and 5.3)."""

from deploy.reproduce.chapter5.robots import ROBOTS
from deploy.reproduce.chapter5.worked import WORKED

REPRODUCTIONS = (*WORKED, *ROBOTS)
