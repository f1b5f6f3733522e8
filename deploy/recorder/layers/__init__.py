"""What is drawn and plotted, a layer per module.

Rules: a layer turns arrays into chunks and keeps only what it must know of earlier rows; positions stay in
the arena's frame, y down as in the thesis's figures and in Rerun's 2D views.
"""
