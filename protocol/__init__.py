"""The vocabulary of the swarm: messages and their wire form, keys, scenario, graphs, addressed randomness, the bus.

Rules of this package: it imports none of our other packages; only `zenoh_bus` imports zenoh; everything else is free of
clocks, sockets, threads and unaddressed randomness.
"""
