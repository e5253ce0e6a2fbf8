"""The double beam of Nizam et al., section 4.3, by the exact rods of `tests/oracles/coupled.py`."""

UPPER, TIP, LOWER = "pin->upper", "upper.end->lower", "pin->lower"
"""The contact pairs."""
HAND_OVER = {0.8: 0.53711095995669, 0.81: 0.52556048878907}
"""Depth at which the pin leaves the upper beam, by the place of the pin [m]: the tip still presses on the lower one."""
EVENTS = {"touch": 0.14978639329635, "hand-over": HAND_OVER[0.8], "slip-off": 0.73869353636162}
"""Depths of the pin at which the tip meets the lower beam, and the pin leaves the upper beam and the lower one [m]."""
FORCES = (1.00397705580342, 0.2905931420562)
"""Forces of the pin and of the tip at the depth .31 m [N]."""
