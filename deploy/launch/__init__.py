"""The launcher: a swarm of processes on this machine, from the first spawn to the last exit."""
