"""The truth: wind, plume, robot bodies, sensors, verdict; what the robots can only guess.

Rules of this package: it imports `protocol` and numpy and nothing of the robots; it reads no clock, opens no socket,
starts no thread. Time comes in as an argument or as a step number, torques come in as numbers, and every draw of noise
has an address (seed, what, step): the same scenario and seed give the same world to the bit, whoever asks first.
Noise belongs to an interval of time, so that dividing a step by two changes the accuracy and not the statistics.
SI units and radians; the arena's frame; concentration in ppt; arrays of robots have the robot on the first axis.
"""
