"""The belief: what one robot senses, hears, decides and drives.

Rules of this package: a robot knows its own readings and what its neighbours tell it over declared links, nothing else.
All but `process.py` is pure: time and messages are arguments. Plain floats, no numpy: a robot process stays light, and
for vectors of two numbers floats are the fastest.
"""
