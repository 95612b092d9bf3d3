"""The ways of calibrating that Cheng, Yu and Fei (2011) build on, each carried out on the same two virtual arms.

`arms` the two arms, `readings` what is touched, `trial` one calibration and how right its arm is, `outcome` many of
them, `work` a work of the literature with its numbers beside ours; then a module for each work, and `comparison`, one
table over all.
"""
