"""Control laws: how to move, given the plan and the neighbours? One file each."""
