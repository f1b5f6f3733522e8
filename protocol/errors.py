"""Errors that speak to a person: which value, where, what is allowed, what to do next."""


class OdourswarmError(Exception):
    """Base of every error that is meant for the person at the terminal; its text is one sentence."""


class ScenarioError(OdourswarmError):
    """A scenario value, flag or graph that cannot be run; the command line ends with exit status 2."""


class SwarmFailure(OdourswarmError):
    """Processes failed beyond what the scenario planned; the command line ends with exit status 3."""
