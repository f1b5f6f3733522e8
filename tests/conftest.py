"""Settings of all tests."""

import signal

from hypothesis import settings

# Machines are slow and noisy: how long an example takes is no property of the code.
settings.register_profile("odourswarm", deadline=None)
settings.load_profile("odourswarm")

# A shell that starts a job in the background without job control has it ignore Ctrl-C, and so would every process that tests
# start and interrupt: an ignored signal is handed down, one that is handled is not.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
