"""A swarm spread over hosts: which member runs where, and hosts made of network namespaces to try it on."""
