"""Settings of all tests."""

from hypothesis import settings

# Machines are slow and noisy: how long an example takes is no property of the code.
settings.register_profile("odourswarm", deadline=None)
settings.load_profile("odourswarm")
