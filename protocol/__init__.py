"""The vocabulary of the swarm: messages and their wire form, keys, scenario, graphs, addressed randomness, the bus.

Rules of this package: it imports none of our other packages; only `zenoh_bus` imports zenoh. Clocks, sockets and threads
are the business of `zenoh_bus` and what serves it (`inbox`, `roll`, `thread_state`, `endpoints`) and of `shell`;
everything else is free of them and of unaddressed randomness.
"""
