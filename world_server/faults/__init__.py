"""What faults do to the world: radio, sensors, wheels, who takes part. A robot's own faults are in `robot_agent.faults`.

Rules: pure; every draw is addressed; a run without faults pays nothing.
"""
