"""What a member of a run can write down of it, and where: for checkers that look for a broken promise afterwards."""
