"""The thesis's worked examples, run again: a picture and its numbers, theirs beside ours. One file an example or family.

Rules: what runs here is the code that the robots run, or says why it is not; a number is printed as it was measured.
"""
