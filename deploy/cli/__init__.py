"""The command line: one module per command, each a function that `deploy.cli.app` registers.

Rules: what a person did wrong is one sentence on stderr and exit status 2; `--json` prints one object on stdout and
nothing else there; slow libraries are loaded by the command that needs them.
"""
